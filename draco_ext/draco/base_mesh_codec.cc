#include "draco/base_mesh_codec.h"

#include <draco/attributes/geometry_attribute.h>
#include <draco/attributes/point_attribute.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include "common/stream_layout.h"
#include "common/subdivision.h"
#include "lacerta/decoder.h"
#include "draco/mesh_conversion.h"
#include "draco/recoded_stream.h"
#include "draco/smallest_stream.h"
#include "draco/stock_stream.h"
#include "encoder/compact_base_encoder.h"

namespace lacerta {
namespace {

// A base as Draco is given it: integers from 0 on, as floats.
struct IntegerMesh {
  std::array<int32_t, 3> origin{};
  int bits = 1;
  TriangleMesh mesh;
};

bool IsUsableStep(float step) { return std::isnormal(step) && step > 0.0f; }

StatusOr<IntegerMesh> ToIntegerMesh(const BaseMesh& base) {
  if (!IsUsableStep(base.step)) {
    return InvalidData("step of the base lattice is " + std::to_string(base.step) + "; it must be positive and normal");
  }
  if (base.lattice.empty() || base.triangles.empty()) return InvalidData("base mesh is empty");
  const auto topology = BuildTopology(static_cast<uint32_t>(base.lattice.size()), base.triangles);
  LACERTA_RETURN_IF_ERROR(topology.status().WithContext("base mesh"));
  std::array<int32_t, 3> low = base.lattice[0];
  std::array<int32_t, 3> high = base.lattice[0];
  for (size_t v = 0; v < base.lattice.size(); ++v) {
    for (size_t c = 0; c < 3; ++c) {
      const int32_t value = base.lattice[v][c];
      if (value < -kMaxLatticeValue || value > kMaxLatticeValue) {
        return InvalidData("lattice value " + std::to_string(value) + " of base vertex " + std::to_string(v) +
                           " is 2^24 or more; choose a larger step");
      }
      low[c] = std::min(low[c], value);
      high[c] = std::max(high[c], value);
    }
  }
  IntegerMesh result;
  result.origin = low;
  const int32_t extent = std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
  while (extent >> result.bits != 0) ++result.bits;
  if (result.bits > 24) return InvalidData("base lattice spans more than 24 bits; choose a larger step");
  for (const std::array<int32_t, 3>& p : base.lattice) {
    result.mesh.positions.push_back(
        {static_cast<float>(p[0] - low[0]), static_cast<float>(p[1] - low[1]), static_cast<float>(p[2] - low[2])});
  }
  result.mesh.triangles = base.triangles;
  return result;
}

// The input vertex behind each vertex of `coded`, the decoded triangles of the stream. Draco does not tell, so the same
// mesh is coded once more with the vertex number as a second attribute: that may change the order of the vertices but
// not the one of triangles and corners. (IsRenumbering makes sure of it.)
StatusOr<std::vector<uint32_t>> FindVertexMap(const IntegerMesh& base, const StockAttempt& attempt,
                                              const std::vector<Triangle>& coded) {
  const auto mesh = ToDracoMesh(StartingAsIn(attempt, base.mesh));
  const auto num_vertices = static_cast<uint32_t>(base.mesh.positions.size());
  draco::GeometryAttribute description;
  description.Init(draco::GeometryAttribute::GENERIC, nullptr, 1, draco::DT_UINT32, false, sizeof(uint32_t), 0);
  const int id = mesh->AddAttribute(description, /*identity_mapping=*/true, num_vertices);
  for (uint32_t v = 0; v < num_vertices; ++v) mesh->attribute(id)->SetAttributeValue(draco::AttributeValueIndex(v), &v);
  LACERTA_ASSIGN_OR_RETURN(const Bytes stream, EncodeIntegerPositions(*mesh, base.bits, attempt.settings));
  LACERTA_ASSIGN_OR_RETURN(const StockMesh numbered, DecodeStockStream(stream, kNoDecodeLimits));
  const draco::PointAttribute* const numbers = numbered.mesh->GetNamedAttribute(draco::GeometryAttribute::GENERIC);
  if (numbers == nullptr || numbered.mesh->num_faces() != coded.size()) {
    return InternalError("Draco lost the vertex numbers of the base mesh");
  }
  std::vector<uint32_t> map(num_vertices, num_vertices);
  for (uint32_t f = 0; f < coded.size(); ++f) {
    const draco::Mesh::Face& face = numbered.mesh->face(draco::FaceIndex(f));
    for (size_t k = 0; k < 3; ++k) {
      numbers->ConvertValue<uint32_t, 1>(numbers->mapped_index(face[k]), &map[coded[f][k]]);
    }
  }
  return map;
}

Triangle StartingWithSmallest(Triangle t) {
  std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  return t;
}

// Whether `coded` is `base` with its vertices renumbered by `map`, the triangles in another order.
bool IsRenumbering(const BaseMesh& base, const BaseMesh& coded, const std::vector<uint32_t>& map) {
  if (map.size() != base.lattice.size() || coded.lattice.size() != map.size()) return false;
  std::vector<bool> seen(map.size(), false);
  for (size_t v = 0; v < map.size(); ++v) {
    if (map[v] >= map.size() || seen[map[v]] || coded.lattice[v] != base.lattice[map[v]]) return false;
    seen[map[v]] = true;
  }
  std::vector<Triangle> before;
  std::vector<Triangle> after;
  for (const Triangle& t : base.triangles) before.push_back(StartingWithSmallest(t));
  for (const Triangle& t : coded.triangles) after.push_back(StartingWithSmallest({map[t[0]], map[t[1]], map[t[2]]}));
  std::sort(before.begin(), before.end());
  std::sort(after.begin(), after.end());
  return before == after;
}

// Puts the lattice's place in space into a stream of its integers.
Status PlaceOnLattice(const IntegerMesh& integers, float step, Bytes* stream) {
  QuantizationGrid grid;
  for (int c = 0; c < 3; ++c) grid.origin[c] = step * static_cast<float>(integers.origin[static_cast<size_t>(c)]);
  grid.range = RangeForStep(step, integers.bits);
  if (!std::isfinite(grid.range)) return InvalidData("step times extent of the base lattice does not fit a float");
  return SetQuantizationGrid(grid, stream);
}

StatusOr<CodedBase> EncodeCompact(const BaseMesh& base) {
  LACERTA_ASSIGN_OR_RETURN(CompactBaseBytes compact, EncodeCompactBaseSmallest(base));
  CodedBase result;
  result.stream = std::move(compact.bytes);
  result.mesh = std::move(compact.mesh);
  result.vertex_map = std::move(compact.vertex_map);
  result.coding = BaseCoding::kCompact;
  return result;
}

StatusOr<Bytes> RecodeCompact(const BaseMesh& moved) {
  LACERTA_ASSIGN_OR_RETURN(CompactBaseBytes compact, EncodeCompactBase(moved));
  if (compact.mesh.triangles != moved.triangles) return InternalError("the moved base mesh was coded in another order");
  return std::move(compact.bytes);
}

}  // namespace

float ShortStep(float step) {
  int exponent = 0;
  const float significand = std::frexp(step, &exponent);
  return std::ldexp(std::floor(std::ldexp(significand, 8)), exponent - 8);
}

StatusOr<CodedBase> EncodeBaseMesh(const BaseMesh& base, BaseCoding coding) {
  if (coding == BaseCoding::kCompact) return EncodeCompact(base);
  LACERTA_ASSIGN_OR_RETURN(const IntegerMesh integers, ToIntegerMesh(base));
  LACERTA_ASSIGN_OR_RETURN(StockAttempt attempt, SmallestEdgebreakerStream(integers.mesh, integers.bits));
  CodedBase result;
  result.stream = attempt.stream;
  LACERTA_RETURN_IF_ERROR(PlaceOnLattice(integers, base.step, &result.stream));
  result.traversal = {attempt.settings, attempt.first_triangle, attempt.first_corner, base.triangles};

  LACERTA_ASSIGN_OR_RETURN(const DecodedBase decoded, DecodeBaseMesh(result.stream, kNoDecodeLimits));
  if (decoded.mesh.positions.size() != base.lattice.size() || decoded.mesh.triangles.size() != base.triangles.size()) {
    return InvalidData("Draco made " + std::to_string(decoded.mesh.positions.size()) + " vertices and " +
                       std::to_string(decoded.mesh.triangles.size()) + " triangles of the base mesh's " +
                       std::to_string(base.lattice.size()) + " and " + std::to_string(base.triangles.size()) +
                       "; keep more vertices in the base");
  }
  StatusOr<BaseMesh> lattice = BaseMeshFromPositions(decoded.mesh, base.step);
  if (!lattice.ok()) {
    return InvalidData(
        "base lattice is too far from the origin for floats of its step; choose the step with ShortStep or a larger "
        "one");
  }
  result.mesh = std::move(lattice).value();
  LACERTA_ASSIGN_OR_RETURN(result.vertex_map, FindVertexMap(integers, attempt, result.mesh.triangles));
  if (!IsRenumbering(base, result.mesh, result.vertex_map)) {
    return InvalidData("Draco changed the base mesh; keep more vertices in it");
  }
  return result;
}

StatusOr<Bytes> RecodeBaseMesh(const CodedBase& first, const BaseMesh& moved) {
  if (moved.lattice.size() != first.mesh.lattice.size() || moved.triangles != first.mesh.triangles) {
    return InvalidArgument("the base to code again has another connectivity");
  }
  if (first.coding == BaseCoding::kCompact) return RecodeCompact(moved);
  BaseMesh as_given{moved.step, std::vector<std::array<int32_t, 3>>(moved.lattice.size()), first.traversal.triangles};
  for (size_t v = 0; v < moved.lattice.size(); ++v) as_given.lattice[first.vertex_map[v]] = moved.lattice[v];
  LACERTA_ASSIGN_OR_RETURN(const IntegerMesh integers, ToIntegerMesh(as_given));
  const StockAttempt attempt{first.traversal.settings, first.traversal.first_triangle, first.traversal.first_corner, {}};
  const auto mesh = ToDracoMesh(StartingAsIn(attempt, integers.mesh));
  LACERTA_ASSIGN_OR_RETURN(Bytes written, EncodeIntegerPositions(*mesh, integers.bits, attempt.settings));
  Bytes stream = RecodeStream(std::move(written));
  LACERTA_RETURN_IF_ERROR(PlaceOnLattice(integers, moved.step, &stream));
  LACERTA_ASSIGN_OR_RETURN(const DecodedBase decoded, DecodeBaseMesh(stream, kNoDecodeLimits));
  LACERTA_ASSIGN_OR_RETURN(const BaseMesh lattice, BaseMeshFromPositions(decoded.mesh, moved.step));
  if (lattice.triangles != moved.triangles || lattice.lattice != moved.lattice) {
    return InternalError("Draco coded the moved base mesh in another order");
  }
  return stream;
}

StatusOr<DecodedBase> DecodeBaseMesh(Span<const uint8_t> stream, const DecodeLimits& limits) {
  LACERTA_ASSIGN_OR_RETURN(const StockMesh stock, DecodeStockStream(stream, limits));
  DecodedBase result;
  LACERTA_ASSIGN_OR_RETURN(result.mesh, FromDracoMesh(*stock.mesh));
  result.bytes_used = stock.bytes_used;
  return result;
}

StatusOr<DecodedBase> DecodeBaseOf(const StreamParts& parts, const DecodeLimits& limits) {
  if (parts.coding == BaseCoding::kCompact) {
    LACERTA_ASSIGN_OR_RETURN(const CompactBase compact, DecodeCompactBase(parts.base, limits));
    return DecodedBase{compact.ToMesh(), parts.base.size(), compact.mesh.step};
  }
  LACERTA_ASSIGN_OR_RETURN(DecodedBase base, DecodeBaseMesh(parts.base, limits));
  if (base.bytes_used == parts.base.size()) return base;
  return InvalidData("it takes " + std::to_string(base.bytes_used) + " bytes, not the " + std::to_string(parts.base.size()) + " announced");
}

}  // namespace lacerta
