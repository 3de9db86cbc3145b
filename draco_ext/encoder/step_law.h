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

// The finest level, 1 .. L, whose details are large beside the step that it would have if it were the last one to be coded.
int LastDetailedLevel(const SurfaceTarget& target, const std::vector<double>& detail_scales, double lambda);

// Steps of all levels, of which last_detailed, 1 .. L, is the finest that carries detail. lambda: squared model units per bit, > 0. They
// grow by a factor of 1.7 where last_detailed grows by one: which one is better for a surface, trying tells.
std::vector<LevelSteps> StepsForSlope(const SurfaceTarget& target, int last_detailed, double lambda);
// The same with LastDetailedLevel. detail_scales: of DetailScales.
std::vector<LevelSteps> StepsForSlope(const SurfaceTarget& target, const std::vector<double>& detail_scales, double lambda);

// Step of the base lattice, not yet rounded, model units.
double BaseStepForSlope(double lambda, double num_base_vertices);

}  // namespace lacerta

#endif  // LACERTA_ENCODER_STEP_LAW_H_
