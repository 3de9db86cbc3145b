// Synthetic surfaces with attributes, named for what they exercise.
#ifndef LACERTA_TESTS_SHAPES_ATTRIBUTED_SHAPES_H_
#define LACERTA_TESTS_SHAPES_ATTRIBUTED_SHAPES_H_

#include "lacerta/attributed_mesh.h"

namespace lacerta::shapes {

// An open cylinder of radius 1 and height 2 pi around the z axis, `around` x `up` squares, unrolled isometrically: TEXCOORD_0 is
// (angle, height) / 2 pi, with one seam at angle 0, and NORMAL without one. (around + 1) (up + 1) vertices.
VertexSoup Cylinder(int around, int up);

// The plane z = height * sin(pi x) * sin(pi y) over the unit square in nx x ny squares, with TEXCOORD_0 = (x, y) and NORMAL.
VertexSoup TexturedGrid(int nx, int ny, float height = 0.0f);

// The unit cube, n x n squares a side: each side fills the texture (TEXCOORD_0) and has one NORMAL, so that all edges are seams.
VertexSoup TexturedBox(int n);

}  // namespace lacerta::shapes

#endif  // LACERTA_TESTS_SHAPES_ATTRIBUTED_SHAPES_H_
