// Positions closer to the input than interpolation: triangles between vertices that lie on a curved surface all lie to one side
// of it, so a surface that passes through the middle of its own error is several times closer.
#ifndef LACERTA_REMESH_SURFACE_FIT_H_
#define LACERTA_REMESH_SURFACE_FIT_H_

#include "lacerta/remesh.h"
#include "remesh/input_surface.h"

namespace lacerta {

struct SurfaceFitOptions {
  double samples_per_vertex = 3.0;        // points of the input that are looked at, per vertex of the remesh...
  double samples_per_input_vertex = 6.0;  // ...but no more than so many per vertex of the input: it has no more to tell
  double stiffness = 0.4;           // weight of staying in place, in samples
  int iterations = 12;              // of the conjugate gradients
};

// Moves the vertices of the finest level along the normals of the input so that the mean squared distance from points spread
// evenly over the input to the plane of the triangle nearest to each of them becomes least: linear least squares in one number
// per vertex, solved by conjugate gradients. Base vertices at which a cut is to stay closed do not move; others move less far
// where a triangle would be turned over.
void FitToInput(const InputSurface& surface, const SurfaceFitOptions& options, NormalMesh* remesh);

}  // namespace lacerta

#endif  // LACERTA_REMESH_SURFACE_FIT_H_
