#include "shapes/attributed_shapes.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "shapes/shapes.h"

namespace lacerta::shapes {
namespace {

constexpr float kPi = 3.14159265f;

VertexSoup WithTextureAndNormals() {
  VertexSoup soup;
  soup.attributes = {{"TEXCOORD_0", AttributeKind::kTextureCoordinates, 2, {}}, {"NORMAL", AttributeKind::kNormal, 3, {}}};
  return soup;
}

void AddVertex(const Vec3f& position, float u, float v, const Vec3f& normal, VertexSoup* soup) {
  soup->positions.push_back(position);
  soup->attributes[0].values.insert(soup->attributes[0].values.end(), {u, v});
  soup->attributes[1].values.insert(soup->attributes[1].values.end(), {normal.x, normal.y, normal.z});
}

// nx x ny squares on vertices that begin at `first`, row after row.
void AddSquares(int nx, int ny, uint32_t first, VertexSoup* soup) {
  const auto width = static_cast<uint32_t>(nx + 1);
  for (uint32_t j = 0; j < static_cast<uint32_t>(ny); ++j) {
    for (uint32_t i = 0; i < static_cast<uint32_t>(nx); ++i) {
      const uint32_t a = first + j * width + i;
      soup->triangles.push_back({a, a + 1, a + width + 1});
      soup->triangles.push_back({a, a + width + 1, a + width});
    }
  }
}

}  // namespace

VertexSoup Cylinder(int around, int up) {
  VertexSoup soup = WithTextureAndNormals();
  for (int j = 0; j <= up; ++j) {
    for (int i = 0; i <= around; ++i) {
      const float u = static_cast<float>(i) / static_cast<float>(around), v = static_cast<float>(j) / static_cast<float>(up);
      const float angle = 2 * kPi * static_cast<float>(i % around) / static_cast<float>(around);
      const Vec3f out{std::cos(angle), std::sin(angle), 0};
      AddVertex({out.x, out.y, 2 * kPi * v}, u, v, out, &soup);
    }
  }
  AddSquares(around, up, 0, &soup);
  return soup;
}

VertexSoup TexturedGrid(int nx, int ny, float height) {
  VertexSoup soup = WithTextureAndNormals();
  for (int j = 0; j <= ny; ++j) {
    for (int i = 0; i <= nx; ++i) {
      const float x = static_cast<float>(i) / static_cast<float>(nx), y = static_cast<float>(j) / static_cast<float>(ny);
      const float z = height * std::sin(kPi * x) * std::sin(kPi * y);
      const Vec3f normal{-height * kPi * std::cos(kPi * x) * std::sin(kPi * y), -height * kPi * std::sin(kPi * x) * std::cos(kPi * y), 1};
      AddVertex({x, y, z}, x, y, Normalized(normal), &soup);
    }
  }
  AddSquares(nx, ny, 0, &soup);
  return soup;
}

VertexSoup TexturedBox(int n) {
  VertexSoup soup = WithTextureAndNormals();
  for (int axis = 0; axis < 3; ++axis) {
    for (int side = 0; side < 2; ++side) {
      const auto first = static_cast<uint32_t>(soup.positions.size());
      Vec3f normal;
      normal[axis] = side == 0 ? -1.0f : 1.0f;
      const int first_axis = side == 0 ? (axis + 2) % 3 : (axis + 1) % 3;  // so that squares turn around the normal
      const int second_axis = 3 - axis - first_axis;
      for (int j = 0; j <= n; ++j) {
        for (int i = 0; i <= n; ++i) {
          Vec3f p;
          p[axis] = static_cast<float>(side);
          p[first_axis] = static_cast<float>(i) / static_cast<float>(n);
          p[second_axis] = static_cast<float>(j) / static_cast<float>(n);
          AddVertex(p, p[first_axis], p[second_axis], normal, &soup);
        }
      }
      AddSquares(n, n, first, &soup);
    }
  }
  return soup;
}

}  // namespace lacerta::shapes
