#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "batch.h"
#include "commands.h"
#include "exit_code.h"
#include "lacerta/gltf.h"
#include "lacerta/mesh_file.h"

namespace lacerta::cli {
namespace {

struct TrimArguments {
  std::vector<std::string> inputs;
  std::string output;
  std::optional<int> level;
  std::optional<uint64_t> bytes;
  BatchOptions batch;
};

// The longest prefix of a bare stream within the level or the budget.
StatusOr<TrimResult> TrimStream(const Bytes& stream, const TrimArguments& arguments) {
  LACERTA_ASSIGN_OR_RETURN(const StreamInfo info, DescribeStream(stream, {}));
  TrimResult result;
  uint64_t length = info.levels[0].bytes;
  for (size_t level = 0; level < info.levels.size(); ++level) {
    const bool fits = arguments.level.has_value() ? level <= static_cast<size_t>(*arguments.level)
                                                  : info.levels[level].bytes <= *arguments.bytes;
    if (fits) length = info.levels[level].bytes;
  }
  result.glb.assign(stream.begin(), stream.begin() + static_cast<std::ptrdiff_t>(length));
  result.meets_bytes = !arguments.bytes.has_value() || length <= *arguments.bytes;
  return result;
}

StatusOr<TrimResult> Trim(const Bytes& bytes, MeshFormat format, const BatchItem& item, const TrimArguments& arguments) {
  if (format == MeshFormat::kDrc) return TrimStream(bytes, arguments);
  if (format != MeshFormat::kGltf) return Unsupported("is not packed; trim takes .glb, .gltf and .drc");
  TrimOptions options;
  options.level = arguments.level;
  options.bytes = arguments.bytes;
  options.folder = std::filesystem::path(item.input).parent_path().string();
  options.embed_images = AreApart(item.input, item.output);
  return TrimGltf(bytes, options);
}

StatusOr<FileOutcome> TrimFile(const TrimArguments& arguments, const BatchItem& item) {
  LACERTA_ASSIGN_OR_RETURN(const Bytes bytes, ReadInput(item.input));
  const StatusOr<MeshFormat> format = DetectMeshFormat(item.input, bytes);
  if (!format.ok()) return format.status().WithContext(item.input);
  const StatusOr<TrimResult> trimmed = Trim(bytes, format.value(), item, arguments);
  if (!trimmed.ok()) return trimmed.status().WithContext(item.input);
  const bool has_levels = trimmed.value().has_levels;
  LACERTA_RETURN_IF_ERROR(WriteOutput(item.output, trimmed.value().glb));
  FileOutcome outcome;
  outcome.exit_code = trimmed.value().meets_bytes ? kExitOk : kExitTargetMissed;
  outcome.bytes_before = bytes.size();
  outcome.bytes_after = trimmed.value().glb.size();
  const std::vector<std::string>& notes = trimmed.value().notes;
  outcome.json = {{"bytes", outcome.bytes_after}, {"targetMet", trimmed.value().meets_bytes}, {"hasLevels", has_levels}, {"notes", notes}};
  for (const std::string& note : notes) {
    if (!arguments.batch.json) std::fprintf(stderr, "lacerta: %s: %s\n", item.input.c_str(), note.c_str());
  }
  if (!has_levels && !arguments.batch.json) std::fprintf(stderr, "lacerta: %s: no mesh of it has levels; it stays whole\n", item.input.c_str());
  if (!trimmed.value().meets_bytes) {
    std::fprintf(stderr, "lacerta: %s misses the target: without any refinement it has %llu bytes\n",
                 item.output.c_str(), static_cast<unsigned long long>(outcome.bytes_after));
  }
  return outcome;
}

StatusOr<std::vector<BatchItem>> Items(const TrimArguments& arguments) {
  LACERTA_ASSIGN_OR_RETURN(const std::vector<std::string> inputs, ExpandInputs(arguments.inputs, {".glb", ".drc"}));
  return PairOutputs(arguments.inputs, inputs, arguments.output, "");
}

int RunTrim(const TrimArguments& arguments) {
  const StatusOr<std::vector<BatchItem>> items = Items(arguments);
  if (!items.ok()) return Finish(items.status());
  return RunBatch(items.value(), arguments.batch, [&](const BatchItem& item) {
    StatusOr<FileOutcome> result = TrimFile(arguments, item);
    if (result.ok()) return std::move(result).value();
    FileOutcome outcome;
    outcome.status = result.status();
    return outcome;
  });
}

}  // namespace

void AddTrimCommand(CLI::App* app, int* exit_code) {
  const auto arguments = std::make_shared<TrimArguments>();
  CLI::App* trim = app->add_subcommand("trim", "Cut a packed file to a level or a size; it stays a legal file");
  trim->add_option("IN", arguments->inputs, "Packed .glb or .drc files, patterns, folders; - for standard input")
      ->required();
  trim->add_option("-o,--output", arguments->output, "A file of the same kind; a folder for several inputs; -")
      ->required();
  CLI::Option_group* target = trim->add_option_group("target", "What to keep");
  target->add_option("--level", arguments->level, "Levels up to this one, 0 = base; those above that take no bytes stay")->check(CLI::NonNegativeNumber);
  target->add_option("--bytes", arguments->bytes, "As many refinements as fit into a file of this size")
      ->check(Positive());
  target->require_option(1);
  AddBatchOptions(trim, &arguments->batch);
  trim->add_flag("--json", arguments->batch.json, "Print a report as JSON");
  trim->footer(kExitCodeHelp);
  trim->callback([arguments, exit_code] { *exit_code = RunTrim(*arguments); });
}

}  // namespace lacerta::cli
