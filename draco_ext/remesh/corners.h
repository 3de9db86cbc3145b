// Sharp bends of the curves on a surface: its border and its creases.
#ifndef LACERTA_REMESH_CORNERS_H_
#define LACERTA_REMESH_CORNERS_H_

#include <cstdint>
#include <vector>

#include "common/subdivision.h"
#include "lacerta/mesh.h"

namespace lacerta {

// #V, 1 where two curve edges meet (border edges and those with crease[e] != 0) and the curve turns by `min_turn`
// radians at least. Either between these two edges, and three times as much as at the next vertices; or between chords
// of four edges on either side (of one or two on short curves), so that a jagged border has no corners: there it turns
// more than anywhere near and 1.5 times what it turns farther on, or by 75 degrees, which makes a square of four edges
// have four corners. crease: #E. O(n).
std::vector<uint8_t> FindCorners(const TriangleMesh& mesh, const Topology& topology, const std::vector<uint8_t>& crease,
                                 double min_turn);

}  // namespace lacerta

#endif  // LACERTA_REMESH_CORNERS_H_
