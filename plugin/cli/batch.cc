#include "batch.h"

#include <algorithm>
#include <atomic>
#include <cctype>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <mutex>
#include <new>
#include <set>
#include <thread>
#include <utility>

#include "exit_code.h"
#include "lacerta/file_io.h"

namespace lacerta::cli {
namespace {

namespace fs = std::filesystem;

bool HasWildcard(const std::string& text) { return text.find_first_of("*?") != text.npos; }

// "*" and "?" as in a shell, in time linear in the product of the lengths.
bool Matches(const std::string& pattern, const std::string& text) {
  size_t p = 0, t = 0, star = pattern.npos, star_text = 0;
  while (t < text.size()) {
    if (p < pattern.size() && pattern[p] == '*') {
      star = p++;
      star_text = t;
    } else if (p < pattern.size() && (pattern[p] == '?' || pattern[p] == text[t])) {
      ++p;
      ++t;
    } else if (star != pattern.npos) {
      p = star + 1;
      t = ++star_text;
    } else {
      return false;
    }
  }
  while (p < pattern.size() && pattern[p] == '*') ++p;
  return p == pattern.size();
}

void Expand(const fs::path& folder, std::vector<fs::path> parts, std::vector<std::string>* found) {
  if (parts.empty()) return;
  const fs::path part = parts.front();
  parts.erase(parts.begin());
  std::error_code error;
  const fs::path where = folder.empty() ? fs::path(".") : folder;
  if (part == "**") {
    Expand(folder, parts, found);
    for (const auto& entry : fs::directory_iterator(where, error)) {
      if (entry.is_symlink(error) || !entry.is_directory(error)) continue;
      std::vector<fs::path> again = parts;
      again.insert(again.begin(), part);
      Expand(folder / entry.path().filename(), again, found);
    }
  } else if (!HasWildcard(part.string())) {
    if (!parts.empty()) return Expand(folder / part, parts, found);
    if (fs::is_regular_file(folder / part, error)) found->push_back((folder / part).string());
  } else {
    for (const auto& entry : fs::directory_iterator(where, error)) {
      const std::string name = entry.path().filename().string();
      if (!Matches(part.string(), name) || name.front() == '.') continue;
      if (!parts.empty() && entry.is_directory(error)) Expand(folder / name, parts, found);
      if (parts.empty() && entry.is_regular_file(error)) found->push_back((folder / name).string());
    }
  }
}

std::vector<std::string> FilesBelow(const fs::path& folder, const std::vector<std::string>& extensions) {
  std::vector<std::string> found;
  std::error_code error;
  for (fs::recursive_directory_iterator i(folder, fs::directory_options::skip_permission_denied, error), end; i != end;
       i.increment(error)) {
    if (error) break;
    std::string extension = i->path().extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    const bool known = std::find(extensions.begin(), extensions.end(), extension) != extensions.end();
    if (known && i->is_regular_file(error)) found.push_back(i->path().string());
  }
  return found;
}

// A file of ours appears under its name only when it is whole; a GLB of somebody else is held against its length.
bool IsUpToDate(const BatchItem& item) {
  std::error_code error;
  if (item.input == "-" || item.output == "-" || !fs::is_regular_file(item.output, error)) return false;
  const auto input_time = fs::last_write_time(item.input, error);
  if (error) return false;
  const auto output_time = fs::last_write_time(item.output, error);
  if (error || output_time < input_time) return false;
  const StatusOr<Bytes> bytes = ReadFile(item.output);
  if (!bytes.ok() || bytes.value().size() < 12) return false;
  const Bytes& b = bytes.value();
  if (fs::path(item.output).extension() != ".glb") return true;
  const uint64_t length = b[8] | b[9] << 8 | b[10] << 16 | static_cast<uint64_t>(b[11]) << 24;
  return b[0] == 'g' && b[1] == 'l' && b[2] == 'T' && b[3] == 'F' && length == b.size();
}

FileOutcome Convert(const BatchItem& item, const std::function<FileOutcome(const BatchItem&)>& convert) {
  try {
    return convert(item);
  } catch (const std::bad_alloc&) {  // the next file may be smaller
    FileOutcome outcome;
    outcome.status = LimitExceeded(item.input + ": not enough memory");
    return outcome;
  } catch (const std::exception& error) {
    FileOutcome outcome;
    outcome.status = InternalError(item.input + ": " + error.what());
    return outcome;
  }
}

}  // namespace

StatusOr<std::vector<std::string>> ExpandInputs(const std::vector<std::string>& patterns,
                                                const std::vector<std::string>& extensions) {
  std::vector<std::string> inputs;
  std::set<std::string> known;
  for (const std::string& pattern : patterns) {
    std::vector<std::string> found;
    std::error_code error;
    if (fs::is_directory(pattern, error)) {
      found = FilesBelow(pattern, extensions);
    } else if (HasWildcard(pattern) && !fs::exists(pattern, error)) {
      const fs::path path(pattern);
      const fs::path relative = path.relative_path();
      Expand(path.root_path(), std::vector<fs::path>(relative.begin(), relative.end()), &found);
    } else {
      found = {pattern};  // one that is missing is told when it is read
    }
    if (found.empty()) return NotFound(pattern + ": no such file");
    std::sort(found.begin(), found.end());
    for (std::string& file : found) {
      if (known.insert(file).second) inputs.push_back(std::move(file));
    }
  }
  return inputs;
}

StatusOr<std::vector<BatchItem>> PairOutputs(const std::vector<std::string>& patterns,
                                             const std::vector<std::string>& inputs, const std::string& output,
                                             const std::string& extension) {
  std::error_code error;
  const bool several = inputs.size() > 1 || fs::is_directory(patterns[0], error) || HasWildcard(patterns[0]);
  const bool folder = several || fs::is_directory(output, error) || (!output.empty() && output.back() == '/');
  if (!folder) return std::vector<BatchItem>{{inputs[0], output, false}};
  if (output == "-") return InvalidArgument("standard output takes one file; give a folder for several");
  if (several && !fs::path(output).extension().empty() && !fs::is_directory(output, error)) {
    return InvalidArgument(output + ": several inputs need a folder to go to");
  }
  std::vector<BatchItem> items;
  std::set<std::string> known;
  for (const std::string& input : inputs) {
    fs::path below = fs::path(input == "-" ? "stdin" : input).filename();
    for (const std::string& pattern : patterns) {
      const fs::path relative = fs::path(input).lexically_relative(pattern);
      if (fs::is_directory(pattern, error) && !relative.empty() && *relative.begin() != "..") below = relative;
    }
    BatchItem item = {input, (fs::path(output) / (extension.empty() ? below : below.replace_extension(extension))).string(), true};
    if (!known.insert(item.output).second) {
      return InvalidArgument(input + ": another input goes to " + item.output + " too");
    }
    items.push_back(std::move(item));
  }
  return items;
}

int RunBatch(const std::vector<BatchItem>& items, const BatchOptions& options,
             const std::function<FileOutcome(const BatchItem&)>& convert) {
  std::vector<FileOutcome> outcomes(items.size());
  std::vector<bool> skipped(items.size(), false);
  std::atomic<size_t> next = 0;
  std::mutex telling;
  const auto work = [&] {
    for (size_t i = next++; i < items.size(); i = next++) {
      const bool skip = options.resume && IsUpToDate(items[i]);
      if (!skip) {
        std::error_code error;
        const fs::path folder = fs::path(items[i].output).parent_path();
        if (items[i].in_folder && !folder.empty()) fs::create_directories(folder, error);
        outcomes[i] = Convert(items[i], convert);
      }
      const std::lock_guard<std::mutex> lock(telling);
      skipped[i] = skip;
      if (!outcomes[i].status.ok()) outcomes[i].exit_code = Finish(outcomes[i].status);
    }
  };
  std::vector<std::thread> threads;
  const auto num_threads = std::min<size_t>(static_cast<size_t>(std::max(options.jobs, 1)), items.size());
  for (size_t t = 1; t < num_threads; ++t) threads.emplace_back(work);
  work();
  for (std::thread& thread : threads) thread.join();

  size_t failed = 0, missed = 0, num_skipped = 0;
  uint64_t before = 0, after = 0;
  Json files = Json::array();
  for (size_t i = 0; i < items.size(); ++i) {
    FileOutcome& outcome = outcomes[i];
    num_skipped += skipped[i] ? 1 : 0;
    missed += outcome.exit_code == kExitTargetMissed ? 1 : 0;
    failed += outcome.exit_code != kExitOk && outcome.exit_code != kExitTargetMissed ? 1 : 0;
    before += outcome.bytes_before;
    after += outcome.bytes_after;
    Json json = {{"input", items[i].input}, {"output", items[i].output}, {"exitCode", outcome.exit_code}};
    if (skipped[i]) json["skipped"] = true;
    if (!outcome.status.ok()) json["error"] = outcome.status.message();
    if (outcome.json.is_object()) json.update(outcome.json);
    files.push_back(std::move(json));
  }
  if (items.size() == 1) {
    const bool to_stdout = items[0].output == "-";
    if (options.json && outcomes[0].status.ok() && !to_stdout) PrintJson(files[0]);
    return outcomes[0].exit_code;
  }
  const size_t done = items.size() - failed - num_skipped;
  if (options.json) {
    PrintJson({{"files", std::move(files)}, {"done", done}, {"skipped", num_skipped}, {"failed", failed}, {"missed", missed}});
  }
  std::fprintf(stderr, "lacerta: %zu done, %zu skipped, %zu failed, %zu missed their target; %llu -> %llu bytes\n", done,
               num_skipped, failed, missed, static_cast<unsigned long long>(before),
               static_cast<unsigned long long>(after));
  return failed > 0 ? kExitSomeFailed : missed > 0 ? kExitTargetMissed : kExitOk;
}

void AddBatchOptions(CLI::App* command, BatchOptions* options) {
  command->add_option("--jobs", options->jobs, "Files at a time (default: 1, which uses all cores on each)")
      ->check(CLI::Range(1, 256));
  command->add_flag("--resume", options->resume, "Skip outputs that are complete and not older than their inputs");
}

StatusOr<Bytes> ReadInput(const std::string& path) {
  if (path != "-") return ReadFile(path);
  Bytes bytes;
  uint8_t chunk[1 << 16];
  for (size_t count; (count = std::fread(chunk, 1, sizeof(chunk), stdin)) > 0;) {
    bytes.insert(bytes.end(), chunk, chunk + count);
  }
  if (std::ferror(stdin) != 0) return IoError("standard input cannot be read");
  return bytes;
}

StatusOr<FileBytes> OpenInput(const std::string& path) {
  if (path != "-") return FileBytes::Open(path);
  LACERTA_ASSIGN_OR_RETURN(Bytes bytes, ReadInput(path));
  return FileBytes(std::move(bytes));
}

Status WriteOutput(const std::string& path, Span<const uint8_t> bytes) {
  if (path != "-") return WriteFileAtomically(path, bytes);
  const bool written = std::fwrite(bytes.data(), 1, bytes.size(), stdout) == bytes.size() && std::fflush(stdout) == 0;
  return written ? Status() : IoError("standard output cannot be written");
}

bool AreApart(const std::string& input, const std::string& output) {
  if (output == "-") return true;
  const auto folder = [](const std::string& path) { return fs::absolute(path).parent_path(); };
  std::error_code error;
  return !fs::equivalent(folder(input), folder(output), error) || error;
}

}  // namespace lacerta::cli
