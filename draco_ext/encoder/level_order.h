// A semi-regular mesh in the order that a coded base has: base coders renumber vertices, reorder triangles and rotate them.
#ifndef LACERTA_ENCODER_LEVEL_ORDER_H_
#define LACERTA_ENCODER_LEVEL_ORDER_H_

#include <cstdint>
#include <vector>

#include "lacerta/mesh.h"
#include "lacerta/status.h"

namespace lacerta {

// Which triangle a triangle of the other order is.
struct FaceSource {
  uint32_t face = 0;
  uint32_t rotation = 0;  // corner k is corner k + rotation (mod 3) of `face`
};

// One mesh - a surface or the wedge mesh of an attribute - in two orders.
struct LevelOrder {
  const std::vector<Triangle>& coded;   // #F0 rows at the corners; kNone x 3: the triangle is not there
  const std::vector<Triangle>& source;  // likewise
  uint32_t num_coded_rows = 0;          // of the base
  uint32_t num_source_rows = 0;
  const std::vector<FaceSource>& faces;  // #F0, of coded triangles
  // #F0 in the order of `coded`, or empty: triangles that are not split
  const std::vector<uint8_t>& still;
};

// For every row of levels 0 .. num_levels of the coded mesh the row of the source that lies there. Fails where either is no manifold, or
// a triangle of the coded mesh is not there in the source.
StatusOr<std::vector<uint32_t>> SourceRows(const LevelOrder& order, int num_levels);

// For every edge of the base of the coded mesh, split triangles alone, the edge of the source. As above.
StatusOr<std::vector<uint32_t>> SourceEdges(const LevelOrder& order);

}  // namespace lacerta

#endif  // LACERTA_ENCODER_LEVEL_ORDER_H_
