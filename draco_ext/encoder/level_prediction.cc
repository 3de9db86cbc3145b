#include "encoder/level_prediction.h"

#include "common/curved_prediction.h"
#include "encoder/for_ranges.h"

namespace lacerta {

LevelPrediction PredictLevel(const SurfaceTarget& target, int level, const LevelSteps& steps, const std::vector<Vec3f>& positions) {
  const Topology& coarse = target.topologies[level - 1];
  LevelPrediction result;
  result.midpoints = target.midpoints[level - 1].Predict(positions);
  if (steps.is_silent() && !steps.is_curved) return result;
  const std::vector<Vec3f> normals = FrameNormals(coarse, positions, result.midpoints);
  if (steps.is_curved) result.offsets = CurveOffsets(coarse, positions, result.midpoints, normals);
  if (steps.is_silent()) return result;
  result.frames.resize(coarse.num_edges());
  ForRanges(coarse.num_edges(), [&](size_t begin, size_t end) {
    for (size_t e = begin; e < end; ++e) {
      if (steps.tangential_step > 0) {
        result.frames[e] = FrameWithNormal(coarse, positions, static_cast<uint32_t>(e), normals[e]);
      } else {
        result.frames[e].normal = normals[e];
      }
    }
  });
  return result;
}

void AppendLevel(const Topology& coarse, const LevelPrediction& predicted, const LevelSteps& steps, const QuantizedLevel& quantized,
                 std::vector<Vec3f>* positions) {
  positions->reserve(size_t{coarse.num_vertices} + coarse.num_edges());
  for (uint32_t e = 0; e < coarse.num_edges(); ++e) {
    Vec3f position = predicted.midpoints[e] + predicted.OffsetOf(e);
    if (!steps.is_silent() && HasDetail(quantized, e)) position += predicted.frames[e].ToWorld(LocalDetail(steps, quantized, e));
    positions->push_back(position);
  }
  for (uint32_t e = 0; e < coarse.num_edges() && !coarse.master.empty(); ++e) {
    if (coarse.is_copy(e)) (*positions)[coarse.num_vertices + e] = (*positions)[coarse.num_vertices + coarse.master[e]];
  }
}

}  // namespace lacerta
