#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>

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
  std::string input;
  bool json = false;
};

Status DescribeAsset(const Bytes& bytes, const InfoArguments& arguments) {
  LACERTA_ASSIGN_OR_RETURN(const AssetInfo info,
                           DescribeGltf(bytes, std::filesystem::path(arguments.input).parent_path().string()));
  if (arguments.json) {
    Json streams = Json::array();
    for (const StreamInfo& stream : info.streams) streams.push_back(ToJson(stream));
    Json json = {{"bytes", bytes.size()},
                 {"primitives", info.num_primitives},
                 {"dracoPrimitives", info.num_draco_primitives},
                 {"meshes", ToJson(info.primitives)},
                 {"streams", std::move(streams)}};
    if (!info.streams.empty()) json["fallback"] = FallbackName(info.fallback);
    PrintJson(json);
    return Status();
  }
  std::printf("%zu bytes, %llu primitives: %zu progressive streams, %llu Draco\n", bytes.size(),
              static_cast<unsigned long long>(info.num_primitives), info.streams.size(),
              static_cast<unsigned long long>(info.num_draco_primitives));
  for (const StreamInfo& stream : info.streams) {
    std::printf("mesh %llu%s%s%s, fallback %s, diagonal %s\n", static_cast<unsigned long long>(stream.mesh),
                stream.name.empty() ? "" : " (", stream.name.c_str(), stream.name.empty() ? "" : ")",
                FallbackName(info.fallback), Short(stream.diagonal, 6).c_str());
    PrintLevels(stream);
  }
  PrintPrimitives(info.primitives);
  return Status();
}

Status DescribeBareStream(const Bytes& bytes, const InfoArguments& arguments) {
  LACERTA_ASSIGN_OR_RETURN(const StreamInfo info, DescribeStream(bytes, {}));
  if (arguments.json) {
    PrintJson({{"bytes", bytes.size()}, {"streams", Json::array({ToJson(info)})}});
  } else {
    std::printf("%zu bytes\n", bytes.size());
    PrintLevels(info);
  }
  return Status();
}

Status DescribeMesh(const Bytes& bytes, MeshFormat format, const InfoArguments& arguments) {
  LACERTA_ASSIGN_OR_RETURN(const TriangleMesh mesh, ParseMesh(bytes, format));
  const double diagonal = BoundingBoxDiagonal(mesh);
  if (arguments.json) {
    PrintJson({{"bytes", bytes.size()},
               {"vertices", mesh.positions.size()},
               {"triangles", mesh.triangles.size()},
               {"diagonal", NumberOrNull(diagonal)}});
  } else {
    std::printf("%zu bytes, %zu vertices, %zu triangles, diagonal %s\n", bytes.size(), mesh.positions.size(),
                mesh.triangles.size(), Short(diagonal, 6).c_str());
  }
  return Status();
}

Status RunInfo(const InfoArguments& arguments) {
  LACERTA_ASSIGN_OR_RETURN(const Bytes bytes, ReadInput(arguments.input));
  const StatusOr<MeshFormat> format = DetectMeshFormat(arguments.input, bytes);
  if (!format.ok()) return format.status().WithContext(arguments.input);
  Status status;
  if (format.value() == MeshFormat::kGltf) {
    status = DescribeAsset(bytes, arguments);
  } else if (format.value() == MeshFormat::kDrc) {
    status = DescribeBareStream(bytes, arguments);
  } else {
    status = DescribeMesh(bytes, format.value(), arguments);
  }
  return status.WithContext(arguments.input);
}

}  // namespace

void AddInfoCommand(CLI::App* app, int* exit_code) {
  const auto arguments = std::make_shared<InfoArguments>();
  CLI::App* info = app->add_subcommand("info", "Tell what is in a file: per level triangles, bytes, error, PSNR");
  info->add_option("IN", arguments->input, "Any file that pack or unpack takes")->required();
  info->add_flag("--json", arguments->json, "Print as JSON");
  info->footer(kExitCodeHelp);
  info->callback([arguments, exit_code] { *exit_code = Finish(RunInfo(*arguments)); });
}

}  // namespace lacerta::cli
