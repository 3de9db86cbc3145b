#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "batch.h"
#include "commands.h"
#include "exit_code.h"
#include "lacerta/file_io.h"
#include "lacerta/gltf.h"
#include "lacerta/mesh_file.h"
#include "lacerta/surface_distance.h"
#include "report.h"

namespace lacerta::cli {
namespace {

struct InfoArguments {
  std::vector<std::string> inputs;
  bool json = false;
};

// How to tell what is in a file.
struct Telling {
  bool as_json = false;  // returned then, else printed
  std::string prefix;    // of the first line
};

StatusOr<Json> DescribeAsset(const Bytes& bytes, const std::string& folder, const Telling& telling) {
  LACERTA_ASSIGN_OR_RETURN(const AssetInfo info, DescribeGltf(bytes, folder));
  if (telling.as_json) {
    Json streams = Json::array();
    for (const StreamInfo& stream : info.streams) streams.push_back(ToJson(stream));
    Json json = {{"bytes", bytes.size()},
                 {"primitives", info.num_primitives},
                 {"dracoPrimitives", info.num_draco_primitives},
                 {"meshes", ToJson(info.primitives)},
                 {"streams", std::move(streams)}};
    if (!info.streams.empty()) json["fallback"] = FallbackName(info.fallback);
    return json;
  }
  std::printf("%s%zu bytes, %llu primitives: %zu progressive streams, %llu Draco\n", telling.prefix.c_str(), bytes.size(),
              static_cast<unsigned long long>(info.num_primitives), info.streams.size(),
              static_cast<unsigned long long>(info.num_draco_primitives));
  for (const StreamInfo& stream : info.streams) {
    std::printf("mesh %llu%s%s%s, fallback %s, diagonal %s\n", static_cast<unsigned long long>(stream.mesh),
                stream.name.empty() ? "" : " (", stream.name.c_str(), stream.name.empty() ? "" : ")",
                FallbackName(info.fallback), Short(stream.diagonal, 6).c_str());
    PrintLevels(stream);
  }
  PrintPrimitives(info.primitives);
  return Json();
}

StatusOr<Json> DescribeBareStream(const Bytes& bytes, const Telling& telling) {
  LACERTA_ASSIGN_OR_RETURN(const StreamInfo info, DescribeStream(bytes, {}));
  if (telling.as_json) return Json{{"bytes", bytes.size()}, {"streams", Json::array({ToJson(info)})}};
  std::printf("%s%zu bytes\n", telling.prefix.c_str(), bytes.size());
  PrintLevels(info);
  return Json();
}

StatusOr<Json> DescribeMesh(const Bytes& bytes, MeshFormat format, const Telling& telling) {
  LACERTA_ASSIGN_OR_RETURN(const TriangleMesh mesh, ParseMesh(bytes, format));
  const double diagonal = BoundingBoxDiagonal(mesh);
  if (telling.as_json) {
    return Json{{"bytes", bytes.size()}, {"vertices", mesh.positions.size()}, {"triangles", mesh.triangles.size()}, {"diagonal", NumberOrNull(diagonal)}};
  }
  std::printf("%s%zu bytes, %zu vertices, %zu triangles, diagonal %s\n", telling.prefix.c_str(), bytes.size(), mesh.positions.size(), mesh.triangles.size(),
              Short(diagonal, 6).c_str());
  return Json();
}

StatusOr<Json> Describe(const std::string& file, const Telling& telling) {
  LACERTA_ASSIGN_OR_RETURN(const Bytes bytes, ReadInput(file));
  const StatusOr<MeshFormat> format = DetectMeshFormat(file, bytes);
  if (!format.ok()) return format.status().WithContext(file);
  StatusOr<Json> json = format.value() == MeshFormat::kGltf ? DescribeAsset(bytes, std::filesystem::path(file).parent_path().string(), telling)
                        : format.value() == MeshFormat::kDrc ? DescribeBareStream(bytes, telling)
                                                             : DescribeMesh(bytes, format.value(), telling);
  if (!json.ok()) return json.status().WithContext(file);
  return json;
}

int RunInfo(const InfoArguments& arguments) {
  const StatusOr<std::vector<std::string>> files = ExpandInputs(arguments.inputs, {".glb", ".gltf", ".drc", ".ply", ".obj", ".off", ".stl"});
  if (!files.ok()) return Finish(files.status());
  const bool are_many = files.value().size() > 1;
  int exit_code = kExitOk;
  Json all = Json::array();
  for (const std::string& file : files.value()) {
    StatusOr<Json> json = Describe(file, {arguments.json, are_many ? file + ": " : ""});
    if (!json.ok()) {
      exit_code = Finish(json.status());
      continue;
    }
    all.push_back(are_many ? Json{{"file", file}} : Json::object());
    if (arguments.json) all.back().update(json.value());
  }
  if (arguments.json && (are_many || all.size() == 1)) PrintJson(are_many ? all : all[0]);
  return are_many && exit_code != kExitOk ? kExitSomeFailed : exit_code;
}

}  // namespace

void AddInfoCommand(CLI::App* app, int* exit_code) {
  const auto arguments = std::make_shared<InfoArguments>();
  CLI::App* info = app->add_subcommand("info", "Tell what is in files: per level triangles, bytes, error, PSNR");
  info->add_option("IN", arguments->inputs, "Files that pack or unpack takes, patterns, folders; - for standard input")->required();
  info->add_flag("--json", arguments->json, "Print as JSON");
  info->footer(kExitCodeHelp);
  info->callback([arguments, exit_code] { *exit_code = RunInfo(*arguments); });
}

}  // namespace lacerta::cli
