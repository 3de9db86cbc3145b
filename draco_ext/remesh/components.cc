#include "remesh/components.h"

#include <cstdint>
#include <vector>

#include "remesh/parity_forest.h"

namespace lacerta {

size_t CountComponents(const TriangleMesh& mesh) {
  ParityForest forest(mesh.positions.size());
  for (const Triangle& t : mesh.triangles) {
    forest.Join(t[0], t[1], 0);
    forest.Join(t[0], t[2], 0);
  }
  std::vector<uint8_t> is_counted(mesh.positions.size(), 0);
  size_t count = 0;
  for (const Triangle& t : mesh.triangles) {
    uint8_t& root = is_counted[forest.Find(t[0]).root];
    count += root == 0;
    root = 1;
  }
  return count;
}

}  // namespace lacerta
