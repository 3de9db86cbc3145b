// An input surface as the parts that are coded in different ways: what is remeshed, and what stands still beside it.
#ifndef LACERTA_REMESH_SURFACE_PARTS_H_
#define LACERTA_REMESH_SURFACE_PARTS_H_

#include <cstdint>
#include <vector>

#include "common/subdivision.h"
#include "lacerta/mesh.h"
#include "remesh/manifold.h"

namespace lacerta {

struct SurfaceParts {
  // Components worth a base mesh and levels, as an oriented manifold with border; may be empty.
  TriangleMesh refined;
  // Of `refined`, with its creases. Corners are also the vertices at which the surface was cut, so that both sides of a cut keep
  // the same points, but not those inside of double sheets; and one in the middle of all but one of the borders that share
  // both ends and nothing else, so that no base takes them for one.
  Topology topology;
  std::vector<uint32_t> source_vertex;  // #V of refined, the vertex of the cleaned input: equal for the copies of a cut
  // All other components, as they are; may be empty.
  TriangleMesh still;
  uint64_t refined_components = 0, still_components = 0;
  ManifoldReport report;
};

struct SurfacePartsOptions {
  uint32_t fewest_faces = 500;  // of a component that is worth remeshing
};

// cleaned: any mesh that Clean returned.
SurfaceParts SplitSurface(const TriangleMesh& cleaned, const SurfacePartsOptions& options = {});

}  // namespace lacerta

#endif  // LACERTA_REMESH_SURFACE_PARTS_H_
