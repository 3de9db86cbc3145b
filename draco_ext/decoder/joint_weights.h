// Weights of joints as streams carry them, a number for every joint that moves the surface, and as glTF holds them,
// four joints for each vertex.
#ifndef LACERTA_DECODER_JOINT_WEIGHTS_H_
#define LACERTA_DECODER_JOINT_WEIGHTS_H_

#include <array>
#include <cstdint>
#include <vector>

#include "lacerta/attributed_mesh.h"
#include "lacerta/mesh.h"
#include "lacerta/status.h"

namespace lacerta {

inline constexpr char kWeightsName[] = "WEIGHTS_0";
inline constexpr char kJointsName[] = "JOINTS_0";

// Which joint of the skin each component of WEIGHTS_0 belongs to; none twice. Empty: the stream has no such weights.
using JointTable = std::vector<uint16_t>;

struct FourWeights {
  std::array<uint16_t, 4> joints = {};  // 0 where the weight is
  std::array<float, 4> weights = {};    // not negative, with the sum 1
};

// The four largest (of equal ones the first), scaled to the sum 1; all of the first one where none is above 0. row: one
// number for each of `joints`, of which there is one at least.
FourWeights LargestFour(const float* row, const JointTable& joints);

// Makes one attribute of a soup's JOINTS_0 and WEIGHTS_0 (4 components each): WEIGHTS_0 with a component for each of
// `joints`. Soups without both stay as they are. Fails with kInvalidData where one of them is missing, and where a joint
// with a weight is not in the table.
Status SpreadWeights(const JointTable& joints, VertexSoup* soup);

// The way back, by LargestFour. JOINTS_0 becomes the last attribute, of whole numbers.
void GatherWeights(const JointTable& joints, VertexSoup* soup);

}  // namespace lacerta

#endif  // LACERTA_DECODER_JOINT_WEIGHTS_H_
