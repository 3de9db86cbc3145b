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

}  // namespace

std::vector<LocalFrame> ComputeLocalFrames(const Topology& coarse, const std::vector<Vec3f>& positions,
                                           const std::vector<Vec3f>& midpoints) {
  std::vector<LocalFrame> frames(coarse.num_edges());
  // Area vectors of the fine triangles, gathered at the midpoints: each face gives its middle face to all three midpoints
  // and each corner face to two.
  for (uint32_t f = 0; f < coarse.num_faces(); ++f) {
    const Triangle& tri = coarse.triangles[f];
    const auto& fe = coarse.face_edges[f];
    const Vec3f m[3] = {midpoints[fe[0]], midpoints[fe[1]], midpoints[fe[2]]};
    Vec3f corner_area[3];
    for (int k = 0; k < 3; ++k) {
      const Vec3f& v = positions[tri[k]];
      corner_area[k] = Cross(m[(k + 2) % 3] - v, m[(k + 1) % 3] - v);
    }
    const Vec3f middle_area = Cross(m[1] - m[0], m[2] - m[0]);
    for (int k = 0; k < 3; ++k) {
      frames[fe[k]].normal += middle_area + corner_area[(k + 1) % 3] + corner_area[(k + 2) % 3];
    }
  }
  for (uint32_t e = 0; e < coarse.num_edges(); ++e) {
    LocalFrame& frame = frames[e];
    frame.normal = Normalized(frame.normal);
    if (frame.normal == Vec3f{}) frame.normal = {0, 0, 1};
    const Vec3f along = Normalized(positions[coarse.edges[e][1]] - positions[coarse.edges[e][0]]);
    const Vec3f tangent = along - frame.normal * Dot(along, frame.normal);
    frame.tangent1 = SquaredNorm(tangent) > 1e-6f ? Normalized(tangent) : AnyOrthogonal(frame.normal);
    // Once more: the first pass leaves 1e-4 along the normal where the edge was nearly parallel to it.
    frame.tangent1 = Normalized(frame.tangent1 - frame.normal * Dot(frame.tangent1, frame.normal));
    frame.tangent2 = Cross(frame.normal, frame.tangent1);
  }
  return frames;
}

}  // namespace lacerta
