// A skinned family as streams carry it: a number for every joint at each vertex, held to what they do in poses.
#ifndef LACERTA_PACK_WEIGHTED_FAMILY_H_
#define LACERTA_PACK_WEIGHTED_FAMILY_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "decoder/joint_weights.h"
#include "lacerta/attributed_levels.h"
#include "lacerta/attributed_mesh.h"
#include "lacerta/status.h"
#include "pack/family_meter.h"

namespace lacerta {

struct WeightedFamily {
  JointTable joints;        // that move a vertex, ascending
  AttributedMesh original;  // FamilyMeter::original with WEIGHTS_0 in place of poses, a component for each of `joints`
  ErrorTargets targets;     // parallel to its attributes
  size_t weights = 0;       // which of them
  double reach = 0;         // mesh units that a surface in its worst pose is off where weights are off by 1, about
};

// meter: OK and with a skin, to which the result refers no more. Fails with kUnsupported where more joints move the
// family than a stream has room for.
StatusOr<WeightedFamily> ToWeightedFamily(const FamilyMeter& meter);

// Sets the error of weights to the farthest that a surface with attributes like those of `family` is from the original
// in a pose, in units of reach. Weights are those that a reader makes of the components (LargestFour).
Status MeasureInPoses(const FamilyMeter& meter, const WeightedFamily& family, const AttributedMesh& mesh,
                      uint64_t num_samples, SurfaceErrors* errors);

// How far the worst pose moves a vertex for each of its weights, in units of reach and at most 1: of the values of the
// attribute `weights` at all levels, which are #values x #joints; empty for other attributes.
std::vector<float> FactorsInPoses(const FamilyMeter& meter, const WeightedFamily& family,
                                  const AttributedSemiRegularMesh& mesh, size_t attribute);

}  // namespace lacerta

#endif  // LACERTA_PACK_WEIGHTED_FAMILY_H_
