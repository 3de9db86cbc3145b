// Moving the vertices of a simplified mesh to where it is closest to the input, for the bytes that they take.
#ifndef LACERTA_REMESH_MESH_FIT_H_
#define LACERTA_REMESH_MESH_FIT_H_

#include "lacerta/mesh.h"
#include "remesh/distance_model.h"
#include "remesh/mesh_neighbors.h"
#include "remesh/rate_model.h"

namespace lacerta {

// E + distortion_per_bit * bits, minimized by rounds of Gauss-Newton steps. Triangles that would turn over, or be folded onto a
// neighbor, stay as they were, and so do vertices that would go farther than the target allows, and farther than they are.
void FitToSurface(const FitTarget& target, const MeshNeighbors& neighbors, const RateModel& rate, int rounds, TriangleMesh* mesh);

// The same where it is known what predicts what.
void FitToSurface(const FitTarget& target, const MeshNeighbors& neighbors, const RateModel& rate, const LinearPredictions& predictions, int rounds,
                  TriangleMesh* mesh);

}  // namespace lacerta

#endif  // LACERTA_REMESH_MESH_FIT_H_
