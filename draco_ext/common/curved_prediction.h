// Prediction of edge midpoints on curves: the butterfly's point, moved along its normal to the height of the cubic Hermite curve
// that leaves either end of the edge in the tangent plane there, and a little on for what lies around.
//
// On the coarse levels of a normal mesh, whose triangles are large beside the curvature of the surface, normals say more than the
// eight points of the butterfly do. Moving along the normal keeps to the line that the remesher has pierced, so that details stay normal
// (docs/decisions/0021-curved-prediction.md). Tangents as in curved point-normal triangles [Vlachos, Peters, Boyd, Mitchell 2001].
#ifndef LACERTA_COMMON_CURVED_PREDICTION_H_
#define LACERTA_COMMON_CURVED_PREDICTION_H_

#include <vector>

#include "common/local_frame.h"
#include "common/subdivision.h"
#include "lacerta/mesh.h"

namespace lacerta {

// What is to be added to the butterfly's midpoints: #E, along the normals of their frames (common/local_frame.h). Zero at edges with
// an end on a curve of the mesh, and where the surface is degenerate.
//   positions      #V of the coarse level or more
//   midpoints      #E from PredictMidpoints
//   frame_normals  #E from FrameNormals
std::vector<Vec3f> CurveOffsets(const Topology& coarse, Span<const Vec3f> positions, Span<const Vec3f> midpoints, Span<const Vec3f> frame_normals);

// That of a level that is curved; zeros of another.
inline std::vector<Vec3f> LevelOffsets(const Topology& coarse, bool is_curved, Span<const Vec3f> positions, Span<const Vec3f> midpoints) {
  return is_curved ? CurveOffsets(coarse, positions, midpoints, FrameNormals(coarse, positions, midpoints)) : std::vector<Vec3f>(coarse.num_edges());
}

}  // namespace lacerta

#endif  // LACERTA_COMMON_CURVED_PREDICTION_H_
