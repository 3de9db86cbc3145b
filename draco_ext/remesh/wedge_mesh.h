// A surface with attributes as simplification walks over it: an oriented manifold with curves, and one node for each value at a vertex.
#ifndef LACERTA_REMESH_WEDGE_MESH_H_
#define LACERTA_REMESH_WEDGE_MESH_H_

#include <cstdint>
#include <vector>

#include "lacerta/attributed_mesh.h"
#include "remesh/manifold.h"

namespace lacerta {

// What may move at a vertex. Curves are open borders, borders of groups, edges whose triangles look opposite ways in the input, and
// seams of any attribute.
enum class VertexFreedom : uint8_t {
  kSurface,   // no curve meets here
  kCurve,     // two curve edges
  kJunction,  // where curves end or cross: stays one
  kFixed,     // where the surface was cut to be a manifold: all sides keep their points, as well the two that go on in each other
  kHeld,      // stays with its values and triangles: other surfaces go on there
};

// The values of one attribute, as nodes: corners around a vertex that have the same value are one node.
struct AttributeNodes {
  std::vector<Triangle> nodes;   // #F x 3; MeshAttribute::kNoValue where the group has not got the attribute
  std::vector<uint32_t> values;  // of each node, a row of the attribute
};

struct WedgeMesh {
  TriangleMesh mesh;                    // oriented manifold with border, one fan per vertex
  std::vector<uint32_t> source_vertex;  // #V, of the input surface
  std::vector<uint32_t> source_face;    // #F, of the input
  std::vector<uint8_t> flipped;         // #F, 1: corners 1 and 2 changed places
  std::vector<uint32_t> component;      // #F
  std::vector<ComponentTopology> components;
  std::vector<uint8_t> curve_edges;     // #F, bit k: the edge across corner k is on a curve
  std::vector<VertexFreedom> freedom;   // #V
  std::vector<AttributeNodes> attributes;

  uint32_t num_vertices() const { return static_cast<uint32_t>(mesh.positions.size()); }
};

// input: one that CheckAttributedMesh accepts. Triangles with a repeated vertex are left out, and of those of a group that have the same
// vertices and orientation all but the first. O(n log n).
WedgeMesh MakeWedgeMesh(const AttributedMesh& input);

// A part of the wedge mesh of `input` with groups and attribute values: `surface`, whose triangles are the given ones of the wedge mesh.
// No face may be flipped.
AttributedMesh TakeFaces(const AttributedMesh& input, const WedgeMesh& wedges, TriangleMesh surface, const std::vector<uint32_t>& faces);
// All of it.
AttributedMesh TakeFaces(const AttributedMesh& input, const WedgeMesh& wedges);

}  // namespace lacerta

#endif  // LACERTA_REMESH_WEDGE_MESH_H_
