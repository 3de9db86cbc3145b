#include "decoder/synthesis.h"

#include <cstdint>

#include "common/local_frame.h"

namespace lacerta {

void SynthesizeLevel(const Topology& coarse, const StencilTable& table, const LevelSteps& steps,
                     const QuantizedLevel& quantized, std::vector<Vec3f>* positions) {
  AppendMidpoints(coarse, PredictMidpoints(coarse, table, *positions), steps, quantized, positions);
}

void AppendMidpoints(const Topology& coarse, const std::vector<Vec3f>& midpoints, const LevelSteps& steps,
                     const QuantizedLevel& quantized, std::vector<Vec3f>* positions) {
  std::vector<Vec3f> details(midpoints.size());  // apart from `positions`, on which the frames depend
  for (uint32_t e = 0; e < coarse.num_edges(); ++e) {
    const int32_t q1 = quantized.tangential[size_t{2} * e], q2 = quantized.tangential[size_t{2} * e + 1];
    const int32_t qn = quantized.normal[e];
    if (coarse.is_copy(e) || (q1 == 0 && q2 == 0 && qn == 0)) continue;  // most of a fine level: no frame needed
    const Vec3f detail = {Dequantize(q1, steps.tangential_step, steps.tangential_bias),
                          Dequantize(q2, steps.tangential_step, steps.tangential_bias),
                          Dequantize(qn, steps.normal_step, steps.normal_bias)};
    details[e] = LocalFrameAt(coarse, *positions, midpoints, e).ToWorld(detail);
  }
  positions->reserve(positions->size() + midpoints.size());
  for (uint32_t e = 0; e < coarse.num_edges(); ++e) {
    const uint32_t source = coarse.is_copy(e) ? coarse.master[e] : e;
    positions->push_back(midpoints[source] + details[source]);
  }
}

}  // namespace lacerta
