// The two triangles at an edge, which turns from one diagonal of their quadrangle to the other.
#ifndef LACERTA_REMESH_EDGE_QUAD_H_
#define LACERTA_REMESH_EDGE_QUAD_H_

#include <cstdint>
#include <vector>

#include "common/subdivision.h"
#include "lacerta/mesh.h"

namespace lacerta {

// The edge from a to b of the faces f, which is (c, a, b) from its corner at_c on, and g, (d, b, a) from at_d on.
struct EdgeQuad {
  // edge: no border.
  EdgeQuad(const Topology& t, uint32_t edge)
      : f(t.edge_faces[edge][0]),
        g(t.edge_faces[edge][1]),
        at_c(EdgeCorner(t, f, edge)),
        at_d(EdgeCorner(t, g, edge)),
        a(t.triangles[f][(at_c + 1) % 3]),
        b(t.triangles[f][(at_c + 2) % 3]),
        c(t.triangles[f][at_c]),
        d(t.triangles[g][at_d]) {}

  // f becomes (c, a, d), and g (d, b, c). at_f, at_g: where they are among `triangles`, whatever their vertices are called there.
  void Turn(uint32_t at_f, uint32_t at_g, std::vector<Triangle>* triangles) const {
    Triangle &first = (*triangles)[at_f], &second = (*triangles)[at_g];
    first[(at_c + 2) % 3] = second[at_d];
    second[(at_d + 2) % 3] = first[at_c];
  }

  uint32_t f, g;
  int at_c, at_d;
  uint32_t a, b, c, d;
};

}  // namespace lacerta

#endif  // LACERTA_REMESH_EDGE_QUAD_H_
