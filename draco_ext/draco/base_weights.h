// Weights of joints in the Draco streams of a base: four joints a vertex, on a lattice that has the sum 1.
#ifndef LACERTA_DRACO_BASE_WEIGHTS_H_
#define LACERTA_DRACO_BASE_WEIGHTS_H_

#include <cstdint>
#include <vector>

#include "decoder/joint_weights.h"

namespace lacerta {

// A power of two of about the given error, so that 1 is on the lattice. error > 0.
float WeightStep(double error);

// Lattice points of the four largest of num_joints weights, which add up to 1 / step: what is missing goes to those
// that rounding took most from. Appends all num_joints, the others 0.
void AppendRoundedWeights(const float* row, uint32_t num_joints, float step, std::vector<int32_t>* points);

// #V x 4. Each joint is in the same place wherever that is free, for neighbors that agree compress better; joint 0
// where the weight is 0.
struct PlacedWeights {
  std::vector<int32_t> points;  // multiples of the step
  std::vector<uint16_t> joints;
};

// points: #V x #joints, as AppendRoundedWeights makes them.
PlacedWeights PlaceWeights(const int32_t* points, uint32_t num_vertices, float step, const JointTable& joints);

}  // namespace lacerta

#endif  // LACERTA_DRACO_BASE_WEIGHTS_H_
