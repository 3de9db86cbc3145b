#include "decoder/synthesis.h"

#include <cstdint>

#include "common/local_frame.h"

namespace lacerta {

void SynthesizeLevel(const Topology& coarse, const StencilTable& table, const LevelSteps& steps,
                     const QuantizedLevel& quantized, std::vector<Vec3f>* positions) {
  const std::vector<Vec3f> midpoints = PredictMidpoints(coarse, table, *positions);
  const std::vector<LocalFrame> frames = ComputeLocalFrames(coarse, *positions, midpoints);
  positions->reserve(positions->size() + midpoints.size());
  for (uint32_t e = 0; e < coarse.num_edges(); ++e) {
    const Vec3f detail = {
        Dequantize(quantized.tangential[size_t{2} * e], steps.tangential_step, steps.tangential_bias),
        Dequantize(quantized.tangential[size_t{2} * e + 1], steps.tangential_step, steps.tangential_bias),
        Dequantize(quantized.normal[e], steps.normal_step, steps.normal_bias)};
    positions->push_back(midpoints[e] + frames[e].ToWorld(detail));
  }
}

}  // namespace lacerta
