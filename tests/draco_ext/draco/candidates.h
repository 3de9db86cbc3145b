// Candidates for tests.
#ifndef LACERTA_TESTS_DRACO_EXT_DRACO_CANDIDATES_H_
#define LACERTA_TESTS_DRACO_EXT_DRACO_CANDIDATES_H_

#include <cstdint>

#include "draco/normal_mesh_candidate.h"
#include "draco/pierced_base.h"
#include "draco/refinable_surface.h"

namespace lacerta::testing {

inline NormalMeshCandidate MakeCandidate(const RefinableSurface& input, uint32_t num_base_vertices, int num_levels) {
  return NormalMeshCandidate::Fitted(PierceUnreversed(input, num_base_vertices, num_levels).value(), input.surface);
}

}  // namespace lacerta::testing

#endif  // LACERTA_TESTS_DRACO_EXT_DRACO_CANDIDATES_H_
