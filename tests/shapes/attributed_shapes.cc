#include "shapes/attributed_shapes.h"

#include <algorithm>
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

SkinnedSoup SkinnedCylinder(int around, int up) {
  SkinnedSoup result{Cylinder(around, up), {}, {}};
  constexpr float kBlend = 0.2f * 2 * kPi;
  const auto after = [&](float z, float joint) {  // 0 below it, 1 above
    const float t = std::min(std::max((z - joint * 2 * kPi / 3) / kBlend + 0.5f, 0.0f), 1.0f);
    return t * t * (3 - 2 * t);
  };
  for (const Vec3f& p : result.soup.positions) {
    const float second = after(p.z, 1), third = after(p.z, 2);
    result.joints.insert(result.joints.end(), {0, 1, 2, 0});
    result.weights.insert(result.weights.end(), {1 - second, second * (1 - third), second * third, 0});
  }
  return result;
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

AttributedMesh ThickSheet(float height) {
  VertexSoup front = TexturedGrid(10, 10), back = front;
  for (Vec3f& p : front.positions) p.z = height;
  for (Triangle& t : back.triangles) std::swap(t[1], t[2]);
  for (VertexSoup::Attribute& attribute : back.attributes) {
    if (attribute.kind != AttributeKind::kNormal) continue;
    for (float& n : attribute.values) n = -n;
  }
  AttributedMesh mesh = WeldSoups({front, back}).value();
  mesh.groups.assign(mesh.surface.triangles.size(), 0);
  return mesh;
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

std::vector<VertexSoup> BoxOfTwoGroups(int n) {
  VertexSoup one = TexturedBox(n), rest = one;
  const size_t side = one.triangles.size() / 6;
  one.triangles.resize(side);
  rest.triangles.erase(rest.triangles.begin(), rest.triangles.begin() + static_cast<std::ptrdiff_t>(side));
  VertexSoup::Attribute color{"COLOR_0", AttributeKind::kColor, 3, {}};
  for (const Vec3f& p : one.positions) color.values.insert(color.values.end(), {p.x, p.y, p.z});
  one.attributes.push_back(std::move(color));
  return {std::move(one), std::move(rest)};
}

std::vector<VertexSoup> HalvedTorus(int around, int tube) {
  std::vector<VertexSoup> halves;
  for (int half = 0; half < 2; ++half) {
    VertexSoup& soup = halves.emplace_back(WithTextureAndNormals());
    const int columns = around / 2;
    for (int j = 0; j <= tube; ++j) {
      for (int i = half * columns; i <= (half + 1) * columns; ++i) {
        const float u = 2 * kPi * static_cast<float>(i % around) / static_cast<float>(around);
        const float v = 2 * kPi * static_cast<float>(j % tube) / static_cast<float>(tube);
        const Vec3f normal{std::cos(u) * std::cos(v), std::sin(u) * std::cos(v), std::sin(v)};
        const Vec3f p = Vec3f{std::cos(u), std::sin(u), 0} + normal * 0.4f;
        AddVertex(p, static_cast<float>(i) / static_cast<float>(around), static_cast<float>(j) / static_cast<float>(tube), normal, &soup);
      }
    }
    AddSquares(columns, tube, 0, &soup);
  }
  return halves;
}

VertexSoup SlitGrid(int n, float height) {
  VertexSoup soup = TexturedGrid(n, n, height);
  const int middle = n / 2;
  const auto width = static_cast<size_t>(n + 1);
  for (int i = n / 4 + 1; i < n - n / 4; ++i) {
    const size_t old = static_cast<size_t>(middle) * width + static_cast<size_t>(i);
    const auto copy = static_cast<uint32_t>(soup.positions.size());
    soup.positions.push_back(soup.positions[old]);
    for (VertexSoup::Attribute& a : soup.attributes) {
      for (size_t c = 0; c < a.components; ++c) a.values.push_back(a.values[old * a.components + c]);
    }
    const float along = 4 * (static_cast<float>(i) / static_cast<float>(n) - 0.25f) - 1;  // -1 to 1
    soup.attributes[0].values.back() += 0.1f * (1 - along * along);
    for (size_t f = static_cast<size_t>(2 * n * middle); f < static_cast<size_t>(2 * n * (middle + 1)); ++f) {
      for (uint32_t& v : soup.triangles[f]) {
        if (v == old) v = copy;
      }
    }
  }
  return soup;
}

VertexSoup Unwelded(const VertexSoup& soup, float noise) {
  VertexSoup result;
  for (const VertexSoup::Attribute& attribute : soup.attributes) result.attributes.push_back({attribute.name, attribute.kind, attribute.components, {}});
  uint32_t state = 1;
  for (const Triangle& t : soup.triangles) {
    const auto first = static_cast<uint32_t>(result.positions.size());
    result.triangles.push_back({first, first + 1, first + 2});
    for (const uint32_t v : t) {
      result.positions.push_back(soup.positions[v]);
      for (size_t a = 0; a < soup.attributes.size(); ++a) {
        for (uint32_t c = 0; c < soup.attributes[a].components; ++c) {
          state = state * 1664525 + 1013904223;
          const float offset = noise * (static_cast<float>(state >> 8) / 8388608.0f - 1.0f);
          result.attributes[a].values.push_back(soup.attributes[a].values[v * soup.attributes[a].components + c] + offset);
        }
      }
    }
  }
  return result;
}

}  // namespace lacerta::shapes
