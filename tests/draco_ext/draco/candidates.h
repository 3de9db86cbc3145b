// Candidates for tests.
#ifndef LACERTA_TESTS_DRACO_EXT_DRACO_CANDIDATES_H_
#define LACERTA_TESTS_DRACO_EXT_DRACO_CANDIDATES_H_

#include <cstdint>
#include <memory>

#include "draco/normal_mesh_candidate.h"
#include "draco/pierced_base.h"
#include "draco/refinable_surface.h"

namespace lacerta::testing {

inline NormalMeshCandidate MakeCandidate(const RefinableSurface& input, uint32_t num_base_vertices, int num_levels) {
  const std::unique_ptr<PiercedBase> pierced = PierceUnreversed(input, num_base_vertices, num_levels).value();
  return NormalMeshCandidate(pierced->base(), pierced->Fitted());
}

}  // namespace lacerta::testing

#endif  // LACERTA_TESTS_DRACO_EXT_DRACO_CANDIDATES_H_
