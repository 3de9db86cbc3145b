// A dense surface with attributes, simplified part by part: what a run over all of it holds for every vertex and triangle would be many times
// the input.
#ifndef LACERTA_REMESH_SIMPLIFY_IN_PARTS_H_
#define LACERTA_REMESH_SIMPLIFY_IN_PARTS_H_

#include <cstdint>
#include <vector>

#include "lacerta/attributed_mesh.h"

namespace lacerta {

// The surface with about `share` of its triangles. It is cut in space into parts of at most `part_triangles`, each is simplified by
// AttributedSimplification with the vertices that it has in common with others held, and they are joined again: without cracks, and with
// a line of small triangles along every cut, as whoever simplifies it further takes away. Beside input and result memory is taken for as many parts
// as run at a time. Deterministic, whatever the number of threads; O(n log n).
//   input    one that CheckAttributedMesh accepts
//   weights  as for AttributedSimplification
//   share    above 0, at most 1
AttributedMesh SimplifyInParts(const AttributedMesh& input, const std::vector<double>& weights, double share, uint32_t part_triangles = 125'000);

}  // namespace lacerta

#endif  // LACERTA_REMESH_SIMPLIFY_IN_PARTS_H_
