#include "decoder/synthesis.h"

#include <cstdint>
#include <vector>

#include "common/curved_prediction.h"
#include "common/local_frame.h"

namespace lacerta {
namespace {

// Edges that have a detail.
std::vector<uint32_t> DetailedEdges(const Topology& coarse, const QuantizedLevel& quantized) {
  std::vector<uint32_t> edges;
  for (uint32_t e = 0; e < coarse.num_edges(); ++e) {
    if (HasDetail(quantized, e) && !coarse.is_copy(e)) edges.push_back(e);
  }
  return edges;
}

// Whether the normals of all edges, face by face, are made sooner than those of so many of them. Most fine levels have few.
bool AreMany(size_t num_detailed, uint32_t num_edges) { return num_detailed > num_edges / 5; }

// Details of those edges in model coordinates; their frames depend on the butterfly's midpoints around. frame_normals: of all edges, or empty where
// they are not at hand.
std::vector<Vec3f> Details(const Topology& coarse, const LevelSteps& steps, const QuantizedLevel& quantized, const std::vector<uint32_t>& edges,
                           Span<const Vec3f> positions, Span<const Vec3f> midpoints, Span<const Vec3f> frame_normals) {
  std::vector<Vec3f> details(edges.size());
  for (size_t i = 0; i < edges.size(); ++i) {
    const uint32_t e = edges[i];
    const Vec3f normal = frame_normals.empty() ? FrameNormalAt(coarse, positions, midpoints, e) : frame_normals[e];
    details[i] = FrameWithNormal(coarse, positions, e, normal).ToWorld(LocalDetail(steps, quantized, e));
  }
  return details;
}

}  // namespace

void AddDetails(const Topology& coarse, const LevelSteps& steps, const QuantizedLevel& quantized, std::vector<Vec3f>* positions) {
  if (steps.is_silent() && !steps.is_curved) return;
  Vec3f* const midpoints = positions->data() + coarse.num_vertices;
  const Span<const Vec3f> predicted(midpoints, coarse.num_edges());
  std::vector<uint32_t> detailed;
  if (!steps.is_silent()) detailed = DetailedEdges(coarse, quantized);
  std::vector<Vec3f> frame_normals;
  if (steps.is_curved || AreMany(detailed.size(), coarse.num_edges())) frame_normals = FrameNormals(coarse, *positions, predicted);
  const std::vector<Vec3f> details = Details(coarse, steps, quantized, detailed, *positions, predicted, frame_normals);
  if (steps.is_curved) {
    const std::vector<Vec3f> offsets = CurveOffsets(coarse, *positions, predicted, frame_normals);
    for (uint32_t e = 0; e < coarse.num_edges(); ++e) midpoints[e] += offsets[e];
  }
  for (size_t i = 0; i < detailed.size(); ++i) midpoints[detailed[i]] += details[i];
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
