// Many files with one command: which output belongs to which input, and running them.
#ifndef LACERTA_CLI_BATCH_H_
#define LACERTA_CLI_BATCH_H_

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <vector>

#include "lacerta/file_io.h"
#include "lacerta/mesh.h"
#include "lacerta/status.h"
#include "report.h"

namespace lacerta::cli {

struct BatchItem {
  std::string input;   // "-": standard input
  std::string output;  // "-": standard output
  bool in_folder = false;  // one that is made where it is not there
};

struct BatchOptions {
  int jobs = 1;         // files at a time
  bool resume = false;  // skip outputs that are complete and not older than their inputs
  bool json = false;
};

// The files that patterns stand for: "*" and "?" within a name, "**" for any folders; a folder stands for all files in it
// and below whose extension is in `extensions` (with the dot, lower case). Sorted within a pattern, each file once. Fails
// with kNotFound where a pattern matches nothing.
StatusOr<std::vector<std::string>> ExpandInputs(const std::vector<std::string>& patterns,
                                                const std::vector<std::string>& extensions);

// One input and an output that is no folder go together. Else `output` is a folder, which is made, and an input goes to
// its name with `extension` (its own where that is empty), in the subfolder that it has below the folder it was found in. Fails with kInvalidArgument
// where two inputs would go to one output.
StatusOr<std::vector<BatchItem>> PairOutputs(const std::vector<std::string>& patterns,
                                             const std::vector<std::string>& inputs, const std::string& output,
                                             const std::string& extension);

// What became of one file.
struct FileOutcome {  // NOLINT(bugprone-exception-escape): Json moves without
  int exit_code = 0;
  Status status;  // why there is no output; its message begins with the input
  uint64_t bytes_before = 0;
  uint64_t bytes_after = 0;
  Json json;  // for --json
};

// Runs `convert` on every item, going on after failures; failures are told as they come, a summary at the end, both on
// stderr. The exit code is the file's where there is one, else kExitSomeFailed where any failed, kExitTargetMissed where
// any missed its target.
int RunBatch(const std::vector<BatchItem>& items, const BatchOptions& options,
             const std::function<FileOutcome(const BatchItem&)>& convert);

// --jobs and --resume.
void AddBatchOptions(CLI::App* command, BatchOptions* options);

// Files, or standard input and output for "-". Messages begin with the path.
StatusOr<Bytes> ReadInput(const std::string& path);
// The same, mapped where it is large.
StatusOr<FileBytes> OpenInput(const std::string& path);
Status WriteOutput(const std::string& path, Span<const uint8_t> bytes);

// Whether two files are in different folders: a relative URI that leads somewhere from the one does not from the other.
bool AreApart(const std::string& input, const std::string& output);

}  // namespace lacerta::cli

#endif  // LACERTA_CLI_BATCH_H_
