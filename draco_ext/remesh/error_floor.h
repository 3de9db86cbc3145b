// What errors of simplified surfaces tell about the noise of a dense one. Squared errors are the sum of a floor, which is what simplification
// smooths away (noise of scanners, values that were rounded to eight bits), and of a part that goes as one over the square of the number of
// triangles, which is what a coarser surface cannot follow. The first does no harm to whatever is made of it in turn.
#ifndef LACERTA_REMESH_ERROR_FLOOR_H_
#define LACERTA_REMESH_ERROR_FLOOR_H_

#include <algorithm>

namespace lacerta {

struct ErrorAtSize {
  double error = 0;
  double triangles = 0;
};

// Whether what more triangles would take away from the error is at most a share of what the floor leaves of `allowed`.
//   coarser, finer  of the same input; of both together the floor follows. False unless the finer one has more triangles
//   allowed         > 0; infinity: anything will do
inline bool IsNearItsFloor(const ErrorAtSize& coarser, const ErrorAtSize& finer, double allowed, double share) {
  if (finer.error <= share * allowed) return true;
  if (!(finer.triangles > coarser.triangles)) return false;
  const double growth = finer.triangles / coarser.triangles, squared = finer.error * finer.error;
  const double removable = std::clamp((coarser.error * coarser.error - squared) / (growth * growth - 1), 0.0, squared);
  const double left = allowed * allowed - (squared - removable);
  return left > 0 && removable <= share * share * left;
}

}  // namespace lacerta

#endif  // LACERTA_REMESH_ERROR_FLOOR_H_
