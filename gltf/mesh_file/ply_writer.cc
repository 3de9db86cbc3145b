#include <cstring>
#include <string>

#include "mesh_file/writers.h"

namespace lacerta {
namespace {

void AppendUint32(uint32_t value, Bytes* bytes) {
  for (int shift = 0; shift < 32; shift += 8) bytes->push_back(static_cast<uint8_t>(value >> shift));
}

}  // namespace

Bytes FormatPly(const TriangleMesh& mesh) {
  const std::string header =
      "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(mesh.positions.size()) +
      "\nproperty float x\nproperty float y\nproperty float z\nelement face " + std::to_string(mesh.triangles.size()) +
      "\nproperty list uchar uint vertex_indices\nend_header\n";
  Bytes bytes(header.begin(), header.end());
  bytes.reserve(bytes.size() + 12 * mesh.positions.size() + 13 * mesh.triangles.size());
  for (const Vec3f& position : mesh.positions) {
    for (const float value : {position.x, position.y, position.z}) {
      uint32_t bits;
      std::memcpy(&bits, &value, sizeof(bits));
      AppendUint32(bits, &bytes);
    }
  }
  for (const Triangle& triangle : mesh.triangles) {
    bytes.push_back(3);
    for (const uint32_t index : triangle) AppendUint32(index, &bytes);
  }
  return bytes;
}

}  // namespace lacerta
