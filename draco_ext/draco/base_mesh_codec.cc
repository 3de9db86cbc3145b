#include "draco/base_mesh_codec.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "common/stream_layout.h"
#include "common/subdivision.h"
#include "lacerta/decoder.h"
#include "draco/mesh_conversion.h"
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

// In an order of its vertices.
StatusOr<Bytes> EncodeInOrder(const PositionStream& order, const BaseMesh& base, const IntegerMesh& integers) {
  QuantizationGrid grid;
  for (int c = 0; c < 3; ++c) grid.origin[c] = base.step * static_cast<float>(integers.origin[static_cast<size_t>(c)]);
  grid.range = RangeForStep(base.step, integers.bits);
  if (!std::isfinite(grid.range)) return InvalidData("step times extent of the base lattice does not fit a float");
  std::vector<LatticePoint> points = base.lattice;
  for (LatticePoint& p : points) {
    for (size_t c = 0; c < 3; ++c) p[c] -= integers.origin[c];
  }
  return order.Encode(points, grid, integers.bits);
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
  LACERTA_ASSIGN_OR_RETURN(const StockAttempt attempt, SmallestEdgebreakerStream(integers.mesh, integers.bits));
  LACERTA_ASSIGN_OR_RETURN(const PositionStream order, PositionStream::Create(base.triangles, base.lattice.size(), attempt));
  CodedBase result;
  LACERTA_ASSIGN_OR_RETURN(result.stream, EncodeInOrder(order, base, integers));
  result.vertex_map = order.DecodedVertices();
  result.order = order.Decoded();
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
  LACERTA_ASSIGN_OR_RETURN(const IntegerMesh integers, ToIntegerMesh(moved));
  LACERTA_ASSIGN_OR_RETURN(Bytes stream, EncodeInOrder(*first.order, moved, integers));
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
