// Sharp bends of the curves on a surface: its border and its creases.
#ifndef LACERTA_REMESH_CORNERS_H_
#define LACERTA_REMESH_CORNERS_H_

#include <cstdint>
#include <vector>

#include "common/subdivision.h"
#include "lacerta/mesh.h"

namespace lacerta {

// #V, 1 where two curve edges meet (border edges and those with crease[e] != 0) and the curve turns by `min_turn` radians at
// least, more than anywhere near it and 1.5 times what it turns farther on. The turn is measured between chords of up to three
// edges on either side, fewer on short curves, so that a jagged border has no corners. Where a curve turns by 75 degrees or
// more, what it does farther on does not matter: a square of four edges has four corners.
// crease: #E. O(n).
std::vector<uint8_t> FindCorners(const TriangleMesh& mesh, const Topology& topology, const std::vector<uint8_t>& crease,
                                 double min_turn);

}  // namespace lacerta

#endif  // LACERTA_REMESH_CORNERS_H_
