// Candidates for tests.
#ifndef LACERTA_TESTS_DRACO_EXT_DRACO_CANDIDATES_H_
#define LACERTA_TESTS_DRACO_EXT_DRACO_CANDIDATES_H_

#include <cstdint>
#include <utility>

#include "draco/normal_mesh_candidate.h"
#include "draco/pierced_base.h"
#include "draco/refinable_surface.h"
#include "remesh/surface_fit.h"

namespace lacerta::testing {

// The pierced remesh, fitted to the input.
inline NormalMeshCandidate FittedCandidate(const PiercedBase& pierced, const InputSurface& surface) {
  NormalMesh mesh = pierced.Remesh();
  FitToInput(surface, SurfaceFitOptions(), &mesh);
  return NormalMeshCandidate(pierced.base(), std::move(mesh));
}

inline NormalMeshCandidate MakeCandidate(const RefinableSurface& input, uint32_t num_base_vertices, int num_levels) {
  return FittedCandidate(*PierceUnreversed(input, num_base_vertices, num_levels).value(), input.surface);
}

}  // namespace lacerta::testing

#endif  // LACERTA_TESTS_DRACO_EXT_DRACO_CANDIDATES_H_
