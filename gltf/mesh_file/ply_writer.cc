#include <cstring>
#include <string>
#include <type_traits>

#include "mesh_file/writers.h"

namespace lacerta {
namespace {

// Little endian.
template <typename Number>
void AppendBits(Number number, Bytes* bytes) {
  std::conditional_t<sizeof(number) == 8, uint64_t, uint32_t> bits;
  std::memcpy(&bits, &number, sizeof(bits));
  for (size_t i = 0; i < sizeof(bits); ++i) bytes->push_back(static_cast<uint8_t>(bits >> (8 * i)));
}

}  // namespace

Bytes FormatPly(const TriangleMesh& mesh, const Vec3d& origin) {
  const bool is_far = origin != Vec3d{};
  const std::string real = is_far ? "double" : "float";
  const std::string header =
      "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(mesh.positions.size()) +
      "\nproperty " + real + " x\nproperty " + real + " y\nproperty " + real + " z\nelement face " + std::to_string(mesh.triangles.size()) +
      "\nproperty list uchar uint vertex_indices\nend_header\n";
  Bytes bytes(header.begin(), header.end());
  bytes.reserve(bytes.size() + 12 * mesh.positions.size() + 13 * mesh.triangles.size());
  for (const Vec3f& position : mesh.positions) {
    for (int axis = 0; axis < 3; ++axis) {
      if (is_far) {
        AppendBits(position[axis] + origin[axis], &bytes);
      } else {
        AppendBits(position[axis], &bytes);
      }
    }
  }
  for (const Triangle& triangle : mesh.triangles) {
    bytes.push_back(3);
    for (const uint32_t index : triangle) AppendBits(index, &bytes);
  }
  return bytes;
}

}  // namespace lacerta
