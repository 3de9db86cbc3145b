// The base of a stream with attributes: one stock Draco mesh stream for each group, as a glTF primitive wants it.
#ifndef LACERTA_DRACO_ATTRIBUTED_BASE_CODEC_H_
#define LACERTA_DRACO_ATTRIBUTED_BASE_CODEC_H_

#include <string>
#include <vector>

#include "decoder/joint_weights.h"
#include "encoder/level_order.h"
#include "lacerta/attributed_base.h"
#include "lacerta/decoder.h"
#include "lacerta/mesh.h"
#include "lacerta/status.h"

namespace lacerta {

struct CodedAttributedBase {
  std::vector<Bytes> streams;  // one per group: edgebreaker, bitstream version 2.2; attribute i has the unique id i +
                               // 1, POSITION 0, JOINTS_0 the last
  AttributedBase base;            // in the decoder's order
  std::vector<FaceSource> faces;  // #F0: triangles that were given
};

// Codes a base without loss. Its steps must have 8 significant bits, and its integers span less than 2^22, so that the
// floats of every Draco decoder lie on the lattices. Fails with kInvalidData where Draco does not carry a group
// unchanged or two triangles of a group have the same corners. joints: what the components of the attribute of weights
// are, if the base is to hold it as glTF does: four steps' multiples at most are not 0 at a vertex, and all add up
// to 1.
StatusOr<CodedAttributedBase> EncodeAttributedBase(const AttributedBase& base, const JointTable& joints = {});

// The soup in the stock Draco mesh stream at the front of `stream`, with those of the attributes, in the order of the
// refinement header, that are in it. Safe on untrusted bytes as DecodeStockStream is. Fails with kInvalidData, too,
// where an attribute is not of floats or has not the components that `precision` tells, and like SpreadWeights, which
// puts weights of `joints` into their components.
StatusOr<VertexSoup> DecodeAttributedGroup(Span<const uint8_t> stream, const std::vector<AttributeLattice>& precision,
                                           const DecodeLimits& limits, const JointTable& joints = {});
// The same where only the names are known: kinds are generic, components whatever the stream has.
StatusOr<VertexSoup> DecodeAttributedGroup(Span<const uint8_t> stream, const std::vector<std::string>& names,
                                           const DecodeLimits& limits, const JointTable& joints = {});

}  // namespace lacerta

#endif  // LACERTA_DRACO_ATTRIBUTED_BASE_CODEC_H_
