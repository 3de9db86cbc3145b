#include "common/curved_prediction.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/fast_point.h"

namespace lacerta {
namespace {

// Unit normals of the vertices: #V. A triangle counts with the sine of its angle at the vertex, so that neither its size nor its
// slenderness matters.
std::vector<Vec3f> VertexNormals(const Topology& t, Span<const Vec3f> positions) {
  std::vector<Vec3f> directions(t.num_edges());  // unit
  for (uint32_t e = 0; e < t.num_edges(); ++e) directions[e] = Normalized(positions[t.edges[e][1]] - positions[t.edges[e][0]]);
  std::vector<Vec3f> normals(t.num_vertices);
  for (uint32_t f = 0; f < t.num_faces(); ++f) {
    const Triangle& corners = t.triangles[f];
    std::array<Vec3f, 3> sides;  // opposite to the corners, counterclockwise
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t e = t.face_edges[f][k];
      sides[k] = t.edges[e][0] == corners[(k + 1) % 3] ? directions[e] : -directions[e];
    }
    for (size_t k = 0; k < 3; ++k) normals[corners[k]] += Cross(sides[(k + 1) % 3], sides[(k + 2) % 3]);
  }
  for (Vec3f& n : normals) n = Normalized(n);
  return normals;
}

bool IsSmooth(const Topology& t, uint32_t edge) {
  const auto& [a, b] = t.edges[edge];
  return t.role[a] == CurveRole::kSmooth && t.role[b] == CurveRole::kSmooth;
}

// What lies around gives an edge beside its curve: a share of each opposite vertex, and of the mean of the wings, those opposite to the other edges of
// its faces, about as least-squares fits to details of scans have them. No wings are seen across curve edges.
template <typename Point>
Vec3f Beside(const Topology& t, const std::vector<uint32_t>& opposite_pairs, Span<const Vec3f> positions, uint32_t edge, const Vec3f& middle) {
  constexpr float kOppositeShare = 3.0f / 128, kWingShare = -1.0f / 32;
  const auto at = [&](uint32_t v) { return LoadPoint<Point>(positions.data() + v); };
  Point opposite{}, wings{};
  float num_wings = 0;
  for (const uint32_t face : t.edge_faces[edge]) {
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t side = t.face_edges[face][k], corner = t.triangles[face][k];
      if (side == edge) {
        opposite += at(corner);
      } else if (t.on_curve[side] == 0) {
        wings += at(opposite_pairs[side] ^ corner) + at(corner) - at(corner);  // not the same as the first alone: it is rounded
        ++num_wings;
      }
    }
  }
  return (ToVec3f(opposite) - middle * 2.0f) * kOppositeShare + (ToVec3f(wings) - middle * num_wings) * (kWingShare / std::max(1.0f, num_wings));
}

template <typename Point>
std::vector<Vec3f> Offsets(const Topology& coarse, Span<const Vec3f> positions, Span<const Vec3f> midpoints, Span<const Vec3f> frame_normals) {
  const std::vector<Vec3f> normals = VertexNormals(coarse, positions);
  const std::vector<uint32_t> opposite_pairs = OppositePairs(coarse);
  std::vector<Vec3f> offsets(coarse.num_edges());
  for (uint32_t e = 0; e < coarse.num_edges(); ++e) {
    if (!IsSmooth(coarse, e)) continue;
    const auto& [a, b] = coarse.edges[e];
    const Vec3f side = positions[b] - positions[a];
    const Vec3f middle = (positions[a] + positions[b]) * 0.5f;
    // The tangents are the side less its part along the normals: at the middle they raise the curve by an eighth of their difference.
    const Vec3f hermite = (normals[b] * Dot(side, normals[b]) - normals[a] * Dot(side, normals[a])) * 0.125f;
    const Vec3f beside = Beside<Point>(coarse, opposite_pairs, positions, e, middle);
    const float height = Dot(hermite + beside - (midpoints[e] - middle), frame_normals[e]);
    if (std::isfinite(height)) offsets[e] = frame_normals[e] * height;
  }
  return offsets;
}

}  // namespace

std::vector<Vec3f> CurveOffsets(const Topology& coarse, Span<const Vec3f> positions, Span<const Vec3f> midpoints, Span<const Vec3f> frame_normals) {
  const bool has_more = positions.size() > coarse.num_vertices;  // behind the last point
  return (has_more ? Offsets<FastPoint> : Offsets<Vec3f>)(coarse, positions, midpoints, frame_normals);
}

}  // namespace lacerta
