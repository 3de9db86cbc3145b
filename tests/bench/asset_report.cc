// One asset packed, beside stock Draco with the fewest bits that meet the same errors, measured in the same way:
//   asset_report ORIGINAL.glb PACKED.glb UNPACKED.glb [--psnr DB] [--texels N] [--degrees N] [--without-stock]
// Prints one line of JSON. Errors are those of the worst mesh (meshes that touch count as one); UV in texels as the packer counts
// them: of the asset's largest texture (at least 1024), as often as KHR_texture_transform repeats it.
#include <draco/compression/expert_encode.h>
#include <draco/mesh/mesh.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "document/buffer_edit.h"
#include "document/draco_primitive.h"
#include "document/normals.h"
#include "document/place.h"
#include "document/primitive.h"
#include "lacerta/file_io.h"
#include "lacerta/gltf.h"
#include "lacerta/surface_distance.h"
#include "pack/attributed_family.h"
#include "pack/family.h"
#include "pack/texel_scale.h"
#include "remesh/simplify_to_errors.h"

namespace lacerta {
namespace {

struct Errors {
  double psnr = kMaxPsnr, texels = 0.0, degrees = 0.0, turned = 0.0;
};

std::string FolderOf(const std::string& path) { return std::filesystem::path(path).parent_path().string(); }

StatusOr<TriangleMesh> ReadScene(const std::string& path) {
  LACERTA_ASSIGN_OR_RETURN(const Bytes bytes, ReadFile(path));
  UnpackOptions options;
  options.folder = FolderOf(path);
  LACERTA_ASSIGN_OR_RETURN(FlattenResult scene, FlattenGltf(bytes, options));
  return std::move(scene.mesh);
}

struct Asset {
  GltfDocument document;
  std::vector<Place> places;
  std::vector<Primitive> primitives;
  std::vector<uint8_t> is_repeated;  // whether a primitive before it has the same vertices and indices, so that one stream does for both
  uint64_t target_bytes = 0;  // of morph targets, which Draco leaves as they are
};

StatusOr<Asset> Read(const std::string& path) {
  Asset asset;
  LACERTA_ASSIGN_OR_RETURN(const Bytes bytes, ReadFile(path));
  LACERTA_ASSIGN_OR_RETURN(asset.document, ParseGltf(bytes, FolderOf(path)));
  std::set<std::pair<uint64_t, uint64_t>> firsts;
  for (const std::vector<Place>& places : GroupByGeometry(asset.document)) firsts.insert({places[0].mesh, places[0].primitive});
  for (const Place& place : AllPlaces(asset.document)) {
    StatusOr<Primitive> primitive = ReadPrimitive(asset.document, PrimitiveAt(asset.document, place), {});
    if (!primitive.ok()) continue;
    const Json& json = PrimitiveAt(asset.document, place);
    const bool is_repeated = firsts.count({place.mesh, place.primitive}) == 0;
    for (uint64_t t = 0; !is_repeated && t < ArraySize(json, "targets"); ++t) {
      for (const Json& accessor : *FindElement(json, "targets", t)) {
        const StatusOr<AccessorData> data = ReadAccessor(asset.document, accessor.get<uint64_t>());
        if (data.ok()) asset.target_bytes += StoredSize(data.value());
      }
    }
    asset.places.push_back(place);
    asset.primitives.push_back(std::move(primitive).value());
    asset.is_repeated.push_back(is_repeated);
  }
  return asset;
}

// Takes normals of flat shading off where packing has left them out, since readers shade so without: there is nothing to compare.
void TakeOffFlatNormals(const std::vector<Primitive>& unpacked, std::vector<Primitive>* original) {
  for (size_t i = 0; i < std::min(unpacked.size(), original->size()); ++i) {
    Primitive& primitive = (*original)[i];
    const Attribute* normal = primitive.Find("NORMAL");
    if (normal == nullptr || unpacked[i].Find("NORMAL") != nullptr) continue;
    const auto position_at = [&](uint32_t v) { return VectorAt(primitive.Find("POSITION")->data, v); };
    if (!NormalsAreFlat(primitive.triangles, position_at, primitive.triangles, [&](uint32_t v) { return VectorAt(normal->data, v); })) continue;
    primitive.attributes.erase(primitive.attributes.begin() + (normal - primitive.attributes.data()));
  }
}

// What the errors of a family are held against.
struct Judge {
  std::vector<size_t> members;
  double scale = 0.0;  // of the PSNR: what has the error of the target at that PSNR; for most the scene's diagonal, mesh units
  TexelScale texels;
  AttributedMesh original;
  SurfaceErrorMeter meter;
  ErrorTargets units;  // one texel, one degree
};

StatusOr<AttributedMesh> Join(const std::vector<Primitive>& primitives, const std::vector<size_t>& members, const TexelScale& texels) {
  std::vector<const Primitive*> own;
  for (const size_t member : members) own.push_back(&primitives[member]);
  return ToAttributedMesh(own, texels, OtherAttributes::kLeaveOut);
}

// psnr: of the target; surfaces small in their scene may not be as far off as the scene's diagonal would let them.
StatusOr<std::vector<Judge>> MakeJudges(const Asset& original, double psnr) {
  const uint64_t side = TexelSide(original.document);
  std::vector<std::vector<Place>> places;
  for (const Place& place : original.places) places.push_back({place});
  std::vector<PlacedSurface> surfaces;
  for (size_t i = 0; i < places.size(); ++i) surfaces.push_back({&places[i], Surface(original.primitives[i])});
  LACERTA_ASSIGN_OR_RETURN(const Families families, FindFamilies(original.document, surfaces));
  std::vector<Judge> judges;
  for (size_t f = 0; f < families.families.size(); ++f) {
    const std::vector<size_t>& members = families.families[f].members;
    std::vector<PlacedPrimitive> placed;
    for (const size_t member : members) placed.push_back({&places[member], &original.primitives[member]});
    const TexelScale texels = TexelScaleOf(original.document, placed, side);
    LACERTA_ASSIGN_OR_RETURN(AttributedMesh mesh, Join(original.primitives, members, texels));
    StatusOr<SurfaceErrorMeter> meter = SurfaceErrorMeter::Create(mesh, static_cast<double>(side));
    if (!meter.ok()) continue;  // nothing to see
    const double scale = FamilyError(families, f, psnr) * std::pow(10.0, psnr / 20.0);
    AttributeTargets one;
    one.uv_texels = 1.0;
    one.normal_degrees = 1.0;
    ErrorTargets units = FamilyTargets(mesh, 1.0, one, side);
    judges.push_back({members, scale, texels, std::move(mesh), std::move(meter).value(), std::move(units)});
  }
  return judges;
}

// Few while bits are looked for; many, others than the packer's, of what it made.
constexpr uint64_t kSearchSamples = 20'000, kSamples = 1'000'000;

StatusOr<Errors> MeasureAll(const std::vector<Judge>& judges, const std::vector<Primitive>& primitives, uint64_t samples) {
  Errors worst;
  for (const Judge& judge : judges) {
    LACERTA_ASSIGN_OR_RETURN(const AttributedMesh mesh, Join(primitives, judge.members, judge.texels));
    LACERTA_ASSIGN_OR_RETURN(const SurfaceErrors errors, judge.meter.Measure(mesh, samples));
    worst.psnr = std::min(worst.psnr, Psnr(errors.distance, judge.scale));
    worst.turned = std::max(worst.turned, errors.MostTurned());
    for (size_t a = 0; a < judge.original.attributes.size(); ++a) {
      const double error = errors.attributes[a].rms_99 / judge.units.attributes[a];
      const AttributeKind kind = judge.original.attributes[a].kind;
      if (kind == AttributeKind::kTextureCoordinates) worst.texels = std::max(worst.texels, error);
      if (kind == AttributeKind::kNormal || kind == AttributeKind::kTangent) worst.degrees = std::max(worst.degrees, error);
    }
  }
  return worst;
}

using Bits = std::array<int, 3>;  // positions, texture coordinates, directions

// As the stock tools do it: every primitive by itself, over its own range.
StatusOr<uint64_t> EncodeStock(const Asset& asset, const Bits& bits, std::vector<Primitive>* decoded) {
  uint64_t sum = 0;
  decoded->clear();
  for (size_t p = 0; p < asset.primitives.size(); ++p) {
    const Primitive& primitive = asset.primitives[p];
    draco::Mesh mesh;
    mesh.set_num_points(static_cast<uint32_t>(primitive.num_vertices));
    for (const Triangle& t : primitive.triangles) {
      mesh.AddFace({{draco::PointIndex(t[0]), draco::PointIndex(t[1]), draco::PointIndex(t[2])}});
    }
    std::vector<DracoAttributeId> ids;
    std::vector<int> bits_of;
    for (const Attribute& attribute : primitive.attributes) {
      const std::string& name = attribute.name;
      const bool is_texture = name.rfind("TEXCOORD_", 0) == 0, is_position = name == "POSITION", is_normal = name == "NORMAL";
      const bool is_float = attribute.data.type == ComponentType::kFloat;
      const size_t size = attribute.data.components * ComponentSize(attribute.data.type);
      draco::GeometryAttribute description;
      const draco::DataType type = is_float                                          ? draco::DT_FLOAT32
                                   : attribute.data.type == ComponentType::kUint8  ? draco::DT_UINT8
                                   : attribute.data.type == ComponentType::kUint16 ? draco::DT_UINT16
                                                                                     : draco::DT_UINT32;
      description.Init(is_position  ? draco::GeometryAttribute::POSITION
                       : is_normal  ? draco::GeometryAttribute::NORMAL
                       : is_texture ? draco::GeometryAttribute::TEX_COORD
                                    : draco::GeometryAttribute::GENERIC,
                       nullptr, static_cast<int8_t>(attribute.data.components), type, attribute.data.normalized,
                       static_cast<int64_t>(size), 0);
      const int id = mesh.AddAttribute(description, true, static_cast<uint32_t>(attribute.data.count));
      mesh.attribute(id)->buffer()->Write(0, attribute.data.bytes.data(), attribute.data.bytes.size());
      ids.push_back({name, mesh.attribute(id)->unique_id()});
      constexpr int kOtherBits = 8;  // colors, weights
      bits_of.push_back(!is_float ? 0 : is_position ? bits[0] : is_texture ? bits[1] : is_normal || name == "TANGENT" ? bits[2] : kOtherBits);
    }
    if (!mesh.DeduplicateAttributeValues()) return Unsupported("Draco refuses the attributes");
    mesh.DeduplicatePointIds();
    draco::ExpertEncoder encoder(mesh);
    encoder.SetSpeedOptions(0, 0);
    encoder.SetEncodingMethod(draco::MESH_EDGEBREAKER_ENCODING);
    for (size_t a = 0; a < bits_of.size(); ++a) {
      if (bits_of[a] > 0) encoder.SetAttributeQuantization(static_cast<int>(a), bits_of[a]);
    }
    draco::EncoderBuffer buffer;
    if (!encoder.EncodeToBuffer(&buffer).ok()) return Unsupported("Draco refuses a primitive");
    sum += asset.is_repeated[p] ? 0 : buffer.size();
    const Span<const uint8_t> bytes(reinterpret_cast<const uint8_t*>(buffer.data()), buffer.size());
    LACERTA_ASSIGN_OR_RETURN(Primitive result, DecodeDracoPrimitive(bytes, ids, {}));
    decoded->push_back(std::move(result));
  }
  return sum;
}

struct Stock {
  Bits bits = {};
  uint64_t bytes = 0;
  Errors errors;
};

// The smallest of the sizes at which all errors are met: positions from the fewest bits on that meet theirs, for each the fewest bits of
// the attributes, until finer positions no longer pay. Coarse positions move the texture, too.
StatusOr<Stock> FewestStock(const Asset& asset, const std::vector<Judge>& judges, const Errors& wanted) {
  constexpr int kMostBits = 20;
  constexpr int kPatience = 2;
  std::optional<Stock> best;
  Stock last;
  Bits start = {0, 6, 4};
  int worse = 0;
  for (int positions = 7; positions <= kMostBits && worse < kPatience; ++positions) {
    Stock stock;
    stock.bits = {positions, start[1], start[2]};
    bool met = false, far = false;
    for (;;) {
      std::vector<Primitive> decoded;
      LACERTA_ASSIGN_OR_RETURN(stock.bytes, EncodeStock(asset, stock.bits, &decoded));
      const StatusOr<Errors> errors = MeasureAll(judges, decoded, kSearchSamples);  // a group may have lost its area
      stock.errors = errors.ok() ? errors.value() : Errors{0.0, 1e9, 1e9};
      far = stock.errors.psnr < wanted.psnr;
      const bool blurred = stock.errors.texels > wanted.texels, tilted = stock.errors.degrees > wanted.degrees;
      met = !far && !blurred && !tilted;
      if (met || far || (blurred && stock.bits[1] == kMostBits) || (tilted && stock.bits[2] == kMostBits)) break;
      stock.bits[1] += blurred;
      stock.bits[2] += tilted;
      // Many bits more that do not help: positions are too coarse.
      if ((blurred && stock.bits[1] > start[1] + 8) || (tilted && stock.bits[2] > start[2] + 6)) break;
    }
    last = stock;
    if (!met) continue;
    ++worse;
    // Finer positions ask for no more bits of the attributes, and for hardly fewer than two less.
    start = {0, std::max(stock.bits[1] - 2, 6), std::max(stock.bits[2] - 2, 4)};
    if (best.has_value() && stock.bytes >= best->bytes) continue;
    worse = 0;
    best = stock;
  }
  return best.value_or(last);
}

uint64_t BorderEdges(const TriangleMesh& mesh) {
  const auto key = [](const Vec3f& p) { return std::make_tuple(p.x, p.y, p.z); };
  std::map<std::tuple<float, float, float>, size_t> ids;
  std::map<std::pair<size_t, size_t>, int> edges;
  for (const Triangle& t : mesh.triangles) {
    size_t v[3];
    for (size_t i = 0; i < 3; ++i) v[i] = ids.emplace(key(mesh.positions[t[i]]), ids.size()).first->second;
    if (v[0] == v[1] || v[1] == v[2] || v[2] == v[0]) continue;
    for (int i = 0; i < 3; ++i) ++edges[std::minmax(v[i], v[(i + 1) % 3])];
  }
  return static_cast<uint64_t>(std::count_if(edges.begin(), edges.end(), [](const auto& e) { return e.second == 1; }));
}

Status Report(const std::vector<std::string>& files, const Errors& wanted, bool with_stock) {
  LACERTA_ASSIGN_OR_RETURN(Asset original, Read(files[0]));
  LACERTA_ASSIGN_OR_RETURN(const Bytes packed, ReadFile(files[1]));
  LACERTA_ASSIGN_OR_RETURN(const Asset unpacked, Read(files[2]));
  TakeOffFlatNormals(unpacked.primitives, &original.primitives);
  LACERTA_ASSIGN_OR_RETURN(const std::vector<Judge> judges, MakeJudges(original, wanted.psnr));
  LACERTA_ASSIGN_OR_RETURN(const Errors ours, MeasureAll(judges, unpacked.primitives, kSamples));
  const StatusOr<TriangleMesh> scene = ReadScene(files[0]);  // some show no triangles: points, or meshes outside of scenes
  TriangleMesh before, after;
  double farthest = 0;  // any point of one from the other, in distances that the PSNR allows in the mean
  if (scene.ok()) {
    before = scene.value();
    LACERTA_ASSIGN_OR_RETURN(after, ReadScene(files[2]));
    LACERTA_ASSIGN_OR_RETURN(const SurfaceDistance distance, MeasureSurfaceDistance(before, after));
    farthest = distance.Hausdorff() / DistanceOfPsnr(wanted.psnr, BoundingBoxDiagonal(before));
  }

  Stock stock;  // nothing where Draco refuses
  if (with_stock) {
    if (const StatusOr<Stock> found = FewestStock(original, judges, wanted); found.ok()) stock = found.value();
  }
  uint64_t vertices = 0;
  for (const Primitive& primitive : original.primitives) vertices += primitive.num_vertices;
  std::printf("{\"vertices\": %llu, \"psnr\": %.2f, \"texels\": %.3f, \"degrees\": %.3f, \"turned\": %.5f, \"farthest\": %.1f, \"borderEdgesBefore\": %llu, \"borderEdgesAfter\": %llu, "
              "\"stockBytes\": %llu, \"stockBits\": [%d, %d, %d], \"stockPsnr\": %.2f, \"stockTexels\": %.3f, \"stockDegrees\": %.3f}\n",
              static_cast<unsigned long long>(vertices), ours.psnr, ours.texels, ours.degrees, ours.turned, farthest,
              static_cast<unsigned long long>(BorderEdges(before)), static_cast<unsigned long long>(BorderEdges(after)),
              static_cast<unsigned long long>(stock.bytes + original.target_bytes), stock.bits[0], stock.bits[1], stock.bits[2], stock.errors.psnr, stock.errors.texels, stock.errors.degrees);
  return Status();
}

}  // namespace
}  // namespace lacerta

int main(int argc, char** argv) {
  lacerta::Errors wanted{70.0, 1.0, 2.0};
  std::vector<std::string> files;
  bool with_stock = true;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    double* number = argument == "--psnr"      ? &wanted.psnr
                     : argument == "--texels"  ? &wanted.texels
                     : argument == "--degrees" ? &wanted.degrees
                                               : nullptr;
    if (argument == "--without-stock") {
      with_stock = false;
    } else if (number != nullptr && i + 1 < argc) {
      *number = std::atof(argv[++i]);
    } else {
      files.push_back(argument);
    }
  }
  if (files.size() != 3) {
    std::fprintf(stderr, "usage: asset_report ORIGINAL PACKED UNPACKED [--psnr DB] [--texels N] [--degrees N] [--without-stock]\n");
    return 1;
  }
  const lacerta::Status status = lacerta::Report(files, wanted, with_stock);
  if (!status.ok()) std::fprintf(stderr, "%s: %s\n", files[0].c_str(), status.message().c_str());
  return status.ok() ? 0 : 1;
}
