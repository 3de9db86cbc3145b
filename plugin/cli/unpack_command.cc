#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "batch.h"
#include "commands.h"
#include "exit_code.h"
#include "lacerta/codec.h"
#include "lacerta/gltf.h"
#include "lacerta/mesh_file.h"
#include "report.h"

namespace lacerta::cli {
namespace {

struct UnpackArguments {
  std::string input;
  std::string output;
  std::optional<int> level;
  bool json = false;
};

struct Unpacked {
  uint64_t triangles = 0;  // 0: a whole asset
  std::vector<std::string> notes;
};

StatusOr<Unpacked> WriteMesh(const TriangleMesh& mesh, const Vec3d& origin, std::vector<std::string> notes, const std::string& output) {
  if (output == "-") {
    LACERTA_ASSIGN_OR_RETURN(const Bytes glb, FormatPlainGlb(mesh, "", origin));
    LACERTA_RETURN_IF_ERROR(WriteOutput(output, glb));
  } else {
    LACERTA_RETURN_IF_ERROR(WriteMeshFile(mesh, output, origin));
  }
  return Unpacked{mesh.triangles.size(), std::move(notes)};
}

StatusOr<Unpacked> UnpackAsset(const Bytes& bytes, const UnpackArguments& arguments) {
  UnpackOptions options;
  options.level = arguments.level;
  options.folder = std::filesystem::path(arguments.input).parent_path().string();
  if (arguments.output != "-" && std::filesystem::path(arguments.output).extension() != ".glb") {
    LACERTA_ASSIGN_OR_RETURN(FlattenResult flat, FlattenGltf(bytes, options));
    options.origin = FarOrigin(flat.mesh);
    if (options.origin != Vec3d{}) {
      LACERTA_ASSIGN_OR_RETURN(flat, FlattenGltf(bytes, options));
    }
    return WriteMesh(flat.mesh, options.origin, std::move(flat.notes), arguments.output);
  }
  options.embed_images = AreApart(arguments.input, arguments.output);
  LACERTA_ASSIGN_OR_RETURN(UnpackResult result, UnpackGltf(bytes, options));
  LACERTA_RETURN_IF_ERROR(WriteOutput(arguments.output, result.glb));
  return Unpacked{0, std::move(result.notes)};
}

StatusOr<Unpacked> UnpackStream(const Bytes& bytes, const UnpackArguments& arguments) {
  DecodeOptions options;
  options.max_level = arguments.level;
  LACERTA_ASSIGN_OR_RETURN(const DecodedMesh decoded, DecodeMesh(bytes, options));
  std::vector<std::string> notes;
  if (!decoded.refinement.ok()) {
    notes.push_back("decoded to level " + std::to_string(decoded.level) + " only: " + decoded.refinement.message());
  }
  return WriteMesh(decoded.mesh, Vec3d{}, std::move(notes), arguments.output);
}

StatusOr<Unpacked> Unpack(const UnpackArguments& arguments) {
  LACERTA_ASSIGN_OR_RETURN(const Bytes bytes, ReadInput(arguments.input));
  const StatusOr<MeshFormat> format = DetectMeshFormat(arguments.input, bytes);
  if (!format.ok()) return format.status().WithContext(arguments.input);
  StatusOr<Unpacked> result = Unsupported("is not packed; unpack takes .glb, .gltf and .drc");
  if (format.value() == MeshFormat::kGltf) result = UnpackAsset(bytes, arguments);
  if (format.value() == MeshFormat::kDrc) result = UnpackStream(bytes, arguments);
  if (!result.ok()) return result.status().WithContext(arguments.input);
  return result;
}

int RunUnpack(const UnpackArguments& arguments) {
  const StatusOr<Unpacked> unpacked = Unpack(arguments);
  if (!unpacked.ok()) return Finish(unpacked.status());
  for (const std::string& note : unpacked.value().notes) std::fprintf(stderr, "lacerta: note: %s\n", note.c_str());
  if (arguments.json && arguments.output != "-") {
    Json json = {{"output", arguments.output}, {"notes", unpacked.value().notes}};
    if (unpacked.value().triangles > 0) json["triangles"] = unpacked.value().triangles;
    PrintJson(json);
  }
  return kExitOk;
}

}  // namespace

void AddUnpackCommand(CLI::App* app, int* exit_code) {
  const auto arguments = std::make_shared<UnpackArguments>();
  CLI::App* unpack = app->add_subcommand("unpack", "Turn a packed file into a plain one that every tool reads");
  unpack->add_option("IN", arguments->input, "A .glb, .gltf or .drc file; - for standard input")->required();
  unpack
      ->add_option("-o,--output", arguments->output,
                   "A .glb, .ply or .obj file; the latter two hold the shape of the default scene as one mesh; - for a .glb on standard output")
      ->required();
  unpack->add_option("--level", arguments->level, "Level to stop at, 0 = base (default: the finest)")
      ->check(CLI::NonNegativeNumber);
  unpack->add_flag("--json", arguments->json, "Print a report as JSON");
  unpack->footer(kExitCodeHelp);
  unpack->callback([arguments, exit_code] { *exit_code = RunUnpack(*arguments); });
}

}  // namespace lacerta::cli
