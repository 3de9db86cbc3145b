// An attribute of a primitive as a mesh of its own.
#ifndef LACERTA_PACK_VALUE_WEDGES_H_
#define LACERTA_PACK_VALUE_WEDGES_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "document/primitive.h"
#include "geometry/by_vertex.h"
#include "pack/attribute_value.h"

namespace lacerta {

// Vertices that agree in their rounded position and value are one wedge, as they are to stock Draco.
struct ValueWedges {
  std::vector<uint32_t> of_vertex;
  std::vector<Vec3d> positions;                    // of each wedge, rounded
  std::vector<AttributeValue> wanted;
  std::vector<std::array<uint32_t, 3>> triangles;  // of three wedges each
  std::vector<double> areas;                       // of each, before rounding
  ByVertex corners;                                // of each wedge: 3 * triangle + corner

  size_t size() const { return positions.size(); }
};

// A triangle of a surface by its wedges; nothing where two of these are the same. `surface` has the positions before rounding.
void AddTriangle(const std::array<uint32_t, 3>& corners, const TriangleMesh& surface, const Triangle& triangle, ValueWedges* wedges);

// positions: of the primitive, rounded. wanted, rounded: values of the attribute.
ValueWedges WedgesOf(const Primitive& primitive, const std::vector<Vec3f>& positions, const AccessorData& wanted, const AccessorData& rounded, bool is_direction);

}  // namespace lacerta

#endif  // LACERTA_PACK_VALUE_WEDGES_H_
