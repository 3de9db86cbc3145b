// Synthetic surfaces with attributes, named for what they exercise.
#ifndef LACERTA_TESTS_SHAPES_ATTRIBUTED_SHAPES_H_
#define LACERTA_TESTS_SHAPES_ATTRIBUTED_SHAPES_H_

#include <vector>

#include "lacerta/attributed_mesh.h"

namespace lacerta::shapes {

// An open cylinder of radius 1 and height 2 pi around the z axis, `around` x `up` squares, unrolled isometrically: TEXCOORD_0 is
// (angle, height) / 2 pi, with one seam at angle 0, and NORMAL without one. (around + 1) (up + 1) vertices.
VertexSoup Cylinder(int around, int up);

// Cylinder with a skin of three joints at the heights 0, 2 pi / 3 and 4 pi / 3, each the parent of the next. A vertex is moved by the
// joint below; over a fifth of the height around the upper two the weight goes over smoothly from one joint to the next.
struct SkinnedSoup {
  VertexSoup soup;
  std::vector<uint8_t> joints;  // #V x 4
  std::vector<float> weights;   // #V x 4
};
SkinnedSoup SkinnedCylinder(int around, int up);

// The plane z = height * sin(pi x) * sin(pi y) over the unit square in nx x ny squares, with TEXCOORD_0 = (x, y) and NORMAL.
VertexSoup TexturedGrid(int nx, int ny, float height = 0.0f);

// The two sides of a sheet over the unit square, one group: the front at that height, which may be below 0, and the back, which looks down, at zero.
AttributedMesh ThickSheet(float height);

// The unit cube, n x n squares a side: each side fills the texture (TEXCOORD_0) and has one NORMAL, so that all edges are seams.
VertexSoup TexturedBox(int n);

// TexturedBox in two soups: one side, which has a COLOR_0 as well, and the others.
std::vector<VertexSoup> BoxOfTwoGroups(int n);

// A torus of radii 1 and 0.4 around the z axis, `around` x `tube` squares, with TEXCOORD_0 = the two angles / 2 pi and NORMAL: the texture
// is cut once around and once along the tube, the normals are not. Two soups with a border at the angles 0 and pi around the axis.
std::vector<VertexSoup> HalvedTorus(int around, int tube);

// TexturedGrid with n x n squares, n a multiple of 4, whose texture is slit along y = 1/2 for 1/4 < x < 3/4: above the slit it is moved up,
// most in the middle, not at all at both ends.
VertexSoup SlitGrid(int n, float height = 0.0f);

// Every triangle with vertices of its own, in the order of the corners, the values of which are up to `noise` off, by component.
VertexSoup Unwelded(const VertexSoup& soup, float noise);

}  // namespace lacerta::shapes

#endif  // LACERTA_TESTS_SHAPES_ATTRIBUTED_SHAPES_H_
