// The corners of a triangle soup, grouped by the edge they lie opposite to.
#ifndef LACERTA_REMESH_EDGE_CORNERS_H_
#define LACERTA_REMESH_EDGE_CORNERS_H_

#include <cstdint>
#include <vector>

#include "lacerta/mesh.h"

namespace lacerta {

// Corner 3f + k of face f lies opposite the edge that runs from StartOfEdge to EndOfEdge in the direction of the face.
inline uint32_t NextCorner(uint32_t corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }
inline uint32_t PreviousCorner(uint32_t corner) { return corner % 3 == 0 ? corner + 2 : corner - 1; }
inline uint32_t VertexOf(const std::vector<Triangle>& triangles, uint32_t corner) {
  return triangles[corner / 3][corner % 3];
}
inline uint32_t StartOfEdge(const std::vector<Triangle>& triangles, uint32_t corner) {
  return VertexOf(triangles, NextCorner(corner));
}
inline uint32_t EndOfEdge(const std::vector<Triangle>& triangles, uint32_t corner) {
  return VertexOf(triangles, PreviousCorner(corner));
}

struct EdgeCorners {
  std::vector<uint32_t> corners;  // 3 #F, those of an edge ascending
  std::vector<uint32_t> begin;    // #E + 1, where the corners of an edge start

  uint32_t num_edges() const { return static_cast<uint32_t>(begin.size()) - 1; }
  Span<const uint32_t> of(uint32_t edge) const {
    return {corners.data() + begin[edge], size_t{begin[edge + 1]} - begin[edge]};
  }
};

// Edges with any number of faces in either direction. O(n log n) on any input. Indices must be < num_vertices.
EdgeCorners GroupByEdge(size_t num_vertices, const std::vector<Triangle>& triangles);

}  // namespace lacerta

#endif  // LACERTA_REMESH_EDGE_CORNERS_H_
