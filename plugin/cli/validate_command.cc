#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "batch.h"
#include "commands.h"
#include "exit_code.h"
#include "lacerta/gltf.h"
#include "lacerta/mesh_file.h"

namespace lacerta::cli {
namespace {

struct ValidateArguments {
  std::vector<std::string> inputs;
  std::string original;
  bool json = false;
};

Json ToJson(const ValidationReport& report) {
  Json issues = Json::array();
  for (const ValidationIssue& issue : report.issues) {
    issues.push_back({{"severity", issue.is_error ? "error" : "note"}, {"where", issue.where}, {"message", issue.message}});
  }
  Json measured = Json::array();
  for (const MeasuredError& error : report.measured) {
    measured.push_back({{"mesh", error.mesh},
                        {"primitive", error.primitive},
                        {"level", error.level.has_value() ? Json(*error.level) : Json()},
                        {"announced", error.announced.has_value() ? NumberOrNull(*error.announced) : Json()},
                        {"measured", NumberOrNull(error.measured)},
                        {"psnr", NumberOrNull(error.psnr)}});
  }
  return {{"valid", report.IsValid()}, {"issues", std::move(issues)}, {"measured", std::move(measured)}};
}

void Print(const std::string& file, const ValidationReport& report) {
  for (const ValidationIssue& issue : report.issues) {
    std::printf("%s: %s: %s%s%s\n", file.c_str(), issue.is_error ? "error" : "note", issue.where.c_str(),
                issue.where.empty() ? "" : ": ", issue.message.c_str());
  }
  std::vector<std::vector<std::string>> rows;
  for (const MeasuredError& error : report.measured) {
    rows.push_back({std::to_string(error.mesh), std::to_string(error.primitive),
                    error.level.has_value() ? std::to_string(*error.level) : "-",
                    error.announced.has_value() ? Short(*error.announced, 4) : "-", Short(error.measured, 4),
                    Fixed(error.psnr, 2)});
  }
  if (!rows.empty()) PrintTable({"mesh", "primitive", "level", "announced", "measured", "PSNR dB"}, rows);
  std::printf("%s: %s\n", file.c_str(), report.IsValid() ? "valid" : "not valid");
}

StatusOr<ValidationReport> ValidateFile(const std::string& file, const ValidateArguments& arguments) {
  LACERTA_ASSIGN_OR_RETURN(const Bytes bytes, ReadInput(file));
  ValidateOptions options;
  options.folder = std::filesystem::path(file).parent_path().string();
  Bytes original;
  if (!arguments.original.empty()) {
    LACERTA_ASSIGN_OR_RETURN(original, ReadInput(arguments.original));
    options.original = original;
    options.original_folder = std::filesystem::path(arguments.original).parent_path().string();
    const StatusOr<MeshFormat> format = DetectMeshFormat(arguments.original, original);
    if (format.ok() && format.value() != MeshFormat::kGltf) {
      StatusOr<FileMesh> mesh = ParseFileMesh(original, format.value(), options.original_folder);
      if (!mesh.ok()) return mesh.status().WithContext(arguments.original);
      options.original_mesh = std::move(mesh).value();
    }
  }
  return ValidateGltf(bytes, options);
}

int RunValidate(const ValidateArguments& arguments) {
  const StatusOr<std::vector<std::string>> files = ExpandInputs(arguments.inputs, {".glb", ".gltf"});
  if (!files.ok()) return Finish(files.status());
  if (files.value().size() > 1 && !arguments.original.empty()) {
    return Finish(InvalidArgument("--original goes with one file"));
  }
  int exit_code = kExitOk;
  Json all = Json::array();
  for (const std::string& file : files.value()) {
    const StatusOr<ValidationReport> report = ValidateFile(file, arguments);
    if (!report.ok()) {
      exit_code = Finish(report.status());
      continue;
    }
    if (!report.value().IsValid()) exit_code = kExitBadInput;
    if (arguments.json) {
      Json json = {{"file", file}};
      json.update(ToJson(report.value()));
      all.push_back(std::move(json));
    } else {
      Print(file, report.value());
    }
  }
  if (arguments.json) PrintJson(files.value().size() == 1 && all.size() == 1 ? all[0] : all);
  return exit_code;
}

}  // namespace

void AddValidateCommand(CLI::App* app, int* exit_code) {
  const auto arguments = std::make_shared<ValidateArguments>();
  CLI::App* validate = app->add_subcommand("validate", "Check packed assets: references, streams, bounds, errors");
  validate->add_option("FILE", arguments->inputs, ".glb or .gltf files, patterns, folders; - for standard input")
      ->required();
  validate->add_option("--original", arguments->original, "The asset or mesh before packing: announced errors are measured");
  validate->add_flag("--json", arguments->json, "Print as JSON");
  validate->footer(kExitCodeHelp);
  validate->callback([arguments, exit_code] { *exit_code = RunValidate(*arguments); });
}

}  // namespace lacerta::cli
