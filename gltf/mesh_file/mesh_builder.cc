#include "mesh_file/mesh_builder.h"

#include <cmath>
#include <limits>

namespace lacerta {

Status AppendPosition(double x, double y, double z, const PositionRules& rules, TriangleMesh* mesh) {
  constexpr double kLargest = std::numeric_limits<float>::max();
  for (const double value : {x, y, z}) {
    if (!(std::abs(value) <= kLargest)) {  // written so that NaN fails
      if (rules.keep_not_finite) {
        constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
        mesh->positions.push_back({kNan, kNan, kNan});
        return Status();
      }
      return InvalidData("vertex " + std::to_string(mesh->positions.size()) + ": coordinate " + std::to_string(value) +
                         " is not a finite 32-bit float; repair or remove the vertex");
    }
  }
  mesh->positions.push_back(Vec3Cast<float>(Vec3d{x, y, z} - rules.origin));
  return Status();
}

Status AppendPolygon(const std::vector<int64_t>& corners, uint64_t num_vertices, uint64_t face, TriangleMesh* mesh) {
  const std::string name = "face " + std::to_string(face);
  if (corners.size() < 3) {
    return InvalidData(name + ": has " + std::to_string(corners.size()) + " corners, at least 3 are needed; remove it");
  }
  for (const int64_t corner : corners) {
    if (corner < 0 || static_cast<uint64_t>(corner) >= num_vertices || corner > std::numeric_limits<uint32_t>::max()) {
      return InvalidData(name + ": vertex index " + std::to_string(corner) + " is out of range, the file has " +
                         std::to_string(num_vertices) + " vertices (counted from 0)");
    }
  }
  for (size_t i = 2; i < corners.size(); ++i) {
    mesh->triangles.push_back(
        {static_cast<uint32_t>(corners[0]), static_cast<uint32_t>(corners[i - 1]), static_cast<uint32_t>(corners[i])});
  }
  return Status();
}

Status CheckNotEmpty(const TriangleMesh& mesh) {
  if (!mesh.triangles.empty()) return Status();
  return Unsupported("holds no faces (" + std::to_string(mesh.positions.size()) + " vertices); a surface is needed");
}

Status CheckCount(uint64_t count, uint64_t bytes_each, uint64_t available, const std::string& what) {
  if (bytes_each == 0 || count <= available / bytes_each) return Status();
  return InvalidData("the header announces " + std::to_string(count) + " " + what + ", but only " +
                     std::to_string(available) + " bytes follow it; the file is truncated or damaged");
}

}  // namespace lacerta
