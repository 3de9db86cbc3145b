// Cracks of rounding: borders that were one edge until an exporter computed its ends twice.
#ifndef LACERTA_GEOMETRY_CLOSE_CRACKS_H_
#define LACERTA_GEOMETRY_CLOSE_CRACKS_H_

#include <cstdint>
#include <vector>

#include "lacerta/mesh.h"

namespace lacerta {

// For each vertex the one to take in its place: itself, or, at the end of an edge that is not of two triangles, an
// earlier such vertex that is nearer than a millionth of the diagonal (some roundings of a float). Many CAD systems
// write STL files with such gaps. Vertices inside of the surface stay, however near. mesh: welded, its indices below
// #V. O(n log n).
std::vector<uint32_t> VerticesWithoutCracks(const TriangleMesh& mesh);

}  // namespace lacerta

#endif  // LACERTA_GEOMETRY_CLOSE_CRACKS_H_
