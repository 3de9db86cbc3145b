// How the triangles of a base with attributes hang together, found from integers alone: hosts hold the base as glTF does, with a vertex
// for every tuple of a position and the values there. Specified in docs/format.md, "Gluing".
#ifndef LACERTA_COMMON_GLUING_H_
#define LACERTA_COMMON_GLUING_H_

#include <array>
#include <cstdint>
#include <vector>

#include "lacerta/mesh.h"

namespace lacerta {

// For every half-edge 3f + k, which lies opposite corner k of triangle f and runs from its corner k + 1 to its corner k + 2 (mod 3), the
// one with the same two lattice points in the opposite order; kNone where it has none, or there are more than these two at them.
std::vector<uint32_t> PairHalfEdges(Span<const std::array<int32_t, 3>> lattice, const std::vector<Triangle>& triangles);

struct GluedCorners {
  std::vector<Triangle> vertices;      // #F; kNone x 3 where a triangle was left out
  std::vector<uint32_t> first_corner;  // of each vertex: 3f + k
};

// Corners that are one vertex: those across the pairs of half-edges in `twins`, as PairHalfEdges makes them, or kNone where a pair is not glued,
// which must be the same either way round. Vertices are numbered in the order of their first corners. is_in: #F, whether a triangle takes part.
GluedCorners GlueCorners(Span<const uint8_t> is_in, Span<const uint32_t> twins);

}  // namespace lacerta

#endif  // LACERTA_COMMON_GLUING_H_
