// A dense surface, simplified part by part: what a run over all of it holds for every vertex and triangle would be many times the input.
#ifndef LACERTA_REMESH_SIMPLIFY_IN_PARTS_H_
#define LACERTA_REMESH_SIMPLIFY_IN_PARTS_H_

#include <cstdint>
#include <vector>

#include "lacerta/attributed_mesh.h"
#include "lacerta/mesh.h"

namespace lacerta {

// The surface with about `num_triangles` triangles. It is cut in space into parts of at most `part_triangles`, each is simplified by
// SimplificationSequence with the vertices that it has in common with others held, and they are joined again: without cracks, and with
// a line of small triangles along every cut, as whoever simplifies it further takes away. Where few are wanted, that is done several times. Beside
// input and result memory is taken for as many parts as run at a time. Deterministic, whatever the number of threads; O(n log n).
//   mesh  one that Clean has returned: no two vertices in one place
TriangleMesh SimplifyInParts(const TriangleMesh& mesh, uint32_t num_triangles, uint32_t part_triangles = 125'000);

// The same by AttributedSimplification, of a surface with attributes.
//   input    one that CheckAttributedMesh accepts
//   weights  as for AttributedSimplification
AttributedMesh SimplifyInParts(const AttributedMesh& input, const std::vector<double>& weights, uint32_t num_triangles, uint32_t part_triangles = 125'000);

}  // namespace lacerta

#endif  // LACERTA_REMESH_SIMPLIFY_IN_PARTS_H_
