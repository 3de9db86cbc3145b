#include "common/curved_prediction.h"

#include <algorithm>
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

// Sums of the positions around an edge: of the vertices opposite to it, and of the wings, those opposite to the other edges of its faces.
struct Around {
  Vec3f opposite, wings;
  float num_wings = 0;
};

// Of every edge: #E. No wings are seen across curve edges.
std::vector<Around> VerticesAround(const Topology& t, Span<const Vec3f> positions) {
  std::vector<Around> around(t.num_edges());
  for (uint32_t f = 0; f < t.num_faces(); ++f) {
    for (size_t k = 0; k < 3; ++k) around[t.face_edges[f][k]].opposite += positions[t.triangles[f][k]];
  }
  for (uint32_t f = 0; f < t.num_faces(); ++f) {
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t side = t.face_edges[f][k];
      if (t.on_curve[side] != 0) continue;
      const Vec3f wing = around[side].opposite - positions[t.triangles[f][k]];
      for (const uint32_t e : t.face_edges[f]) {
        if (e == side) continue;
        around[e].wings += wing;
        ++around[e].num_wings;
      }
    }
  }
  return around;
}

}  // namespace

std::vector<Vec3f> CurveOffsets(const Topology& coarse, Span<const Vec3f> positions, Span<const Vec3f> midpoints) {
  return CurveOffsets(coarse, positions, midpoints, FrameNormals(coarse, positions, midpoints));
}

std::vector<Vec3f> CurveOffsets(const Topology& coarse, Span<const Vec3f> positions, Span<const Vec3f> midpoints, Span<const Vec3f> frame_normals) {
  // Of each opposite vertex, and of the mean of the wings: about what least-squares fits to details of scans give them beside the curve.
  constexpr float kOppositeShare = 3.0f / 128, kWingShare = -1.0f / 32;
  const std::vector<Vec3f> normals = VertexNormals(coarse, positions);
  const std::vector<Around> around = VerticesAround(coarse, positions);
  std::vector<Vec3f> offsets(coarse.num_edges());
  for (uint32_t e = 0; e < coarse.num_edges(); ++e) {
    if (!IsSmooth(coarse, e)) continue;
    const auto& [a, b] = coarse.edges[e];
    const Vec3f side = positions[b] - positions[a];
    const Vec3f middle = (positions[a] + positions[b]) * 0.5f;
    // The tangents are the side less its part along the normals: at the middle they raise the curve by an eighth of their difference.
    const Vec3f hermite = (normals[b] * Dot(side, normals[b]) - normals[a] * Dot(side, normals[a])) * 0.125f;
    const float n = around[e].num_wings;
    const Vec3f beside = (around[e].opposite - middle * 2.0f) * kOppositeShare + (around[e].wings - middle * n) * (kWingShare / std::max(1.0f, n));
    const float height = Dot(hermite + beside - (midpoints[e] - middle), frame_normals[e]);
    if (std::isfinite(height)) offsets[e] = frame_normals[e] * height;
  }
  return offsets;
}

}  // namespace lacerta
