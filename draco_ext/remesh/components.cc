#include "remesh/components.h"

#include <limits>

#include "remesh/parity_forest.h"

namespace lacerta {
namespace {

// Of the vertices, joined by the triangles.
ParityForest JoinedByTriangles(const TriangleMesh& mesh) {
  ParityForest forest(mesh.positions.size());
  for (const Triangle& t : mesh.triangles) {
    forest.Join(t[0], t[1], 0);
    forest.Join(t[0], t[2], 0);
  }
  return forest;
}

}  // namespace

size_t CountComponents(const TriangleMesh& mesh) {
  ParityForest forest = JoinedByTriangles(mesh);
  std::vector<uint8_t> is_counted(mesh.positions.size(), 0);
  size_t count = 0;
  for (const Triangle& t : mesh.triangles) {
    uint8_t& root = is_counted[forest.Find(t[0]).root];
    count += root == 0;
    root = 1;
  }
  return count;
}

std::vector<uint32_t> FindComponents(const TriangleMesh& mesh) {
  ParityForest forest = JoinedByTriangles(mesh);
  constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();
  std::vector<uint32_t> of_root(mesh.positions.size(), kNone), components;
  components.reserve(mesh.triangles.size());
  uint32_t count = 0;
  for (const Triangle& t : mesh.triangles) {
    uint32_t& component = of_root[forest.Find(t[0]).root];
    if (component == kNone) component = count++;
    components.push_back(component);
  }
  return components;
}

}  // namespace lacerta
