// Where the vertices of a level are without its coefficients, made once for all choices of those.
#ifndef LACERTA_ENCODER_LEVEL_PREDICTION_H_
#define LACERTA_ENCODER_LEVEL_PREDICTION_H_

#include <vector>

#include "common/coefficient_sets.h"
#include "common/local_frame.h"
#include "encoder/surface_target.h"
#include "lacerta/mesh.h"

namespace lacerta {

struct LevelPrediction {
  std::vector<Vec3f> midpoints;     // #E: the butterfly's
  std::vector<LocalFrame> frames;   // #E; empty on silent levels, tangents zero where only normal coefficients are coded
  std::vector<Vec3f> offsets;       // #E: LevelOffsets (common/curved_prediction.h), or empty on levels that are not curved

  Vec3f OffsetOf(uint32_t edge) const { return offsets.empty() ? Vec3f() : offsets[edge]; }
};

// Of level `level` (1 .. L). positions: #V of the coarser level.
LevelPrediction PredictLevel(const SurfaceTarget& target, int level, const LevelSteps& steps, const std::vector<Vec3f>& positions);

// Appends the vertices of that level to the positions of the coarser one, as decoders do, to the last bit.
void AppendLevel(const Topology& coarse, const LevelPrediction& predicted, const LevelSteps& steps, const QuantizedLevel& quantized,
                 std::vector<Vec3f>* positions);

}  // namespace lacerta

#endif  // LACERTA_ENCODER_LEVEL_PREDICTION_H_
