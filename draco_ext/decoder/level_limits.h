// What the limits of a decoder say to a base and to one more level.
#ifndef LACERTA_DECODER_LEVEL_LIMITS_H_
#define LACERTA_DECODER_LEVEL_LIMITS_H_

#include <cstddef>
#include <string>

#include "common/subdivision.h"
#include "lacerta/decoder.h"

namespace lacerta {

// What they say to a base.
inline Status CheckBaseFits(size_t num_vertices, size_t num_triangles, const DecodeLimits& limits) {
  if (num_vertices <= limits.max_vertices && num_triangles <= limits.max_triangles) return Status();
  return LimitExceeded("the base mesh (" + std::to_string(num_vertices) + " vertices, " + std::to_string(num_triangles) +
                       " triangles) is over the decode limits");
}

// Fails with kLimitExceeded where `level`, so many `steps` finer than `t`, has more vertices or triangles than allowed.
// num_still: triangles that no level splits
inline Status CheckLevelFits(const Topology& t, size_t num_still, int level, const DecodeLimits& limits, int steps = 1) {
  const LevelCounts finer = SubdividedCounts({t.num_vertices, t.num_edges(), t.num_faces()}, steps);
  const uint64_t num_triangles = finer.faces + num_still;
  if (finer.vertices <= limits.max_vertices && num_triangles <= limits.max_triangles && 2 * finer.edges < kNone)
    return Status();
  return LimitExceeded("level " + std::to_string(level) + " (" + std::to_string(finer.vertices) + " vertices, " +
                       std::to_string(num_triangles) + " triangles) is over the decode limits");
}

}  // namespace lacerta

#endif  // LACERTA_DECODER_LEVEL_LIMITS_H_
