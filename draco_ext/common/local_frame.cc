#include "common/local_frame.h"

#include <cmath>

namespace lacerta {
namespace {

// Any unit vector orthogonal to the unit vector n: the axis least aligned with it, made orthogonal.
Vec3f AnyOrthogonal(const Vec3f& n) {
  const float x = std::fabs(n.x), y = std::fabs(n.y), z = std::fabs(n.z);
  const Vec3f axis = x <= y && x <= z ? Vec3f{1, 0, 0} : y <= z ? Vec3f{0, 1, 0} : Vec3f{0, 0, 1};
  return Normalized(axis - n * Dot(axis, n));
}

// Area vectors of the three fine triangles of `face` that meet at the midpoint of its edge k, added up: the middle face and
// the corner faces at both ends.
Vec3f AreaAround(const Topology& coarse, Span<const Vec3f> positions, Span<const Vec3f> midpoints,
                 uint32_t face, int k) {
  const Triangle& tri = coarse.triangles[face];
  const auto& fe = coarse.face_edges[face];
  const Vec3f m[3] = {midpoints[fe[0]], midpoints[fe[1]], midpoints[fe[2]]};
  Vec3f sum = Cross(m[1] - m[0], m[2] - m[0]);
  for (const int corner : {(k + 1) % 3, (k + 2) % 3}) {
    const Vec3f& v = positions[tri[corner]];
    sum += Cross(m[(corner + 2) % 3] - v, m[(corner + 1) % 3] - v);
  }
  return sum;
}

}  // namespace

LocalFrame LocalFrameAt(const Topology& coarse, Span<const Vec3f> positions, Span<const Vec3f> midpoints,
                        uint32_t edge) {
  LocalFrame frame;
  for (const uint32_t face : coarse.edge_faces[edge]) {
    if (face != kNone) frame.normal += AreaAround(coarse, positions, midpoints, face, EdgeCorner(coarse, face, edge));
  }
  frame.normal = Normalized(frame.normal);
  if (frame.normal == Vec3f{}) frame.normal = {0, 0, 1};
  const Vec3f along = Normalized(positions[coarse.edges[edge][1]] - positions[coarse.edges[edge][0]]);
  const Vec3f tangent = along - frame.normal * Dot(along, frame.normal);
  frame.tangent1 = SquaredNorm(tangent) > 1e-6f ? Normalized(tangent) : AnyOrthogonal(frame.normal);
  // Once more: the first pass leaves 1e-4 along the normal where the edge was nearly parallel to it.
  frame.tangent1 = Normalized(frame.tangent1 - frame.normal * Dot(frame.tangent1, frame.normal));
  frame.tangent2 = Cross(frame.normal, frame.tangent1);
  return frame;
}

std::vector<LocalFrame> ComputeLocalFrames(const Topology& coarse, const std::vector<Vec3f>& positions,
                                           const std::vector<Vec3f>& midpoints) {
  std::vector<LocalFrame> frames;
  frames.reserve(coarse.num_edges());
  for (uint32_t e = 0; e < coarse.num_edges(); ++e) frames.push_back(LocalFrameAt(coarse, positions, midpoints, e));
  return frames;
}

}  // namespace lacerta
