// The remesh that a parametrization over a base mesh gives by itself [Lee et al. 1998]: no piercing, so that details have parts in all
// three directions.
#ifndef LACERTA_TESTS_BASELINES_MAPS_REMESH_H_
#define LACERTA_TESTS_BASELINES_MAPS_REMESH_H_

#include "lacerta/mesh.h"
#include "remesh/base_domain.h"
#include "remesh/input_surface.h"

namespace lacerta::baselines {

// Every vertex of the subdivided base at the point of the input that the parametrization puts at its dyadic barycentric coordinates.
SemiRegularMesh MapsRemesh(const InputSurface& surface, const BaseDomain& domain, int num_levels);

}  // namespace lacerta::baselines

#endif  // LACERTA_TESTS_BASELINES_MAPS_REMESH_H_
