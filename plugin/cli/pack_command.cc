#include <algorithm>
#include <cctype>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "batch.h"
#include "commands.h"
#include "exit_code.h"
#include "lacerta/codec.h"
#include "lacerta/file_io.h"
#include "lacerta/gltf.h"
#include "lacerta/mesh_file.h"
#include "memory_budget.h"
#include "progress.h"
#include "report.h"

namespace lacerta::cli {
namespace {

struct PackArguments {
  std::vector<std::string> inputs;  // patterns
  std::string input;                // the file at hand
  std::string output;
  double bytes = 0.0;
  double bits_per_vertex = 0.0;
  double psnr = 0.0;
  double error = 0.0;
  double distance = 0.0;
  AttributeTargets attributes;
  std::string fallback = "draco";  // one of the names that AddPackCommand lists, like the next four
  std::string form = "draco";
  std::string mode = "default";
  std::string levels = "any";
  std::string effort = "normal";
  int quality_layers = 1;
  uint64_t memory = 0;  // bytes; 0: what is free
  bool external = false;
  bool keep_vertices = false;
  bool shape_only = false;
  bool drop_unused = false, drop_tangents = false;
  bool repair = false;
  bool float_targets = false;
  BatchOptions batch;
  bool tables = false;  // somebody is looking
};

EncodeTarget Target(const PackArguments& arguments) {
  if (arguments.bytes > 0.0) return {EncodeTarget::Kind::kBytes, arguments.bytes};
  if (arguments.bits_per_vertex > 0.0) return {EncodeTarget::Kind::kBitsPerVertex, arguments.bits_per_vertex};
  if (arguments.error > 0.0) return {EncodeTarget::Kind::kError, arguments.error};
  if (arguments.distance > 0.0) return {EncodeTarget::Kind::kDistance, arguments.distance};
  if (arguments.psnr > 0.0) return {EncodeTarget::Kind::kPsnr, arguments.psnr};
  return EncodeTarget();
}

// Whether a finished stream stays on the wrong side of what was asked for.
bool MissesTarget(const EncodeTarget& target, const EncodeReport& report) {
  if (report.levels.empty()) return false;
  const LevelReport& finest = report.levels.back();
  switch (target.kind) {
    case EncodeTarget::Kind::kBytes:
      return static_cast<double>(finest.bytes) > target.value;
    case EncodeTarget::Kind::kBitsPerVertex:
      return 8.0 * static_cast<double>(finest.bytes) > target.value * static_cast<double>(report.input_vertices);
    case EncodeTarget::Kind::kPsnr:
      return finest.psnr < target.value;
    case EncodeTarget::Kind::kError:
      return finest.error > target.value * report.diagonal;
    case EncodeTarget::Kind::kDistance:
      return finest.error > target.value;
  }
  return false;
}

bool MissesTarget(const EncodeTarget& target, const PackReport& report) {
  constexpr double kRounding = 1e-6;
  double bytes = 0.0;
  for (const PrimitiveReport& primitive : report.primitives) {
    bytes += static_cast<double>(primitive.bytes_after);
    if (target.kind == EncodeTarget::Kind::kBytes) continue;  // the whole file's
    if (target.kind == EncodeTarget::Kind::kBitsPerVertex) {
      if (MissesTarget(target, primitive.encode)) return true;
    } else if (primitive.storage != PrimitiveStorage::kUntouched) {
      const double error = primitive.encode.levels.empty() ? primitive.error : primitive.encode.levels.back().error;
      if (error > primitive.target_error * (1.0 + kRounding)) return true;
    }
  }
  return target.kind == EncodeTarget::Kind::kBytes && bytes > target.value;
}

std::string Extension(const std::string& path) { return std::filesystem::path(path).extension().string(); }

// What was mended or left aside is told to those, too, who see no table.
void TellNotes(const PackArguments& arguments, const std::vector<std::string>& notes) {
  if (arguments.tables || arguments.batch.json) return;
  for (const std::string& note : notes) std::fprintf(stderr, "lacerta: %s: %s\n", arguments.input.c_str(), note.c_str());
}

// The status of reading or packing the input, with its name and what can be done about it.
Status AboutInput(const PackArguments& arguments, const Status& status) {
  const bool may_help = !arguments.repair && status.code() == StatusCode::kInvalidData && status.message().find("finite") != std::string::npos;
  return (may_help ? InvalidData(status.message() + "; --repair does so") : status).WithContext(arguments.input);
}

void PrintPackReport(const PackArguments& arguments, const PackReport& report, uint64_t before, uint64_t after) {
  for (const PrimitiveReport& primitive : report.primitives) {
    std::printf("mesh %llu%s%s%s: %s, %llu -> %llu bytes%s%s\n", static_cast<unsigned long long>(primitive.mesh),
                primitive.name.empty() ? "" : " (", primitive.name.c_str(), primitive.name.empty() ? "" : ")",
                StorageName(primitive.storage), static_cast<unsigned long long>(primitive.bytes_before),
                static_cast<unsigned long long>(primitive.bytes_after), primitive.reason.empty() ? "" : "; ",
                primitive.reason.c_str());
    if (!primitive.encode.levels.empty()) {
      PrintLevels(primitive.encode);
    } else if (primitive.storage == PrimitiveStorage::kDraco) {
      PrintPrecision(primitive);
    }
  }
  for (const std::string& note : report.notes) std::printf("note: %s\n", note.c_str());
  std::printf("%s: %llu -> %llu bytes\n", arguments.output.c_str(), static_cast<unsigned long long>(before),
              static_cast<unsigned long long>(after));
}

// The surface of a file, and what of it a bare stream has no place for.
StatusOr<TriangleMesh> ReadSurface(const PackArguments& arguments, std::vector<std::string>* notes) {
  const std::string& path = arguments.input;
  const std::string folder = std::filesystem::path(path).parent_path().string();
  LACERTA_ASSIGN_OR_RETURN(const FileBytes bytes, OpenInput(path));
  StatusOr<MeshFormat> format = DetectMeshFormat(path, bytes.span());
  if (!format.ok()) return format.status().WithContext(path);
  if (format.value() == MeshFormat::kGltf) {
    if (arguments.repair) return InvalidArgument(path + ": --repair mends glTF assets on their way into a .glb; pack into one");
    StatusOr<TriangleMesh> mesh = ParseMesh(bytes, format.value(), folder);
    return mesh.ok() ? std::move(mesh) : StatusOr<TriangleMesh>(mesh.status().WithContext(path));
  }
  StatusOr<FileMesh> mesh = ParseFileMesh(bytes, format.value(), folder, arguments.repair);
  if (!mesh.ok()) return AboutInput(arguments, mesh.status());
  *notes = mesh.value().notes;
  if (!arguments.shape_only) {
    for (const MeshAttribute& attribute : mesh.value().mesh.attributes) {
      notes->push_back(attribute.name + " is left aside: a bare stream holds the shape alone; pack into a .glb to keep it");
    }
  }
  TriangleMesh surface = std::move(mesh.value().mesh.surface);
  const Vec3d origin = mesh.value().origin;
  if (origin == Vec3d{}) return surface;
  notes->push_back("the mesh is far from zero, where a bare stream rounds its positions to floats; pack into a .glb to keep their digits");
  for (Vec3f& position : surface.positions) position = Vec3Cast<float>(Vec3Cast<double>(position) + origin);
  return surface;
}

StatusOr<FileOutcome> PackStream(const PackArguments& arguments, const EncodeOptions& options) {
  std::vector<std::string> notes;
  LACERTA_ASSIGN_OR_RETURN(TriangleMesh mesh, ReadSurface(arguments, &notes));
  const StatusOr<EncodedMesh> encoded = EncodeMesh(std::move(mesh), options);
  if (!encoded.ok()) return encoded.status().WithContext(arguments.input);
  LACERTA_RETURN_IF_ERROR(WriteOutput(arguments.output, encoded.value().stream));
  const EncodeReport& report = encoded.value().report;
  const bool missed = MissesTarget(options.target, report);
  FileOutcome outcome;
  outcome.exit_code = missed ? kExitTargetMissed : kExitOk;
  outcome.bytes_after = encoded.value().stream.size();
  outcome.json = {{"bytes", outcome.bytes_after}, {"targetMet", !missed}, {"encode", ToJson(report)}, {"notes", notes}};
  if (arguments.tables) {
    PrintLevels(report);
    for (const std::string& note : notes) std::printf("note: %s\n", note.c_str());
    if (!report.reason.empty()) std::printf("note: %s\n", report.reason.c_str());
  }
  TellNotes(arguments, notes);
  if (missed)
    std::fprintf(stderr, "lacerta: %s misses the target: %s\n", arguments.output.c_str(), report.reason.c_str());
  return outcome;
}

StatusOr<PackResult> PackAny(const PackArguments& arguments, const PackOptions& options, uint64_t* input_bytes) {
  LACERTA_ASSIGN_OR_RETURN(FileBytes file, OpenInput(arguments.input));
  const Span<const uint8_t> bytes = file.span();
  *input_bytes = bytes.size();
  const bool is_json = arguments.input == "-" && !bytes.empty() && bytes[0] == '{';
  StatusOr<MeshFormat> format = MeshFormat::kGltf;
  if (!is_json) format = DetectMeshFormat(arguments.input, bytes);
  if (!format.ok()) return format.status();
  if (format.value() == MeshFormat::kGltf) return PackGltf(bytes, options);
  const std::string name = std::filesystem::path(arguments.input).stem().string();
  LACERTA_ASSIGN_OR_RETURN(FileMesh mesh, ParseFileMesh(file, format.value(), options.folder, arguments.repair));
  file = FileBytes();  // large meshes fill the memory
  if (arguments.shape_only) mesh = ShapeOf(std::move(mesh));
  return PackMesh(std::move(mesh), name, options);
}

// A relative URI of a file name: what is not safe in one is escaped.
std::string UriOf(const std::string& name) {
  std::string uri;
  for (const char c : name) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isalnum(byte) != 0 || c == '.' || c == '-' || c == '_') {
      uri += c;
    } else {
      char escaped[4];
      std::snprintf(escaped, sizeof(escaped), "%%%02X", byte);
      uri += escaped;
    }
  }
  return uri;
}

StatusOr<FileOutcome> PackAsset(const PackArguments& arguments, const EncodeOptions& encode) {
  PackOptions options;
  options.encode = encode;
  options.attributes = arguments.attributes;
  options.simplify = !arguments.keep_vertices;
  options.drop_unused = arguments.drop_unused;
  options.drop_tangents = arguments.drop_tangents;
  options.repair = arguments.repair;
  options.float_targets = arguments.float_targets;
  if (arguments.fallback == "plain") options.fallback = Fallback::kPlain;
  if (arguments.fallback == "none") options.fallback = Fallback::kNone;
  options.folder = std::filesystem::path(arguments.input).parent_path().string();
  options.embed_images = AreApart(arguments.input, arguments.output);
  const std::filesystem::path external = std::filesystem::path(arguments.output).replace_extension(".refinements.bin");
  if (arguments.external) options.external_uri = UriOf(external.filename().string());
  FileOutcome outcome;
  const StatusOr<PackResult> packed = PackAny(arguments, options, &outcome.bytes_before);
  if (!packed.ok()) return AboutInput(arguments, packed.status());
  // The GLB last: where it is, all that it refers to is.
  if (!packed.value().external.empty()) {
    LACERTA_RETURN_IF_ERROR(WriteOutput(external.string(), packed.value().external));
  }
  LACERTA_RETURN_IF_ERROR(WriteOutput(arguments.output, packed.value().glb));
  const PackReport& report = packed.value().report;
  const bool missed = MissesTarget(encode.target, report);
  outcome.exit_code = missed ? kExitTargetMissed : kExitOk;
  outcome.bytes_after = packed.value().glb.size() + packed.value().external.size();
  outcome.json = {{"bytes", packed.value().glb.size()}, {"targetMet", !missed}};
  if (arguments.external) outcome.json["externalBytes"] = packed.value().external.size();
  outcome.json.update(ToJson(report));
  if (arguments.tables) PrintPackReport(arguments, report, outcome.bytes_before, outcome.bytes_after);
  TellNotes(arguments, report.notes);
  if (missed)
    std::fprintf(stderr, "lacerta: %s misses the target; see the report for the reason\n", arguments.output.c_str());
  return outcome;
}

FileOutcome PackFile(PackArguments arguments, const EncodeOptions& options, const BatchItem& item) {
  arguments.input = item.input;
  arguments.output = item.output;
  const std::string extension = Extension(arguments.output);
  StatusOr<FileOutcome> result = InvalidArgument(arguments.output + ": the output has to be a .glb or .drc file");
  if (extension == ".glb" || arguments.output == "-") result = PackAsset(arguments, options);
  if (extension == ".drc") result = PackStream(arguments, options);
  if (result.ok()) return std::move(result).value();
  FileOutcome outcome;
  outcome.status = result.status();
  return outcome;
}

StatusOr<std::vector<BatchItem>> Items(const PackArguments& arguments) {
  if (arguments.external && arguments.output == "-") {
    return InvalidArgument("--external needs a file to write to: standard output is one");
  }
  LACERTA_ASSIGN_OR_RETURN(const std::vector<std::string> inputs,
                           ExpandInputs(arguments.inputs, {".glb", ".gltf", ".obj", ".ply", ".off", ".stl", ".drc"}));
  return PairOutputs(arguments.inputs, inputs, arguments.output, ".glb");
}

int RunPack(PackArguments arguments) {
  const StatusOr<std::vector<BatchItem>> items = Items(arguments);
  if (!items.ok()) return Finish(items.status());
  const bool single = items.value().size() == 1;
  arguments.tables = single && !arguments.batch.json && items.value()[0].output != "-" && StdoutIsTerminal();
  const uint64_t memory = arguments.memory != 0 ? arguments.memory : FreeMemory().value_or(0);
  if (memory != 0) HoldToMemory(memory);
  ProgressLine progress;
  EncodeOptions options;
  options.target = Target(arguments);
  options.form = arguments.form == "custom" ? StreamForm::kCustom : StreamForm::kDraco;
  options.quality_layers = arguments.quality_layers;
  options.levels = arguments.levels == "0"        ? LevelChoice::kNever
                   : arguments.levels == "always" ? LevelChoice::kAlways
                                                  : LevelChoice::kWhereTheyPay;
  options.mode = arguments.mode == "paper" ? EncodeMode::kPaper : EncodeMode::kDefault;
  options.effort = arguments.effort == "fast" ? Effort::kFast : arguments.effort == "best" ? Effort::kBest : Effort::kNormal;
  const auto at_a_time = std::min<uint64_t>(static_cast<uint64_t>(std::max(arguments.batch.jobs, 1)), std::max<size_t>(items.value().size(), 1));
  options.memory = memory / at_a_time;
  if (single) options.progress = progress.Callback();
  return RunBatch(items.value(), arguments.batch,
                  [&](const BatchItem& item) { return PackFile(arguments, options, item); });
}

}  // namespace

void AddPackCommand(CLI::App* app, int* exit_code) {
  const auto arguments = std::make_shared<PackArguments>();
  CLI::App* pack = app->add_subcommand("pack", "Compress a mesh or an asset");
  pack->add_option("IN", arguments->inputs,
                   "Files (.glb, .gltf, .obj, .ply, .off, .stl, .drc), patterns with *, ? and **, folders; - for standard input")
      ->required();
  pack->add_option("-o,--output", arguments->output,
                   "A .glb asset or a bare .drc stream; a folder for several inputs; - for standard output")
      ->required();
  CLI::Option_group* target = pack->add_option_group("target", "What to aim at (default: --psnr 70)");
  target->add_option("--bytes", arguments->bytes, "At most this many bytes of geometry, within 2 %")
      ->check(Positive());
  target->add_option("--bpv", arguments->bits_per_vertex, "At most this many bits per vertex of the input")
      ->check(Positive());
  target->add_option("--psnr", arguments->psnr, "At least this PSNR in dB, 20 log10(diagonal / error)")
      ->check(Positive());
  target->add_option("--error", arguments->error, "At most this surface error, as a share of the diagonal")
      ->check(Positive());
  target->add_option("--distance", arguments->distance, "At most this surface error, in units of the mesh; of an asset, of its scene")
      ->check(Positive());
  target->require_option(0, 1);
  pack->add_option("--uv-error", arguments->attributes.uv_texels,
                   "At most this RMS error of texture coordinates, in texels of the asset's largest texture (at least 1024; default: 1)")
      ->check(Positive());
  pack->add_option("--custom-error", arguments->attributes.custom,
                   "Error of application attributes of floats, relative to their range (RMS); 0 keeps them exact")
      ->check(CLI::NonNegativeNumber);
  pack->add_option("--normal-error", arguments->attributes.normal_degrees,
                   "At most this RMS error of normals and tangents, in degrees (default: 2); of simplified surfaces over the 99 % of the "
                   "area where it is least")
      ->check(Positive());
  pack->add_option_function<double>(
          "--color-error", [arguments](double error) { arguments->attributes.color = error / 255; },
          "At most this RMS error of each component of colors as screens show them (sRGB), in 255ths; but no less than integers of 8 "
          "bits have (default: 1.5)")
      ->check(Positive());
  pack->add_flag("--normals-everywhere", arguments->attributes.normals_everywhere,
                 "Hold the normals of simplified surfaces to --normal-error over their whole area");
  pack->add_option("--fallback", arguments->fallback, "What readers without the extension show (.glb; default: draco)")
      ->check(CLI::IsMember({"draco", "plain", "none"}));
  pack->add_option("--form", arguments->form,
                   "draco (default): every Draco reader shows the base; custom: only Lacerta opens it, which saves up to a quarter of the base")
      ->check(CLI::IsMember({"draco", "custom"}));
  pack->add_option("--mode", arguments->mode, "default, or paper: as published, open loop")
      ->check(CLI::IsMember({"default", "paper"}));
  pack->add_option("--quality-layers", arguments->quality_layers,
                   "1 (default) to 8: coefficients come in so many rounds, so that a file cut short is nearer to the surface; the whole takes "
                   "some percent more bytes")
      ->check(CLI::Range(1, 8));
  pack->add_option("--levels", arguments->levels, "any (default): refinement unless a simplified mesh without levels is clearly smaller; always; 0: never")
      ->check(CLI::IsMember({"any", "always", "0"}));
  pack->add_option("--effort", arguments->effort, "fast: about half the time, 4 % more bytes; normal (default); best: 30 % more time, never more bytes, 0.3 % fewer in the mean; assets two to three times the time")
      ->check(CLI::IsMember({"fast", "normal", "best"}));
  pack->add_flag("--external", arguments->external,
                 "Put refinements into a second file, OUT.refinements.bin, which readers fetch when they want it");
  pack->add_flag("--keep-vertices", arguments->keep_vertices, "Do not simplify surfaces with attributes, only round them");
  pack->add_flag("--float-targets", arguments->float_targets,
                 "Leave offsets of morph targets floats, for readers that do not know KHR_mesh_quantization");
  pack->add_flag("--shape-only", arguments->shape_only,
                 "Of .obj and .ply files take the shape alone, without texture coordinates, normals, colors and materials");
  pack->add_flag("--drop-unused", arguments->drop_unused,
                 "Leave out attributes that nothing in the asset shows: texture coordinates without a texture, normals of unlit materials, tangents without a "
                 "normal map, colors beyond COLOR_0, weights without a skin");
  pack->add_flag("--drop-tangents", arguments->drop_tangents,
                 "Leave out tangents of normal maps, for readers that compute them as glTF says (not all do: VTK shades dark without); those of anisotropy stay");
  pack->add_flag("--repair", arguments->repair,
                 "Mend numbers that are not finite instead of refusing the file, and tell so: vertices without a position go with their triangles, "
                 "other values follow those beside them");
  pack->add_option("--memory", arguments->memory, "At most this much memory, such as 800M or 12G (default: what is free): large surfaces make do with less, down to 45 bytes a triangle; "
                   "what needs more fails by name")
      ->transform(CLI::AsSizeValue(false));
  AddBatchOptions(pack, &arguments->batch);
  pack->add_flag("--json", arguments->batch.json, "Print a report as JSON");
  pack->footer(kExitCodeHelp);
  pack->callback([arguments, exit_code] { *exit_code = RunPack(*arguments); });
}

}  // namespace lacerta::cli
