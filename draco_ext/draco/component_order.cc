#include "draco/component_order.h"

#include <cstdint>
#include <limits>
#include <utility>

#include "geometry/position_table.h"
#include "remesh/parity_forest.h"

namespace lacerta {
namespace {

struct Component {
  Vec3f start;  // its first corner
  std::vector<Triangle> triangles;
};

std::vector<Component> ComponentsOf(const TriangleMesh& mesh) {
  PositionTable table(mesh.positions.size());
  std::vector<uint32_t> welded(mesh.positions.size());
  for (uint32_t v = 0; v < welded.size(); ++v) welded[v] = table.FindOrEnter(mesh.positions, mesh.positions[v], v);
  ParityForest forest(welded.size());
  for (const Triangle& t : mesh.triangles) {
    forest.Join(welded[t[0]], welded[t[1]], 0);
    forest.Join(welded[t[0]], welded[t[2]], 0);
  }
  constexpr size_t kNone = std::numeric_limits<size_t>::max();
  std::vector<size_t> of_root(welded.size(), kNone);
  std::vector<Component> components;
  for (const Triangle& t : mesh.triangles) {
    size_t& component = of_root[forest.Find(welded[t[0]]).root];
    if (component == kNone) {
      component = components.size();
      components.push_back({mesh.positions[t[0]], {}});
    }
    components[component].triangles.push_back(t);
  }
  return components;
}

}  // namespace

std::vector<Triangle> ByNearestComponents(const TriangleMesh& mesh, size_t fewest) {
  constexpr size_t kMostComponents = 1u << 13;
  const std::vector<Component> components = ComponentsOf(mesh);
  if (components.size() < fewest || components.size() > kMostComponents) return mesh.triangles;
  std::vector<size_t> left;  // in their order
  for (size_t c = 0; c < components.size(); ++c) left.push_back(c);
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
