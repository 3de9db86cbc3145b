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
  std::vector<uint32_t> refined_faces, still_faces;  // #F of each, the face of the manifold
  std::vector<uint8_t> shape_creases;  // #E of the topology, 1 for those curves that the shape itself shows; none of the border
  // All other components, as they are; may be empty.
  TriangleMesh still;
  uint64_t refined_components = 0, still_components = 0;
  ManifoldReport report;
};

struct SurfacePartsOptions {
  uint32_t fewest_faces = 500;  // of a component that is worth remeshing
};

// An oriented manifold, one fan per vertex, of several components and what is to become of them.
struct SurfaceToSplit {
  const TriangleMesh& mesh;
  const std::vector<uint32_t>& source_vertex;  // #V
  const std::vector<uint32_t>& component;      // #F, < #C
  std::vector<uint8_t> refine;                 // #C, 1: worth remeshing
  std::vector<uint8_t> curves;                 // #F, bit k: the edge across corner k is a curve, whatever the shape; or empty
};
SurfaceParts SplitSurface(const SurfaceToSplit& whole);

// Makes corners of the middles of borders that share both ends and nothing else, all but one (see SurfaceParts::topology). Where corners
// were added since, others may have to be.
void PinBordersWithCommonEnds(const std::vector<uint32_t>& source_vertex, Topology* topology);

// cleaned: any mesh that Clean returned.
SurfaceParts SplitSurface(const TriangleMesh& cleaned, const SurfacePartsOptions& options = {});

}  // namespace lacerta

#endif  // LACERTA_REMESH_SURFACE_PARTS_H_
