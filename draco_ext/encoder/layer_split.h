// Quality layers of a coded surface: what a stream shows before it is complete.
//
// The last layer is the surface as it was coded. Each layer before it is coded at a smaller rate: steps are those that the allocation takes
// there (encoder/step_law.h), but the last ones times a power of two, and coefficients are chosen by the same descent, with the bits that
// it takes to refine them into the next layer counted beside their own (docs/decisions/0014-quality-layers.md).
#ifndef LACERTA_ENCODER_LAYER_SPLIT_H_
#define LACERTA_ENCODER_LAYER_SPLIT_H_

#include <optional>
#include <vector>

#include "encoder/coefficient_descent.h"
#include "encoder/surface_target.h"

namespace lacerta {

struct QualityLayer {
  std::vector<std::optional<int>> shifts;  // L: steps are 2^shift times the last ones; empty: all coefficients are zero so far
  CodedSurface surface;
};

// At most num_layers >= 1 of them, coarsest first; fewer where a surface has too little to be cut. Shifts fall from layer to layer, and
// no level has begun before a coarser one that is not silent.
//   coded   the surface at slope lambda (squared model units per bit)
//   passes  of the descent, per layer
std::vector<QualityLayer> SplitIntoLayers(const SurfaceTarget& target, const std::vector<double>& detail_scales, const CodedSurface& coded,
                                          double lambda, int num_layers, int passes);

}  // namespace lacerta

#endif  // LACERTA_ENCODER_LAYER_SPLIT_H_
