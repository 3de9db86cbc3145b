// The base of a progressive stream that carries attributes and groups of faces: what a host that read the base section hands to
// ProgressiveDecoder (lacerta/decoder.h), and what comes out of that.
#ifndef LACERTA_ATTRIBUTED_BASE_H_
#define LACERTA_ATTRIBUTED_BASE_H_

#include <cstdint>
#include <string>
#include <vector>

#include "lacerta/attributed_levels.h"
#include "lacerta/attributed_mesh.h"
#include "lacerta/decoder.h"
#include "lacerta/status.h"

namespace lacerta {

// An attribute of a base on its integer lattice.
struct BaseAttribute {
  AttributeLattice precision;
  // #V x components: the value is step times these; of normals #V x 2, points of the octahedral lattice. Anything at vertices of
  // groups without the attribute.
  std::vector<int32_t> values;
  std::vector<uint8_t> in_group;  // #groups, 1: the group has it

  uint32_t numbers_per_value() const { return precision.octahedral_bits > 0 ? 2 : precision.components; }
};

// A base mesh as glTF holds it: a vertex for every tuple of a position and the values there, the vertices and triangles of one primitive
// after those of the other. Triangles hang together where their edges have the same two lattice points and no third triangle has: how
// vertices are shared does not matter.
struct AttributedBase {
  BaseMesh mesh;
  std::vector<uint32_t> group_sizes;  // triangles of each group; they add up to #F
  std::vector<BaseAttribute> attributes;
};

// The base of a host that holds floats: one soup per group. precision: of the stream's header (RefinementInfo). A soup has an attribute
// where one of that name and number of components is in it. Fails as BaseMeshFromPositions does, and with kInvalidData where a value is off
// its lattice.
StatusOr<AttributedBase> AttributedBaseFromSoups(const std::vector<VertexSoup>& groups, float step,
                                                 const std::vector<AttributeLattice>& precision);

// The mesh of one level (0 = base) with its attributes; above the base, the still triangles come last. Not welded, and rows that no
// triangle of the level uses may be there. Fails as MeshAtLevel does, and with kInvalidData where a wedge mesh does not fit.
StatusOr<AttributedMesh> AttributedMeshAtLevel(const AttributedSemiRegularMesh& mesh, int level);
// The same of what a decoder has; its finest level comes without making all levels anew.
StatusOr<AttributedMesh> AttributedMeshAtLevel(const ProgressiveDecoder& decoder, int level);

}  // namespace lacerta

#endif  // LACERTA_ATTRIBUTED_BASE_H_
