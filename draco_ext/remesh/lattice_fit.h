// The points of a lattice to which the vertices of a mesh are moved, for a mesh that is close to the input and takes few bytes.
#ifndef LACERTA_REMESH_LATTICE_FIT_H_
#define LACERTA_REMESH_LATTICE_FIT_H_

#include <cstdint>
#include <vector>

#include "common/lattice_point.h"
#include "lacerta/mesh.h"
#include "remesh/distance_model.h"
#include "remesh/mesh_neighbors.h"
#include "remesh/rate_model.h"

namespace lacerta {

// A mesh whose positions are origin + step * lattice.
struct LatticeMesh {
  Vec3f origin;
  float step = 1;
  std::vector<LatticePoint> lattice;  // #V; >= 0
  std::vector<Triangle> triangles;

  TriangleMesh ToMesh() const;  // positions as Draco's decoder computes them, up to rounding
};

// Every vertex at the lattice point next to it. The lattice begins at the lower corner of the mesh. step: as below.
LatticeMesh NearestOnLattice(const TriangleMesh& mesh, double step);

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

// Rounds `mesh`, at which the target's `model` was made, to the lattice of step rate.step: each vertex in turn to the point near it that is best
// by the model and the bits, in a few sweeps; what is farther than the target allows costs more. The lattice begins at the lower corner of the mesh.
// step: > 0, and at least 2^-23 of the largest side of the mesh. prices: without them bits are those of the flaps around a vertex.
LatticeMesh FitToLattice(const FitTarget& target, const TriangleMesh& mesh, const DistanceModel& model, const MeshNeighbors& neighbors, const RateModel& rate,
                         PointPrices* prices = nullptr);

}  // namespace lacerta

#endif  // LACERTA_REMESH_LATTICE_FIT_H_
