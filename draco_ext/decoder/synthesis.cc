#include "decoder/synthesis.h"

#include <cstdint>
#include <utility>

#include "common/curved_prediction.h"
#include "common/local_frame.h"

namespace lacerta {
namespace {

using EdgeOffset = std::pair<uint32_t, Vec3f>;

// Details of the edges that have any; their frames depend on the butterfly's midpoints around. frame_normals: of all edges, or empty where they are
// not at hand.
std::vector<EdgeOffset> Details(const Topology& coarse, const LevelSteps& steps, const QuantizedLevel& quantized, Span<const Vec3f> positions,
                                Span<const Vec3f> midpoints, Span<const Vec3f> frame_normals) {
  std::vector<EdgeOffset> details;
  for (uint32_t e = 0; e < coarse.num_edges(); ++e) {
    if (!HasDetail(quantized, e) || coarse.is_copy(e)) continue;  // most of a fine level: no frame needed
    const LocalFrame frame = frame_normals.empty() ? LocalFrameAt(coarse, positions, midpoints, e) : FrameWithNormal(coarse, positions, e, frame_normals[e]);
    details.emplace_back(e, frame.ToWorld(LocalDetail(steps, quantized, e)));
  }
  return details;
}

}  // namespace

void AddDetails(const Topology& coarse, const LevelSteps& steps, const QuantizedLevel& quantized, std::vector<Vec3f>* positions) {
  if (steps.is_silent() && !steps.is_curved) return;
  Vec3f* const midpoints = positions->data() + coarse.num_vertices;
  const Span<const Vec3f> predicted(midpoints, coarse.num_edges());
  std::vector<Vec3f> frame_normals;
  if (steps.is_curved) frame_normals = FrameNormals(coarse, *positions, predicted);
  std::vector<EdgeOffset> details;
  if (!steps.is_silent()) details = Details(coarse, steps, quantized, *positions, predicted, frame_normals);
  if (steps.is_curved) {
    const std::vector<Vec3f> offsets = CurveOffsets(coarse, *positions, predicted, frame_normals);
    for (uint32_t e = 0; e < coarse.num_edges(); ++e) midpoints[e] += offsets[e];
  }
  for (const auto& [e, detail] : details) midpoints[e] += detail;
  for (uint32_t e = 0; e < coarse.num_edges() && !coarse.master.empty(); ++e) {
    if (coarse.is_copy(e)) midpoints[e] = midpoints[coarse.master[e]];
  }
}

void SynthesizeLevel(const Topology& coarse, const StencilTable& table, const LevelSteps& steps,
                     const QuantizedLevel& quantized, std::vector<Vec3f>* positions) {
  PredictMidpoints(coarse, table, positions);
  AddDetails(coarse, steps, quantized, positions);
}

bool AreFinite(Span<const Vec3f> positions) {
  float sum = 0.0f;  // zero, or NaN: without a branch per coordinate
  for (const Vec3f& p : positions) sum += p.x * 0.0f + p.y * 0.0f + p.z * 0.0f;
  return sum == 0.0f;
}

}  // namespace lacerta
