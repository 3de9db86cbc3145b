// A surface with attributes as the parts that are coded in different ways, its seams among the curves.
#ifndef LACERTA_REMESH_ATTRIBUTED_PARTS_H_
#define LACERTA_REMESH_ATTRIBUTED_PARTS_H_

#include <cstdint>
#include <vector>

#include "common/subdivision.h"
#include "lacerta/attributed_mesh.h"
#include "lacerta/status.h"

namespace lacerta {

struct AttributedParts {
  // Components worth a base mesh and levels: an oriented manifold with border, one fan per vertex. Attributes as in the input, with all
  // their values; which corners share one at a vertex does not tell what is continuous there (see `seams`).
  AttributedMesh refined;
  // Of refined.surface, with creases of the shape, seams of all attributes and borders of groups as its curves. Corners are also the
  // vertices at which a curve becomes or stops to be a seam or a border of groups, one inside of every slit, and what SurfaceParts tells.
  Topology topology;
  std::vector<uint32_t> source_vertex;  // #V of refined, the vertex of the input: equal for the copies of a cut
  // For each attribute and edge of the topology 1 where the attribute is not continuous: seams, and edges of faces that have not got it.
  std::vector<std::vector<uint8_t>> seams;
  std::vector<uint8_t> shape_creases;  // #E, 1 for those curves that the shape itself shows
  // All other components, an oriented manifold as well; may be empty.
  AttributedMesh still;
};

struct AttributedPartsOptions {
  uint32_t fewest_faces = 500;  // of a component that is worth remeshing
  // Corners per face beyond which a component stands still: every corner is a vertex of the base, which has twice as many faces, and
  // there have to be two levels above it.
  double most_corners = 1.0 / 16;
};

// mesh: one that CheckAttributedMesh accepts. kUnsupported where no component is worth remeshing, with the reason (too many seams, too few
// triangles), and where neighboring triangles look opposite ways: to turn them would change what is seen. O(n log n).
StatusOr<AttributedParts> SplitAttributedSurface(const AttributedMesh& mesh, const AttributedPartsOptions& options = {});

// For each corner of an attribute's faces the number of its wedge: the corners around a vertex between two seams are one, whatever their
// values. triangles, topology: of one surface; is_seam: #E. Numbers are below 3 #F, equal for equal wedges: the smallest 3 f + k of it.
std::vector<uint32_t> FindWedges(const Topology& topology, const std::vector<uint8_t>& is_seam);

}  // namespace lacerta

#endif  // LACERTA_REMESH_ATTRIBUTED_PARTS_H_
