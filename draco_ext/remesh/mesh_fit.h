// Moving the vertices of a simplified mesh to where it is closest to the input, for the bytes that they take.
#ifndef LACERTA_REMESH_MESH_FIT_H_
#define LACERTA_REMESH_MESH_FIT_H_

#include <array>
#include <cstdint>
#include <vector>

#include "lacerta/mesh.h"
#include "remesh/distance_model.h"
#include "remesh/mesh_neighbors.h"

namespace lacerta {

// What a parallelogram coder spends on a vertex, and what that is worth. A vertex that is predicted with the error r on a lattice
// of step s takes about 1.5 log2(1 + c |r|^2 / s^2) bits; its predictors are not known, so that all flaps around count alike.
struct RateModel {
  double step = 0;                // of the lattice, model units
  double distortion_per_bit = 0;  // squared model units of DistanceModel's E for a bit; 0: bits do not matter

  // Of a mesh that is off by that much more, squared model units, once it is on its lattice.
  static RateModel For(double lattice_distortion, size_t num_vertices);
  static double StepFor(double lattice_distortion);  // of that lattice

  // Of all vertices of a mesh with the given flaps: bits of one flap with the squared error r2.
  double BitsOfFlap(double r2) const;
  // Slope of that over r2.
  double BitSlope(double r2) const;
};

// E + distortion_per_bit * bits, minimized by rounds of Gauss-Newton steps. Triangles that would turn over, or be folded onto a
// neighbor, stay as they were, and so do vertices that would go farther than the target allows, and farther than they are.
void FitToSurface(const FitTarget& target, const MeshNeighbors& neighbors, const RateModel& rate, int rounds, TriangleMesh* mesh);

// A mesh whose positions are origin + step * lattice.
struct LatticeMesh {
  Vec3f origin;
  float step = 1;
  std::vector<std::array<int32_t, 3>> lattice;  // #V; >= 0
  std::vector<Triangle> triangles;

  TriangleMesh ToMesh() const;  // positions as Draco's decoder computes them, up to rounding
};

// Every vertex at the lattice point next to it. The lattice begins at the lower corner of the mesh. step: as below.
LatticeMesh NearestOnLattice(const TriangleMesh& mesh, double step);

// Rounds `mesh`, at which the target's `model` was made, to the lattice of step rate.step: each vertex in turn to the point near it that is best
// by the model and the bits, in a few sweeps; what is farther than the target allows costs more. The lattice begins at the lower corner of the mesh.
// step: > 0, and at least 2^-23 of the largest side of the mesh.
LatticeMesh FitToLattice(const FitTarget& target, const TriangleMesh& mesh, const DistanceModel& model, const MeshNeighbors& neighbors, const RateModel& rate);

}  // namespace lacerta

#endif  // LACERTA_REMESH_MESH_FIT_H_
