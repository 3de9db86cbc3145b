// The points of a lattice to which the vertices of a mesh are moved, for a mesh that is close to the input and takes few bytes.
#ifndef LACERTA_REMESH_LATTICE_FIT_H_
#define LACERTA_REMESH_LATTICE_FIT_H_

#include <cstdint>
#include <vector>

#include "common/lattice_point.h"
#include "lacerta/mesh.h"
#include "remesh/distance_model.h"
#include "remesh/mesh_neighbors.h"
#include "remesh/point_prices.h"
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

// Rounds `mesh`, at which the target's `model` was made, to the lattice of step rate.step: each vertex in turn to the point near it that is best
// by the model and the bits, in a few sweeps; what is farther than the target allows costs more. The lattice begins at the lower corner of the mesh.
// step: > 0, and at least 2^-23 of the largest side of the mesh. prices: without them bits are those of the flaps around a vertex.
LatticeMesh FitToLattice(const FitTarget& target, const TriangleMesh& mesh, const DistanceModel& model, const MeshNeighbors& neighbors, const RateModel& rate,
                         PointPrices* prices = nullptr);

}  // namespace lacerta

#endif  // LACERTA_REMESH_LATTICE_FIT_H_
