// Cleaning of an input mesh before it is coded.
#ifndef LACERTA_CLEAN_H_
#define LACERTA_CLEAN_H_

#include <cstdint>

#include "lacerta/mesh.h"
#include "lacerta/status.h"

namespace lacerta {

// What cleaning did: counts of what was merged or removed.
struct CleanReport {
  uint64_t welded_vertices = 0;       // merged with another vertex at the same position, or beyond a crack of rounding
  uint64_t degenerate_triangles = 0;  // with a repeated vertex, once welded
  uint64_t duplicate_triangles = 0;   // with the same three vertices and orientation as an earlier one
  uint64_t isolated_vertices = 0;     // of no triangle
};

struct CleanedMesh {
  TriangleMesh mesh;
  CleanReport report;
};

// Welds vertices of exactly equal position (-0 equals 0), then those on borders that are nearer to each other than a
// millionth of the diagonal, which exporters leave where they compute a vertex twice; then drops degenerate and
// duplicate triangles and isolated vertices. The order of what is left is kept. Fails with kInvalidData on a position
// that is not finite or an index out of range, and where no triangle is left.
StatusOr<CleanedMesh> Clean(const TriangleMesh& mesh);

// The same without a copy: takes some 10 bytes a triangle beside the mesh. What is left of it where that fails is of no use.
StatusOr<CleanReport> CleanInPlace(TriangleMesh* mesh);

}  // namespace lacerta

#endif  // LACERTA_CLEAN_H_
