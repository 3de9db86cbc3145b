#include <array>
#include <cmath>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "common/coefficient_sets.h"
#include "common/compact_base_layout.h"
#include "common/position_coding.h"
#include "common/stream_layout.h"
#include "common/valence_coding.h"
#include "decoder/byte_cursor.h"
#include "decoder/range_decoder.h"
#include "lacerta/decoder.h"

namespace lacerta {
namespace {

// Knows nothing: everything is in the stream.
struct Unguided {
  std::array<uint32_t, 3> Start() { return {}; }
  GrowthStep Ask(const GrowingFront&, uint32_t) { return {}; }
  void Started(const std::array<uint32_t, 3>&) {}
  void Added(uint32_t, uint32_t) {}
  void Joined(uint32_t, uint32_t, uint32_t) {}
  void Closed(uint32_t, uint32_t) {}
};

float FloatFromBits(uint32_t bits) {
  float value = 0;
  std::memcpy(&value, &bits, sizeof(value));
  return value;
}

StatusOr<CompactBaseHeader> ReadHeader(ByteCursor* cursor) {
  CompactBaseHeader header;
  header.num_vertices = cursor->Varint();
  header.num_borders = cursor->Varint();
  const uint16_t short_step = cursor->Word16();
  header.step = StepFromBits(short_step);
  if (short_step == 0) {
    header.step = FloatFromBits(cursor->Word32());
    for (int c = 0; c < 3; ++c) header.offset[c] = FloatFromBits(cursor->Word32());
  }
  header.extent_bits = cursor->Byte();
  for (int32_t& value : header.origin) value = cursor->SignedVarint();
  if (cursor->at_end()) return InvalidData("compact base ends within its header");
  if (cursor->malformed()) return InvalidData("a number in the header of the compact base exceeds 32 bits");
  if (header.num_vertices < 3) return InvalidData("compact base has no triangle");
  if (header.num_borders > header.num_vertices / 3) return InvalidData("compact base has more borders than its vertices make");
  if (!(header.step > 0) || !std::isnormal(header.step)) return InvalidData("step of the compact base is not a positive number");
  for (int c = 0; c < 3; ++c) {
    if (!std::isfinite(header.offset[c])) return InvalidData("offset of the compact base is not finite");
  }
  for (const int32_t value : header.origin) {
    if (value < -kMaxLatticeValue || value > kMaxLatticeValue) return InvalidData("the first vertex of the compact base is off the lattice");
  }
  if (header.extent_bits > kMaxExtentBits) return InvalidData("extent of the compact base is off the lattice");
  return header;
}

}  // namespace

TriangleMesh CompactBase::ToMesh() const {
  TriangleMesh result = mesh.ToMesh();
  for (Vec3f& p : result.positions) p = offset + p;
  return result;
}

StatusOr<CompactBase> DecodeCompactBase(Span<const uint8_t> bytes, const DecodeLimits& limits) {
  ByteCursor cursor(bytes);
  LACERTA_ASSIGN_OR_RETURN(const CompactBaseHeader header, ReadHeader(&cursor));
  if (header.num_vertices > limits.max_vertices) {
    return LimitExceeded("base has " + std::to_string(header.num_vertices) + " vertices, more than the " +
                         std::to_string(limits.max_vertices) + " allowed");
  }
  RangeDecoder coder(cursor.Rest());
  Unguided guide;
  MeshGrower grower({header.num_vertices, header.num_borders, limits.max_triangles}, &guide, &coder);
  LACERTA_ASSIGN_OR_RETURN(GrownMesh grown, grower.Grow());
  StatusOr<Topology> topology = BuildTopology(header.num_vertices, grown.triangles);
  LACERTA_RETURN_IF_ERROR(topology.status().WithContext("compact base"));
  CompactBase result;
  result.offset = header.offset;
  result.mesh.step = header.step;
  LACERTA_ASSIGN_OR_RETURN(result.mesh.lattice,
                           CodePositions(topology.value(), header.origin, header.extent_bits, {}, &coder));
  result.mesh.triangles = std::move(grown.triangles);
  for (const Vec3f& p : result.ToMesh().positions) {
    for (int c = 0; c < 3; ++c) {
      if (!std::isfinite(p[c])) return InvalidData("a position of the compact base does not fit a float");
    }
  }
  return result;
}

}  // namespace lacerta
