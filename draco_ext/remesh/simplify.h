// Simplification of any triangles by edge collapses in order of quadric error [Garland, Heckbert 1997], most of it of the planes that are
// there at the moment [Hoppe 1999], recorded so that the mesh can be had at every size from one run [Hoppe 1996]. There is no
// parametrization; for that see decimate.h.
#ifndef LACERTA_REMESH_SIMPLIFY_H_
#define LACERTA_REMESH_SIMPLIFY_H_

#include <cstdint>
#include <memory>
#include <vector>

#include "lacerta/mesh.h"
#include "remesh/deviation_samples.h"

namespace lacerta {

struct SimplificationOptions {
  std::vector<uint8_t> held;  // for each vertex 1 where it stays with its edges to others that are held, exactly; else 0. Empty: none
  // What the mesh was made of, or the mesh itself: no collapse takes a point farther from it than these allow, nor than it is where that is farther. Null: any distance.
  std::shared_ptr<const DeviationSamples> original;
  uint32_t fewest_triangles = 0;  // where it ends
};

// A mesh with the collapses that make it smaller and smaller, in order.
class SimplificationSequence {
 public:
  // mesh: positions finite, indices in range, no triangle with a repeated vertex (what Clean returns). It may be anything but
  // that: open, of many components, not manifold, not oriented.
  //
  // A collapse moves the vertex that remains to where its quadric is least, and is made where it turns no triangle over. Handles,
  // holes and gaps close when they are about as small as the error; parts may then meet in one vertex or edge, and of
  // triangles that come to lie on each other one stays. Every component keeps a triangle. Deterministic; O(n log n).
  explicit SimplificationSequence(const TriangleMesh& mesh, const SimplificationOptions& options = {});

  uint32_t num_input_triangles() const { return static_cast<uint32_t>(triangles_.size()); }
  // Of the coarsest mesh: no collapse is possible any more, or none was to be made.
  uint32_t fewest_triangles() const;
  const std::shared_ptr<const DeviationSamples>& original() const { return original_; }  // of the options

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
  std::shared_ptr<const DeviationSamples> original_;
};

}  // namespace lacerta

#endif  // LACERTA_REMESH_SIMPLIFY_H_
