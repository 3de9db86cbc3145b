// Triangles of a remesh that look away from the input.
#ifndef LACERTA_REMESH_REVERSAL_H_
#define LACERTA_REMESH_REVERSAL_H_

#include <array>
#include <cstdint>
#include <vector>

#include "lacerta/remesh.h"
#include "lacerta/vec3.h"
#include "remesh/base_domain.h"
#include "remesh/input_surface.h"

namespace lacerta {

// Twice the area of a triangle, along its normal.
inline Vec3f AreaNormal(const std::array<Vec3f, 3>& corners) { return Cross(corners[1] - corners[0], corners[2] - corners[0]); }

// Whether a triangle is more than 90 degrees off the input's interpolated normal at the point closest to its centroid, and off that
// of every sheet which the line along its normal through the centroid meets no farther away than the triangle is long: at thin parts the
// closest point is often on the far side. False where there is no input.
bool IsReversed(const InputSurface& surface, const std::array<Vec3f, 3>& corners);

// What of the finest level of a remesh is reversed, as shares of its area.
struct ReversedPart {
  struct Face {
    uint32_t number;  // among the base triangles that are not still
    double share;     // of the whole area: what is reversed over this face
  };
  double share = 0;
  std::vector<Face> faces;  // those with reversed triangles, the largest share first
};
ReversedPart FindReversed(const InputSurface& surface, const NormalMesh& remesh);

// A remesh with a larger share reversed is worth another one, over a base that is finer there.
inline constexpr double kMostReversed = 5e-4;
// Remeshes in all, until no more than that is reversed.
inline constexpr int kReversalRounds = 4;

// Adds to `held` (for CollapseHistory::CutWithout) the collapses that made the worst base faces, so many that over all others no more than
// a third of kMostReversed is left. Returns whether another remesh is due; not where little is reversed, where no collapse is left to
// hold, or where more than 4 base faces and more than one in 32 are bad: that base is too coarse as a whole, and a few more vertices
// do not mend it.
bool HoldReversed(const ReversedPart& part, const BaseDomain& domain, std::vector<uint32_t>* held);

}  // namespace lacerta

#endif  // LACERTA_REMESH_REVERSAL_H_
