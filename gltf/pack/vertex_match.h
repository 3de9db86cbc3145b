// Which vertex of the input every vertex of a coded primitive is: for what refers to vertices by their order.
#ifndef LACERTA_PACK_VERTEX_MATCH_H_
#define LACERTA_PACK_VERTEX_MATCH_H_

#include <cstdint>
#include <optional>
#include <vector>

#include "document/draco_encode.h"
#include "document/primitive.h"

namespace lacerta {

// For every vertex of `decoded` a vertex of `rounded` (RoundAttributes of the input at the same precision) with the same
// values. Empty where one has none, and where several have the same values but differ in `tied`: further attributes of
// #V elements that go with the vertices, but not into the stream.
std::optional<std::vector<uint32_t>> MatchVertices(const Primitive& rounded, const Primitive& decoded,
                                                   const DracoPrecision& precision,
                                                   const std::vector<AccessorData>& tied);

// The elements of `data` at `order`.
AccessorData Reorder(const AccessorData& data, const std::vector<uint32_t>& order);

}  // namespace lacerta

#endif  // LACERTA_PACK_VERTEX_MATCH_H_
