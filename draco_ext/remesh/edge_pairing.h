// Which faces continue each other across an edge that more than two of them share.
#ifndef LACERTA_REMESH_EDGE_PAIRING_H_
#define LACERTA_REMESH_EDGE_PAIRING_H_

#include <cstdint>
#include <utility>
#include <vector>

#include "lacerta/mesh.h"

namespace lacerta {

// Whether two faces have the same three vertices: the two sides of a sheet without thickness, never neighbors.
bool SameVertices(const Triangle& a, const Triangle& b);

// Pairs of `corners`, which all lie opposite one edge: first of those that run through the edge in opposite directions,
// then of the rest; among them those first that bend least. A pair that folds back on itself is never made. Where two
// solids touch, the two faces of one solid are paired. Some corners may stay alone: always the last of an odd number.
// flipped: #F, 1 where the face counts as turned over. O(n log n) in the number of corners; above 16 only the 16 best
// partners of a corner by angle are looked at.
std::vector<std::pair<uint32_t, uint32_t>> PairAroundEdge(const TriangleMesh& mesh, const std::vector<uint8_t>& flipped,
                                                          Span<const uint32_t> corners);

}  // namespace lacerta

#endif  // LACERTA_REMESH_EDGE_PAIRING_H_
