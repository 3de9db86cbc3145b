// What BaseTags (lacerta/mesh.h) mean for the triangles and points of a base mesh, for decoder and encoder alike.
#ifndef LACERTA_COMMON_BASE_TAGS_H_
#define LACERTA_COMMON_BASE_TAGS_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "lacerta/mesh.h"

namespace lacerta {

// BaseTags::joined of a base: for every vertex the first one with the same lattice value, which may be itself.
std::vector<uint32_t> FirstAtSamePoint(Span<const std::array<int32_t, 3>> lattice);

// Whether `joined` joins anything: some vertex has another one before it.
bool JoinsAnything(const std::vector<uint32_t>& joined);

// The tags with an empty vector for everything that they do not have: no triangle still, no crease, ...
BaseTags NormalizedTags(BaseTags tags);

// Number of triangles that are never split.
size_t NumStill(const BaseTags& tags);

// The triangles of a level above the base: `split`, the refined ones, and after them the still ones in the order of the base.
std::vector<Triangle> WithStillTriangles(std::vector<Triangle> split, const std::vector<Triangle>& base_triangles,
                                         const BaseTags& tags);

}  // namespace lacerta

#endif  // LACERTA_COMMON_BASE_TAGS_H_
