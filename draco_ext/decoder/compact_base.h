// Decoding of a base mesh in compact form: connectivity by valences, positions by differences (docs/format.md, "Compact base").
// Twin: encoder/compact_base_encoder.h. Safe on untrusted bytes.
#ifndef LACERTA_DECODER_COMPACT_BASE_H_
#define LACERTA_DECODER_COMPACT_BASE_H_

#include <cstdint>

#include "lacerta/decoder.h"
#include "lacerta/mesh.h"
#include "lacerta/status.h"
#include "lacerta/vec3.h"

namespace lacerta {

struct CompactBase {
  BaseMesh mesh;
  Vec3f offset;  // model units, added to the positions of `mesh`

  TriangleMesh ToMesh() const;
};

// Decodes the base that fills `bytes`. Its triangles are an oriented manifold, with or without border, and every vertex has one.
// Fails with kInvalidData, or with kLimitExceeded before memory is taken for more than `limits`.
StatusOr<CompactBase> DecodeCompactBase(Span<const uint8_t> bytes, const DecodeLimits& limits);

}  // namespace lacerta

#endif  // LACERTA_DECODER_COMPACT_BASE_H_
