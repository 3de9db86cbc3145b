#include "common/curved_prediction.h"

#include <array>
#include <cmath>

#include "common/local_frame.h"

namespace lacerta {
namespace {

// Unit normals of the vertices: #V. A triangle counts with the sine of its angle at the vertex, so that neither its size nor its
// slenderness matters.
std::vector<Vec3f> VertexNormals(const Topology& t, Span<const Vec3f> positions) {
  std::vector<Vec3f> normals(t.num_vertices);
  for (const Triangle& f : t.triangles) {
    std::array<Vec3f, 3> sides;  // unit, opposite to the corners
    for (size_t k = 0; k < 3; ++k) sides[k] = Normalized(positions[f[(k + 2) % 3]] - positions[f[(k + 1) % 3]]);
    for (size_t k = 0; k < 3; ++k) normals[f[k]] += Cross(sides[(k + 1) % 3], sides[(k + 2) % 3]);
  }
  for (Vec3f& n : normals) n = Normalized(n);
  return normals;
}

bool IsSmooth(const Topology& t, uint32_t edge) {
  const auto& [a, b] = t.edges[edge];
  return t.role[a] == CurveRole::kSmooth && t.role[b] == CurveRole::kSmooth;
}

}  // namespace

std::vector<Vec3f> CurveOffsets(const Topology& coarse, Span<const Vec3f> positions, Span<const Vec3f> midpoints) {
  const std::vector<Vec3f> normals = VertexNormals(coarse, positions);
  const std::vector<Vec3f> frame_normals = FrameNormals(coarse, positions, midpoints);
  std::vector<Vec3f> offsets(coarse.num_edges());
  for (uint32_t e = 0; e < coarse.num_edges(); ++e) {
    if (!IsSmooth(coarse, e)) continue;
    const auto& [a, b] = coarse.edges[e];
    const Vec3f& normal = frame_normals[e];
    const Vec3f side = positions[b] - positions[a];
    // The tangents are the side less its part along the normals: at the middle they raise the curve by an eighth of their difference.
    const Vec3f hermite = (normals[b] * Dot(side, normals[b]) - normals[a] * Dot(side, normals[a])) * 0.125f;
    const Vec3f butterfly = midpoints[e] - (positions[a] + positions[b]) * 0.5f;
    const float height = Dot(hermite - butterfly, normal);
    if (std::isfinite(height)) offsets[e] = normal * height;
  }
  return offsets;
}

}  // namespace lacerta
