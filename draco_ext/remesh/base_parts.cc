#include "remesh/base_parts.h"

#include <array>
#include <map>

#include "common/base_tags.h"

namespace lacerta {

TriangleMesh Together(TriangleMesh a, const TriangleMesh& b) {
  const auto offset = static_cast<uint32_t>(a.positions.size());
  a.positions.insert(a.positions.end(), b.positions.begin(), b.positions.end());
  for (const Triangle& t : b.triangles) a.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  return a;
}

std::vector<uint32_t> JoinedVertices(const std::vector<Vec3f>& positions) {
  std::map<std::array<float, 3>, uint32_t> first;
  std::vector<uint32_t> joined;
  joined.reserve(positions.size());
  for (const Vec3f& p : positions) {
    joined.push_back(first.emplace(std::array<float, 3>{p.x, p.y, p.z}, static_cast<uint32_t>(joined.size())).first->second);
  }
  return JoinsAnything(joined) ? joined : std::vector<uint32_t>();
}

}  // namespace lacerta
