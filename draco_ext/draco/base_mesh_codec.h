// The base mesh of a progressive stream as a stock Draco stream or in compact form (docs/format.md, "Base section").
#ifndef LACERTA_DRACO_BASE_MESH_CODEC_H_
#define LACERTA_DRACO_BASE_MESH_CODEC_H_

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "draco/base_coding.h"
#include "draco/custom_form.h"
#include "draco/position_stream.h"
#include "draco/stock_stream.h"
#include "lacerta/decoder.h"
#include "lacerta/mesh.h"
#include "lacerta/status.h"

namespace lacerta {

// A coded base and what every decoder gets from it. Draco renumbers vertices and triangles and rotates triangles, so
// all that follows must be computed on `mesh`.
struct CodedBase {
  Bytes stream;                      // edgebreaker, bitstream version 2.2; or the compact base
  BaseMesh mesh;                     // in the decoder's order; step as in the input
  std::vector<uint32_t> vertex_map;  // #V0, coded vertex -> input vertex
  std::optional<PositionStream> order;  // of stock streams: the one of `mesh`
  BaseCoding coding = BaseCoding::kStock;
};

// Codes a base mesh without loss in the fewest bytes found among Draco's settings and starting triangles, or for kCompact among
// starting triangles; deterministic. Of stock streams: the decoder's floats round to the lattice exactly; they equal BaseMesh::ToMesh() bit for bit where
// step * lattice is exact in float, as where both have 24 significant bits together (RoundToLattice). BaseMeshFromPositions(decoded
// mesh, step) gives `mesh` again. Fails with kInvalidData on an empty base, a step that is not a positive normal float,
// lattice values of 2^24 or more or spanning more than 24 bits, a base that is not an oriented manifold
// (BuildTopology), and where Draco does not carry it unchanged.
StatusOr<CodedBase> EncodeBaseMesh(const BaseMesh& base, BaseCoding coding = BaseCoding::kStock);

// Codes `moved`, which is first.mesh with other lattice points or another step, so that a decoder gets its vertices and
// triangles in this very order. Fails as EncodeBaseMesh does.
StatusOr<Bytes> RecodeBaseMesh(const CodedBase& first, const BaseMesh& moved);

// The largest float with an 8 bit significand that is not greater than `step`, a positive normal float.
float ShortStep(float step);

struct DecodedBase {
  TriangleMesh mesh;      // floats as stock Draco gives them, or as of the compact base
  size_t bytes_used = 0;  // length of the base at the front of the stream; what follows is refinement
  float step = 0;         // of the lattice of a compact base; 0: the refinement tells it
};

// Decodes the stock Draco mesh stream at the front of `stream`, whatever its method and attributes, and checks all
// indices and positions. Safe on untrusted bytes as far as libdraco is: its counts are checked against `limits` first.
StatusOr<DecodedBase> DecodeBaseMesh(Span<const uint8_t> stream, const DecodeLimits& limits);

// Decodes the base of the custom form, of either coding. Fails where it does not decode or does not fill its part.
StatusOr<DecodedBase> DecodeBaseOf(const StreamParts& parts, const DecodeLimits& limits);

}  // namespace lacerta

#endif  // LACERTA_DRACO_BASE_MESH_CODEC_H_
