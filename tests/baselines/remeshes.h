// The semi-regular meshes that the coders are compared on: one base, two remeshes over it.
#ifndef LACERTA_TESTS_BASELINES_REMESHES_H_
#define LACERTA_TESTS_BASELINES_REMESHES_H_

#include <cstdint>

#include "draco/base_mesh_codec.h"
#include "lacerta/mesh.h"
#include "lacerta/remesh.h"
#include "lacerta/status.h"

namespace lacerta::baselines {

struct Remeshes {
  CodedBase base;        // whose order of vertices and triangles all of them have
  NormalMesh normal;     // pierced [Guskov et al. 2000], without fit: vertices lie on the input
  NormalMesh fitted;     // the same after FitToInput, as the product codes it
  SemiRegularMesh maps;  // vertices at dyadic points of the parametrization [Lee et al. 1998]
};

// input: one oriented manifold, cleaned; no creases are looked for. num_base_vertices: of the base, more where
// decimation cannot go on.
StatusOr<Remeshes> MakeRemeshes(const TriangleMesh& input, uint32_t num_base_vertices, int num_levels);

}  // namespace lacerta::baselines

#endif  // LACERTA_TESTS_BASELINES_REMESHES_H_
