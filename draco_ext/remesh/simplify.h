// Simplification of any triangles by edge collapses in order of quadric error [Garland, Heckbert 1997], most of it of the planes that are
// there at the moment [Hoppe 1999], recorded so that the mesh can be had at every size from one run [Hoppe 1996]. There is no
// parametrization; for that see decimate.h.
#ifndef LACERTA_REMESH_SIMPLIFY_H_
#define LACERTA_REMESH_SIMPLIFY_H_

#include <cstdint>
#include <vector>

#include "lacerta/mesh.h"

namespace lacerta {

// A mesh with the collapses that make it smaller and smaller, in order.
class SimplificationSequence {
 public:
  // mesh: positions finite, indices in range, no triangle with a repeated vertex (what Clean returns). It may be anything but
  // that: open, of many components, not manifold, not oriented.
  //
  // A collapse moves the vertex that remains to where its quadric is least, and is made where it turns no triangle over. Handles,
  // holes and gaps close when they are about as small as the error; parts may then meet in one vertex or edge, and of
  // triangles that come to lie on each other one stays. Every component keeps a triangle. Deterministic; O(n log n).
  //
  // held: for each vertex 1 where it stays with its edges to others that are held, exactly; else 0. Empty: none.
  explicit SimplificationSequence(const TriangleMesh& mesh, const std::vector<uint8_t>& held = {});

  uint32_t num_input_triangles() const { return static_cast<uint32_t>(triangles_.size()); }
  // Of the coarsest mesh: no collapse is possible any more.
  uint32_t fewest_triangles() const;

  // The mesh of at most `num_triangles`, but not fewer than fewest_triangles(), after as few collapses as possible; only with the
  // vertices in use. Linear time.
  TriangleMesh MeshWith(uint32_t num_triangles) const;

 private:
  friend class Simplifier;
  struct Collapse {
    uint32_t removed, kept;
    Vec3f position;          // of `kept` from then on
    uint32_t num_triangles;  // that remain
  };

  struct Removal {
    uint32_t triangle;
    uint32_t num_collapses;  // after which it has gone
  };

  std::vector<Vec3f> positions_;
  std::vector<Triangle> triangles_;
  std::vector<Collapse> collapses_;
  std::vector<Removal> removed_;  // of those that coincided with another
};

}  // namespace lacerta

#endif  // LACERTA_REMESH_SIMPLIFY_H_
