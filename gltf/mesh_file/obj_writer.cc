#include <charconv>
#include <string>

#include "mesh_file/writers.h"

namespace lacerta {
namespace {

template <typename Number>
void AppendNumber(Number number, std::string* text) {
  char digits[32];
  const auto result = std::to_chars(digits, digits + sizeof(digits), number);
  text->push_back(' ');
  text->append(digits, result.ptr);
}

}  // namespace

Bytes FormatObj(const TriangleMesh& mesh, const Vec3d& origin) {
  std::string text;
  const bool is_far = origin != Vec3d{};
  for (const Vec3f& position : mesh.positions) {
    text.push_back('v');
    for (int axis = 0; axis < 3; ++axis) {
      if (is_far) {
        AppendNumber(position[axis] + origin[axis], &text);
      } else {
        AppendNumber(position[axis], &text);
      }
    }
    text.push_back('\n');
  }
  for (const Triangle& triangle : mesh.triangles) {
    text.push_back('f');
    for (const uint32_t index : triangle) AppendNumber(uint64_t{index} + 1, &text);
    text.push_back('\n');
  }
  return Bytes(text.begin(), text.end());
}

}  // namespace lacerta
