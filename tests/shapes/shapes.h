// Synthetic meshes, named for what they exercise. All are the same on every run and machine, up to the last bit of sin
// and cos.
#ifndef LACERTA_TESTS_SHAPES_SHAPES_H_
#define LACERTA_TESTS_SHAPES_SHAPES_H_

#include <cstdint>
#include <string>
#include <vector>

#include "lacerta/mesh.h"

namespace lacerta::shapes {

// The mesh with every face split into four at the middles of its edges.
TriangleMesh Split(const TriangleMesh& mesh);

// Smooth and closed.

// Sphere around the origin, vertices on it: an icosahedron split `levels` times 1 to 4. 20 * 4^levels faces. Genus 0.
TriangleMesh Icosphere(int levels, float radius = 1.0f);
// Torus around the z axis: 2 * nu * nv faces, nu >= 3 along the ring and nv >= 3 around the tube. Genus 1.
TriangleMesh Torus(int nu, int nv, float ring_radius = 1.0f, float tube_radius = 0.4f);
// Icosphere with smooth bumps up to `amplitude` high and, on top, vertex noise up to `noise`, both relative to the
// radius 1: what a scan looks like. Genus 0.
TriangleMesh BumpySphere(int levels, float amplitude = 0.1f, float noise = 0.0f);
// Icosphere drawn out into `num_spikes` thin spikes of height `height`: hard to simplify and to parametrize. Genus 0.
TriangleMesh SpikySphere(int levels, int num_spikes = 12, float height = 1.0f);

// Closed with creases: surfaces of unit cubes, each square split into n * n, each of them into two triangles.

// The unit cube [0, 1]^3. 12 * n^2 faces. Genus 0.
TriangleMesh CreasedBox(int n);
// A plate 5 x 3 x 1 with two square holes. Genus 2.
TriangleMesh TwoHoledPlate(int n);
// The unit cube squeezed to `thickness` along z: two sheets close together.
TriangleMesh ThinPlate(int n, float thickness = 0.01f);

// With a border.

// Graph of height * sin(pi x) * sin(pi y) over the unit square, nx * ny cells. 2 * nx * ny faces, one border.
TriangleMesh GridWithBorder(int nx, int ny, float height = 0.0f);
// Icosphere without the faces around its first vertex: one border of five edges.
TriangleMesh PuncturedSphere(int levels);

// Not manifold or otherwise in need of repair.

// Two tetrahedra that share one vertex and nothing else: two fans at one vertex.
TriangleMesh Pinched();
// Three triangles at one edge.
TriangleMesh NonManifoldEdge();
// Icosphere of which every third face is turned inside out.
TriangleMesh Misoriented(int levels);
// Icosphere with added faces that have a repeated vertex, no area, or the corners of another face, and with a vertex
// that no face uses.
TriangleMesh WithDegenerateFaces(int levels);
// Icosphere of which every face has its own three vertices, as STL files do.
TriangleMesh TriangleSoup(int levels);

// What only the making of manifolds is asked about; not among AllShapes.

// Band of n >= 3 squares, two triangles each, that comes back to its start turned over: no orientation suits all. One border.
TriangleMesh MoebiusBand(int n);
// The graph of GridWithBorder and, on the same vertices, its back: each edge inside has four faces, each on the rim two.
TriangleMesh DoubleSheet(int nx, int ny);
// CreasedBox twice, as solids that touch along an edge of the cube: n edges of four faces each.
TriangleMesh TouchingBoxes(int n);

// A square plate of side 1 and 32 faces, GridWithBorder(4, 4), with small bumpy spheres above it, of 320 faces each: nearly all faces on a
// small part of the area, as letters on a plate have them.
TriangleMesh SpheresOverAPlate(int num_spheres, float radius);

// `count` copies of a piece that fits into the unit sphere, at random places of the cube from -1 to 1, and as large against the space
// between them whatever their number.
TriangleMesh Scattered(const TriangleMesh& piece, uint32_t count);

// The mesh with a stick on its highest vertex, a closed component of square section and 12 faces: what is seen at once and nothing of the area.
TriangleMesh WithStick(TriangleMesh mesh, float width, float length);

// A shape and what is true of it.
struct NamedShape {
  std::string name;
  TriangleMesh mesh;
  bool manifold = true;  // every edge at most two faces, every vertex one fan
  bool oriented = true;  // neighbours run through their shared edge in opposite directions
  int num_borders = 0;   // closed polygons; of manifold shapes
  int genus = 0;         // of manifold shapes
};

// One of each of the above but those that are said not to be, a few hundred to a few thousand faces.
std::vector<NamedShape> AllShapes();

// `num_sheets` sheets of `rows` x `columns` squares, halved into triangles, that leave a wavy curve at equal angles, as films of foam do.
TriangleMesh SheetsAroundACurve(uint32_t num_sheets, uint32_t rows, uint32_t columns);

}  // namespace lacerta::shapes

#endif  // LACERTA_TESTS_SHAPES_SHAPES_H_
