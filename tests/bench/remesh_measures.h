// What remesh_report measures on a remesh beside the distance of the surfaces.
#ifndef LACERTA_TESTS_BENCH_REMESH_MEASURES_H_
#define LACERTA_TESTS_BENCH_REMESH_MEASURES_H_

#include <cstdint>
#include <vector>

#include "common/subdivision.h"
#include "lacerta/mesh.h"
#include "lacerta/surface_distance.h"
#include "remesh/input_surface.h"

namespace lacerta {

// Euler characteristic and border polygons of one component.
struct ComponentShape {
  int64_t euler = 0;
  int64_t borders = 0;

  bool operator==(const ComponentShape& b) const { return euler == b.euler && borders == b.borders; }
};

// Components in the order of their smallest vertices. Isolated vertices belong to none.
struct Components {
  std::vector<ComponentShape> shapes;
  std::vector<uint32_t> of_vertex;  // #V, kNone for isolated ones
};
Components FindComponents(const Topology& topology);

// Components of one level of a remesh that differ from the component of the input they stand for, and those of the input
// that have none or several. input_vertex: of the base vertices, which come first in `level`.
uint64_t NumChangedComponents(const Components& input, const Topology& level, const std::vector<uint32_t>& input_vertex);

enum class Curve { kBorder, kCrease };

// Distance between the border edges, or the creases, of two surfaces: over points spread evenly along the curves of each to the
// closest point of the other's. Model units; zero where neither has any, infinite where one has none.
SurfaceDistance CurveDistance(const TriangleMesh& input, const Topology& input_topology, const TriangleMesh& remesh,
                              const Topology& remesh_topology, Curve kind);

// Shares of the area of triangles that are more than 90 degrees off the input.
struct ReversedShare {
  // From the input's interpolated normal at the point closest to the centroid: thin parts count too, where that point is on the
  // far side.
  double at_closest = 0;
  // The same but for triangles that face another part of the input no farther away than they are long; and all that are off from
  // the sum of the input's normals at their own vertices.
  double confirmed = 0;
};
// normals: #V of the remesh, the input's where the vertices were taken from it; zero where it has several.
ReversedShare MeasureReversed(const InputSurface& input, const TriangleMesh& remesh, const std::vector<Vec3f>& normals);

}  // namespace lacerta

#endif  // LACERTA_TESTS_BENCH_REMESH_MEASURES_H_
