// What points of a lattice cost.
#ifndef LACERTA_REMESH_POINT_PRICES_H_
#define LACERTA_REMESH_POINT_PRICES_H_

#include <cstdint>
#include <vector>

#include "common/lattice_point.h"

namespace lacerta {

// What the vertices of a mesh take in a stream where they are at points of a lattice.
class PointPrices {
 public:
  virtual ~PointPrices() = default;
  // All vertices are at `points` (#V).
  virtual void Begin(const std::vector<LatticePoint>& points) = 0;
  // v is what Bits is asked about next.
  virtual void LookAround(uint32_t v) = 0;
  // Bits of v and of what is predicted from it, where v is at p; or of a part of these, if that comes to `enough`.
  virtual double Bits(const LatticePoint& p, double enough) const = 0;
  virtual void Move(uint32_t v, const LatticePoint& p) = 0;
};

}  // namespace lacerta

#endif  // LACERTA_REMESH_POINT_PRICES_H_
