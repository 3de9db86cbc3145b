#include "draco/component_order.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <numeric>

#include "geometry/position_table.h"
#include "remesh/components.h"

namespace lacerta {
namespace {

// The mesh with equal positions as one vertex each; those that are one with another stay, without triangles.
TriangleMesh Welded(TriangleMesh mesh) {
  PositionTable table(mesh.positions.size());
  std::vector<uint32_t> first(mesh.positions.size());
  for (uint32_t v = 0; v < first.size(); ++v) first[v] = table.FindOrEnter(mesh.positions, mesh.positions[v], v);
  for (Triangle& t : mesh.triangles) {
    for (uint32_t& v : t) v = first[v];
  }
  return mesh;
}

struct Component {
  Vec3f start;  // its first corner
  std::vector<Triangle> triangles;
};

}  // namespace

std::vector<Triangle> ByNearestComponents(const TriangleMesh& mesh, size_t fewest) {
  constexpr size_t kMostComponents = 1u << 13;
  const std::vector<uint32_t> component_of = FindComponents(Welded(mesh));
  const size_t count = component_of.empty() ? 0 : size_t{1} + *std::max_element(component_of.begin(), component_of.end());
  if (count < fewest || count > kMostComponents) return mesh.triangles;
  std::vector<Component> components(count);
  for (size_t f = 0; f < component_of.size(); ++f) {
    Component& component = components[component_of[f]];
    if (component.triangles.empty()) component.start = mesh.positions[mesh.triangles[f][0]];
    component.triangles.push_back(mesh.triangles[f]);
  }
  std::vector<uint32_t> left(count);  // in their order
  std::iota(left.begin(), left.end(), 0u);
  std::vector<Triangle> result;
  result.reserve(mesh.triangles.size());
  for (auto next = left.begin(); !left.empty();) {
    const Component& component = components[*next];
    result.insert(result.end(), component.triangles.begin(), component.triangles.end());
    left.erase(next);
    float least = std::numeric_limits<float>::infinity();
    next = left.begin();
    for (auto c = left.begin(); c != left.end(); ++c) {
      const float distance = SquaredNorm(components[*c].start - component.start);
      if (distance >= least) continue;
      least = distance;
      next = c;
    }
  }
  return result;
}

}  // namespace lacerta
