// The remesh that a parametrization over a base mesh gives by itself [Lee et al. 1998]: no piercing, so that details
// have parts in all three directions.
#ifndef LACERTA_TESTS_BASELINES_MAPS_REMESH_H_
#define LACERTA_TESTS_BASELINES_MAPS_REMESH_H_

#include "lacerta/mesh.h"
#include "remesh/base_domain.h"
#include "remesh/input_surface.h"

namespace lacerta::baselines {

struct MapsOptions {
  int num_levels = 5;
  // Over the finest level: every vertex goes to the mean of its neighbors, then back onto the input. MAPS smooths its
  // parametrization, which ours, made of one chart per collapse, does not; this stands for it. Departs from the paper,
  // which applies the Loop scheme in the parameter domain.
  int relaxation_rounds = 12;
};

// Every vertex of the subdivided base at the point of the input that the parametrization puts at its dyadic barycentric
// coordinates, then relaxed along the input. Vertices on the border stay.
SemiRegularMesh MapsRemesh(const InputSurface& surface, const BaseDomain& domain, const MapsOptions& options = {});

}  // namespace lacerta::baselines

#endif  // LACERTA_TESTS_BASELINES_MAPS_REMESH_H_
