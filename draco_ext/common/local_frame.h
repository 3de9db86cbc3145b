// Local frames in which detail coefficients are expressed: [Guskov et al. 2000], [Khodakovsky, Guskov 2002].
#ifndef LACERTA_COMMON_LOCAL_FRAME_H_
#define LACERTA_COMMON_LOCAL_FRAME_H_

#include <array>
#include <vector>

#include "common/subdivision.h"
#include "lacerta/mesh.h"

namespace lacerta {

// An orthonormal frame. A detail vector d has the coordinates (d.t1, d.t2, d.n).
struct LocalFrame {
  Vec3f tangent1, tangent2, normal;

  Vec3f ToLocal(const Vec3f& d) const { return {Dot(d, tangent1), Dot(d, tangent2), Dot(d, normal)}; }
  Vec3f ToWorld(const Vec3f& d) const { return tangent1 * d.x + tangent2 * d.y + normal * d.z; }
};

// Any unit vector orthogonal to the unit vector n: the axis least aligned with it, made orthogonal.
Vec3f AnyOrthogonal(const Vec3f& n);

// The four fine triangles of a face of `coarse`, as area vectors.
struct SplitFace {
  SplitFace(const Topology& coarse, Span<const Vec3f> positions, Span<const Vec3f> midpoints, uint32_t face) {
    for (int k = 0; k < 3; ++k) {
      corners[k] = positions[coarse.triangles[face][k]];
      middle[k] = midpoints[coarse.face_edges[face][k]];
    }
  }
  Vec3f AtCorner(int k) const { return Cross(middle[(k + 2) % 3] - corners[k], middle[(k + 1) % 3] - corners[k]); }
  Vec3f InMiddle() const { return Cross(middle[1] - middle[0], middle[2] - middle[0]); }

  std::array<Vec3f, 3> corners, middle;
};

// The normal of the frame of the midpoint of one edge of `coarse`: of the predicted fine mesh there, the normalized sum of the area vectors of its fine
// triangles.
// positions: #V of the coarse level or more; predicted_midpoints: #E from PredictMidpoints. Where the surface degenerates to a
// line or point the axes x, y, z stand in, here and below, so that a frame is always orthonormal.
Vec3f FrameNormalAt(const Topology& coarse, Span<const Vec3f> positions, Span<const Vec3f> predicted_midpoints, uint32_t edge);

// The same of all edges, bit by bit: #E.
std::vector<Vec3f> FrameNormals(const Topology& coarse, Span<const Vec3f> positions, Span<const Vec3f> predicted_midpoints);

// The frame with that normal.
//   tangent1  direction of the edge (second end minus first), made orthogonal to the normal
//   tangent2  normal x tangent1
LocalFrame FrameWithNormal(const Topology& coarse, Span<const Vec3f> positions, uint32_t edge, const Vec3f& normal);

// Frames of all edges: #E.
std::vector<LocalFrame> ComputeLocalFrames(const Topology& coarse, const std::vector<Vec3f>& positions,
                                           const std::vector<Vec3f>& predicted_midpoints);

}  // namespace lacerta

#endif  // LACERTA_COMMON_LOCAL_FRAME_H_
