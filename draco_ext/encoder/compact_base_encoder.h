// Coding of a base mesh in compact form (docs/format.md, "Compact base"). Twin: decoder/compact_base.cc.
#ifndef LACERTA_ENCODER_COMPACT_BASE_ENCODER_H_
#define LACERTA_ENCODER_COMPACT_BASE_ENCODER_H_

#include <cstdint>
#include <vector>

#include "lacerta/decoder.h"
#include "lacerta/mesh.h"
#include "lacerta/status.h"
#include "lacerta/vec3.h"

namespace lacerta {

struct CompactBaseBytes {
  Bytes bytes;
  BaseMesh mesh;                     // in the decoder's order
  std::vector<uint32_t> vertex_map;  // #V0, coded vertex -> input vertex
  size_t connectivity_bytes = 0;     // of `bytes`, rounded up; with the header
};

// Codes a base without loss; the first component starts at the first triangle, every other one at the first of its own. What a
// decoder gets codes to the same bytes again, whatever its lattice points: order follows from the connectivity alone.
// offset: model units, see CompactBase. Fails with kInvalidData on a base that is empty or no oriented manifold (BuildTopology), has
// a vertex without triangle, lattice values of 2^24 or more, or a step that is not a positive normal float.
StatusOr<CompactBaseBytes> EncodeCompactBase(const BaseMesh& base, const Vec3f& offset = {0, 0, 0});

// The same with the fewest bytes among several starting triangles; deterministic.
StatusOr<CompactBaseBytes> EncodeCompactBaseSmallest(const BaseMesh& base, const Vec3f& offset = {0, 0, 0});

}  // namespace lacerta

#endif  // LACERTA_ENCODER_COMPACT_BASE_ENCODER_H_
