#include "encoder/compact_base_encoder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <string>
#include <utility>

#include "common/coefficient_sets.h"
#include "common/compact_base_layout.h"
#include "common/position_coding.h"
#include "common/stream_layout.h"
#include "common/valence_coding.h"
#include "encoder/byte_writer.h"
#include "encoder/closed_mesh.h"
#include "encoder/growth_guide.h"
#include "encoder/range_encoder.h"

namespace lacerta {
namespace {

uint32_t BitsOf(float value) {
  uint32_t bits = 0;
  std::memcpy(&bits, &value, sizeof(bits));
  return bits;
}

Bytes WriteHeader(const CompactBaseHeader& header) {
  Bytes bytes;
  PutVarint(header.num_vertices, &bytes);
  PutVarint(header.num_borders, &bytes);
  const bool is_short = RoundStep(header.step) == header.step && header.offset == Vec3f{0, 0, 0};
  PutWord16(is_short ? StepToBits(header.step) : 0, &bytes);
  if (!is_short) {
    PutWord32(BitsOf(header.step), &bytes);
    for (int c = 0; c < 3; ++c) PutWord32(BitsOf(header.offset[c]), &bytes);
  }
  bytes.push_back(static_cast<uint8_t>(header.extent_bits));
  for (const int32_t value : header.origin) PutSignedVarint(value, &bytes);
  return bytes;
}

// Fails where the base cannot be coded. Returns its topology.
StatusOr<Topology> CheckBase(const BaseMesh& base) {
  if (!(base.step > 0) || !std::isnormal(base.step)) return InvalidData("step of the base lattice must be positive and normal");
  if (base.triangles.empty()) return InvalidData("base mesh is empty");
  auto topology = BuildTopology(static_cast<uint32_t>(base.lattice.size()), base.triangles);
  LACERTA_RETURN_IF_ERROR(topology.status().WithContext("base mesh"));
  for (size_t v = 0; v < base.lattice.size(); ++v) {
    if (topology.value().valence[v] == 0) return InvalidData("base vertex " + std::to_string(v) + " has no triangle");
    for (const int32_t value : base.lattice[v]) {
      if (value < -kMaxLatticeValue || value > kMaxLatticeValue) {
        return InvalidData("lattice value " + std::to_string(value) + " of base vertex " + std::to_string(v) + " is 2^24 or more; choose a larger step");
      }
    }
  }
  return topology;
}

int ExtentBits(const std::vector<LatticePoint>& lattice) {
  LatticePoint low = lattice[0], high = lattice[0];
  for (const LatticePoint& p : lattice) {
    for (size_t c = 0; c < 3; ++c) {
      low[c] = std::min(low[c], p[c]);
      high[c] = std::max(high[c], p[c]);
    }
  }
  const int32_t extent = std::max({high[0] - low[0], high[1] - low[1], high[2] - low[2]});
  int bits = 0;
  while (extent >> bits != 0) ++bits;
  return bits;
}

// Where a base is begun: corner `corner` of triangle `triangle`.
struct StartingPlace {
  uint32_t triangle = 0, corner = 0;
};

StatusOr<CompactBaseBytes> EncodeFrom(const BaseMesh& base, const ClosedMesh& closed, const StartingPlace& start, const Vec3f& offset) {
  RangeEncoder coder;
  GrowthGuide guide(closed, start.triangle, start.corner);
  MeshGrower grower({closed.num_vertices, closed.num_dummies, closed.num_real_triangles}, &guide, &coder);
  LACERTA_ASSIGN_OR_RETURN(GrownMesh grown, grower.Grow());
  CompactBaseBytes result;
  result.vertex_map = guide.vertex_map();
  result.mesh.step = base.step;
  result.mesh.triangles = std::move(grown.triangles);
  for (const uint32_t v : result.vertex_map) result.mesh.lattice.push_back(base.lattice[v]);
  LACERTA_ASSIGN_OR_RETURN(const Topology topology, BuildTopology(closed.num_vertices, result.mesh.triangles));
  const CompactBaseHeader header = {closed.num_vertices, closed.num_dummies, base.step, offset, ExtentBits(base.lattice), result.mesh.lattice[0]};
  result.bytes = WriteHeader(header);
  result.connectivity_bytes = result.bytes.size() + RangeEncoder(coder).Finish().size();
  LACERTA_RETURN_IF_ERROR(CodePositions(topology, header.origin, header.extent_bits, result.mesh.lattice, &coder).status());
  const Bytes payload = coder.Finish();
  result.bytes.insert(result.bytes.end(), payload.begin(), payload.end());
  return result;
}

}  // namespace

StatusOr<CompactBaseBytes> EncodeCompactBase(const BaseMesh& base, const Vec3f& offset) {
  LACERTA_ASSIGN_OR_RETURN(const Topology topology, CheckBase(base));
  return EncodeFrom(base, CloseBorders(topology), {}, offset);
}

StatusOr<CompactBaseBytes> EncodeCompactBaseSmallest(const BaseMesh& base, const Vec3f& offset) {
  LACERTA_ASSIGN_OR_RETURN(const Topology topology, CheckBase(base));
  const ClosedMesh closed = CloseBorders(topology);
  constexpr uint32_t kMostTriangles = 30'000, kMostStarts = 12;  // coded altogether; enough to be within 1 % of the best
  const uint32_t num_starts = std::clamp(kMostTriangles / closed.num_real_triangles, 1u, kMostStarts);
  StatusOr<CompactBaseBytes> best = EncodeFrom(base, closed, {}, offset);
  for (uint32_t i = 1; i < num_starts && best.ok(); ++i) {
    const auto triangle = static_cast<uint32_t>(uint64_t{closed.num_real_triangles} * i / num_starts);
    StatusOr<CompactBaseBytes> other = EncodeFrom(base, closed, {triangle, 0}, offset);
    if (other.ok() && other.value().bytes.size() < best.value().bytes.size()) best = std::move(other);
  }
  return best;
}

}  // namespace lacerta
