// FitToSurface for surfaces whose curves have to stay.
#ifndef LACERTA_REMESH_CURVE_FIT_H_
#define LACERTA_REMESH_CURVE_FIT_H_

#include "lacerta/attributed_mesh.h"
#include "remesh/distance_model.h"

namespace lacerta {

// Moves the vertices of *mesh to where it is closest to the target, by rounds of FitToSurface. Distances to the surface do not tell where
// on it a seam runs: vertices on curves (wedge_mesh.h) move along their normals alone, and those that are fixed there not at all. No
// triangle turns over.
void FitBesideCurves(const FitTarget& target, int rounds, AttributedMesh* mesh);

}  // namespace lacerta

#endif  // LACERTA_REMESH_CURVE_FIT_H_
