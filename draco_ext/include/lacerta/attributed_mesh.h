// A surface with what glTF lays on it: texture coordinates, normals, colors, weights, and one group of faces per material.
#ifndef LACERTA_ATTRIBUTED_MESH_H_
#define LACERTA_ATTRIBUTED_MESH_H_

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "lacerta/mesh.h"
#include "lacerta/status.h"

namespace lacerta {

// What the numbers mean, and so how they are interpolated and compared.
enum class AttributeKind {
  kTextureCoordinates,
  kNormal,   // 3 components, unit length
  kTangent,  // 3 components of unit length, and possibly the sign of the bitangent
  kColor,
  kWeights,  // of one joint each
  kGeneric,  // anything that may be interpolated; morph targets are 3 components in model units
};

inline bool IsDirection(AttributeKind kind) { return kind == AttributeKind::kNormal || kind == AttributeKind::kTangent; }

// Values at the corners of triangles. Where the corners of a vertex do not have the same value the surface has a seam.
struct MeshAttribute {
  static constexpr uint32_t kNoValue = std::numeric_limits<uint32_t>::max();

  std::string name;  // as in glTF
  AttributeKind kind = AttributeKind::kGeneric;
  uint32_t components = 1;        // > 0
  std::vector<float> values;      // #N x components, row after row; finite
  std::vector<Triangle> corners;  // #F, rows of `values`; all three kNoValue on the faces of a group that has not got it

  uint32_t num_values() const { return static_cast<uint32_t>(values.size() / components); }
};

// One surface, however many primitives it comes from: vertices at the same position are one.
struct AttributedMesh {
  TriangleMesh surface;                   // positions welded
  std::vector<uint32_t> groups;           // #F, the primitive or material of each triangle; empty: all 0
  std::vector<MeshAttribute> attributes;  // no two of the same name and number of components

  uint32_t GroupOf(size_t face) const { return groups.empty() ? 0 : groups[face]; }
};

// The same in the form of a glTF primitive: every vertex has one value of each attribute.
struct VertexSoup {
  struct Attribute {
    std::string name;
    AttributeKind kind = AttributeKind::kGeneric;
    uint32_t components = 1;
    std::vector<float> values;  // #V x components
  };

  std::vector<Vec3f> positions;     // #V
  std::vector<Triangle> triangles;  // #F, indices < #V
  std::vector<Attribute> attributes;
};

// Makes one surface of the soups: the triangles of soup g, in their order, become group g. Positions are one where they are equal,
// values of an attribute likewise (-0 equals 0); vertices that no triangle uses are dropped. Degenerate and repeated triangles stay.
// Attributes of several soups are the same where name, kind and number of components are. Fails with kInvalidData, naming soup,
// attribute and vertex, on numbers that are not finite, indices out of range and arrays of the wrong length. O(n log n).
StatusOr<AttributedMesh> WeldSoups(const std::vector<VertexSoup>& soups);

// The way back: for each group its triangles in their order, vertices being the distinct tuples of a position and the values there,
// in the order of their first use. Attributes in the order of mesh.attributes. num_groups: > all groups of the mesh; a group
// without triangles becomes an empty soup. mesh: one that CheckAttributedMesh accepts. O(n log n).
std::vector<VertexSoup> SplitIntoSoups(const AttributedMesh& mesh, uint32_t num_groups);

// Makes equal positions one vertex and equal values of an attribute one row (-0 equals 0), and drops what no triangle uses; the order
// of what is left is kept. mesh: one that CheckAttributedMesh accepts. O(n log n).
void WeldExactly(AttributedMesh* mesh);

// kInvalidData, with the reason, where array lengths, indices or values are not as said above.
Status CheckAttributedMesh(const AttributedMesh& mesh);

}  // namespace lacerta

#endif  // LACERTA_ATTRIBUTED_MESH_H_
