// Which lattice points the vertices of primitives go to: not those next to them, but those of the least squared distance along the normals + slope * bits. The
// slope is small, in proportion to the squared step; most is gained by neighbors whose errors cancel out on the triangles between them.
#ifndef LACERTA_PACK_POSITION_DESCENT_H_
#define LACERTA_PACK_POSITION_DESCENT_H_

#include <vector>

#include "document/lattice.h"
#include "lacerta/mesh.h"
#include "pack/value_predictions.h"
#include "pack/value_wedges.h"

namespace lacerta {

class PositionDescent {
 public:
  explicit PositionDescent(const std::vector<TriangleMesh>& surfaces);

  // Of each surface its positions, on lattice points no more than a step off in every coordinate. Vertices at one place, of whichever surfaces, stay together, as do those that round to one; no triangle
  // turns over that does not where vertices go to the points next to them.
  std::vector<std::vector<Vec3f>> On(const Lattice& lattice) const;

 private:
  struct Vertices;
  void Move(size_t w, const LatticeNumbers& lattice, double slope, const ResidualCosts& costs, Vertices* vertices) const;
  Vec3d AreaWith(const std::array<uint32_t, 3>& triangle, size_t w, const Vec3d& move, const Vertices& vertices) const;

  std::vector<size_t> sizes_;  // of the surfaces
  ValueWedges wedges_;         // all together, with one vertex at a place
  std::vector<Vec3d> normals_;  // of the triangles
  double area_ = 0.0;
  FlapPrediction prediction_;
};

}  // namespace lacerta

#endif  // LACERTA_PACK_POSITION_DESCENT_H_
