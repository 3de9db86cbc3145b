// Quantization steps of all sets from one slope lambda, for coefficients chosen by descent (encoder/coefficient_descent.h).
//
// A coefficient of level i moves about 1 / N_i of the surface, N_i being the number of vertices there, so the step at which
// its own distortion balances lambda bits is proportional to sqrt(lambda N_i): twice as large per finer level. That holds at
// the finest level that still carries detail. The error of a coarser one is mended by finer ones, in a closed loop, so that
// its step may be larger: going down, steps shrink by less than two (docs/decisions/0003-steps.md).
#ifndef LACERTA_ENCODER_STEP_LAW_H_
#define LACERTA_ENCODER_STEP_LAW_H_

#include <vector>

#include "common/coefficient_sets.h"
#include "encoder/surface_target.h"

namespace lacerta {

// Root mean square of the normal details of each level 1 .. L before quantization, or of the whole details where vertices are
// kept; model units.
std::vector<double> DetailScales(const SurfaceTarget& target);

// Steps of all levels. detail_scales: of DetailScales; lambda: squared model units per bit, > 0.
std::vector<LevelSteps> StepsForSlope(const SurfaceTarget& target, const std::vector<double>& detail_scales, double lambda);

// About the bits of the normal details at these steps, up to a factor: what Gaussian variables of their size would take. It tells normal
// meshes of one surface apart without coding them.
double EstimateDetailBits(const SurfaceTarget& target, const std::vector<LevelSteps>& steps);

// Step of the base lattice, not yet rounded, model units.
double BaseStepForSlope(double lambda);

}  // namespace lacerta

#endif  // LACERTA_ENCODER_STEP_LAW_H_
