// Creases and corners of a surface, found in its shape alone.
#ifndef LACERTA_REMESH_FEATURES_H_
#define LACERTA_REMESH_FEATURES_H_

#include <cstdint>
#include <vector>

#include "common/subdivision.h"
#include "lacerta/mesh.h"

namespace lacerta {

// Angles in degrees.
struct FeatureOptions {
  double strong_bend = 28;  // a crease has at least one edge that bends by this and by strong_usual times the usual
  double weak_bend = 18;    // and all its edges bend by this and by weak_usual times the usual
  double strong_usual = 8;  // the usual bend: the median over the edges that do not stand out
  double weak_usual = 4;
  double max_turn = 50;     // between edges that continue each other
  uint32_t min_free = 8;    // edges of a curve that ends in the middle of the surface
  double corner_turn = 45;  // of a corner, over some edges on either side
};

struct Features {
  std::vector<uint8_t> crease;  // #E of the topology, 1: a crease; never a border edge
  std::vector<uint8_t> corner;  // #V, 1: two curve edges (border or crease) meet here and the curve bends sharply
};

// mesh, topology: BuildTopology of the mesh, which may have creases already: they are not looked at.
// An edge may be a crease where it bends much more than the surface beside it (BendBeside), all the more the flatter it
// is: the edges of a densely rounded one bend alike. Hysteresis along chains [Hubeli, Gross 2001] with thresholds
// relative to the usual bend keeps noise out; then small gaps are closed, and spurs and small networks are dropped.
// Guaranteed: a curve that ends in the middle of the surface has min_free edges or more; every connected network of
// creases has 3 edges or more, and more on larger meshes: the root of #E over 10, up to 24, or up to 12 where nothing
// in it ends in the middle of the surface; a face all of whose edges are creases has none that bends by less than 60
// degrees. O(n log n), whatever the valences.
Features DetectFeatures(const TriangleMesh& mesh, const Topology& topology, const FeatureOptions& options = {});

}  // namespace lacerta

#endif  // LACERTA_REMESH_FEATURES_H_
