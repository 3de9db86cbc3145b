#include "encoder/vertex_repair.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/butterfly.h"
#include "common/curved_prediction.h"
#include "common/local_frame.h"
#include "decoder/synthesis.h"
#include "encoder/quantizer.h"

namespace lacerta {
namespace {

void Repair(float value, float step, int32_t* quantized) {
  if (std::fabs(value - static_cast<float>(*quantized) * step) > step) *quantized = RoundToStep(value, step);
}

void SilenceZeros(const std::vector<int32_t>& values, float* step) {
  if (std::all_of(values.begin(), values.end(), [](int32_t q) { return q == 0; })) *step = 0;
}

}  // namespace

void RepairVertices(const SurfaceTarget& target, CodedSurface* coded) {
  BaseMesh& base = coded->base;
  std::vector<Vec3f> positions;
  for (uint32_t v = 0; v < base.lattice.size(); ++v) {
    Vec3f position;
    for (int axis = 0; axis < 3; ++axis) {
      Repair(target.points[v][axis], base.step, &base.lattice[v][axis]);
      position[axis] = static_cast<float>(base.lattice[v][axis]) * base.step;
    }
    positions.push_back(position);
  }
  for (int level = 1; level <= target.num_levels(); ++level) {
    const Topology& coarse = target.topologies[level - 1];
    LevelSteps& steps = coded->steps[level - 1];
    QuantizedLevel& quantized = coded->levels[level - 1];
    const std::vector<Vec3f> predicted = PredictMidpoints(coarse, target.stencils, positions);
    const std::vector<LocalFrame> frames = ComputeLocalFrames(coarse, positions, predicted);
    const std::vector<Vec3f> offsets = LevelOffsets(coarse, steps.is_curved, positions, predicted);
    for (uint32_t e = 0; e < coarse.num_edges(); ++e) {
      const Vec3f local = frames[e].ToLocal(target.points[coarse.num_vertices + e] - predicted[e] - offsets[e]);
      Repair(local.x, steps.tangential_step, &quantized.tangential[size_t{2} * e]);
      Repair(local.y, steps.tangential_step, &quantized.tangential[size_t{2} * e + 1]);
      Repair(local.z, steps.normal_step, &quantized.normal[e]);
    }
    SynthesizeLevel(coarse, target.stencils, steps, quantized, &positions);
    SilenceZeros(quantized.tangential, &steps.tangential_step);
    SilenceZeros(quantized.normal, &steps.normal_step);
  }
}

}  // namespace lacerta
