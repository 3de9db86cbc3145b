#include "draco/component_order.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <numeric>

#include "geometry/position_table.h"
#include "remesh/parity_forest.h"

namespace lacerta {
namespace {

// For each triangle the number of its component, counted by first triangles.
std::vector<uint32_t> FindComponents(const TriangleMesh& mesh) {
  PositionTable table(mesh.positions.size());
  std::vector<uint32_t> welded(mesh.positions.size());
  for (uint32_t v = 0; v < welded.size(); ++v) welded[v] = table.FindOrEnter(mesh.positions, mesh.positions[v], v);
  ParityForest forest(welded.size());
  for (const Triangle& t : mesh.triangles) {
    forest.Join(welded[t[0]], welded[t[1]], 0);
    forest.Join(welded[t[0]], welded[t[2]], 0);
  }
  constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();
  std::vector<uint32_t> of_root(welded.size(), kNone), components;
  components.reserve(mesh.triangles.size());
  uint32_t count = 0;
  for (const Triangle& t : mesh.triangles) {
    uint32_t& component = of_root[forest.Find(welded[t[0]]).root];
    if (component == kNone) component = count++;
    components.push_back(component);
  }
  return components;
}

struct Component {
  Vec3f start;  // its first corner
  std::vector<Triangle> triangles;
};

}  // namespace

std::vector<Triangle> ByNearestComponents(const TriangleMesh& mesh, size_t fewest) {
  constexpr size_t kMostComponents = 1u << 13;
  const std::vector<uint32_t> component_of = FindComponents(mesh);
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
