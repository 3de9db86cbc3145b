#include "pack/slide_fit.h"

#include <algorithm>
#include <array>
#include <cstdint>

#include "geometry/equal_rows.h"
#include "pack/attribute_value.h"

namespace lacerta {
namespace {

// p u + q v is `move` within the plane of u and v. No farther than across the triangle, beyond which its values say nothing.
std::array<double, 2> Within(const Vec3d& u, const Vec3d& v, const Vec3d& move) {
  const double uu = Dot(u, u), uv = Dot(u, v), vv = Dot(v, v);
  const double mu = Dot(move, u), mv = Dot(move, v);
  const double det = uu * vv - uv * uv;
  if (!(det > 0.0)) return {0.0, 0.0};
  return {std::clamp((vv * mu - uv * mv) / det, -1.0, 1.0), std::clamp((uu * mv - uv * mu) / det, -1.0, 1.0)};
}

struct Corner {
  uint32_t wedge = 0;
  AttributeValue slide = {};  // by how much the value at the corner has to change for this triangle
};

struct Wedges {
  std::vector<uint32_t> of_row;  // of the vertices of all parts, part after part
  std::vector<AttributeValue> values;
};

// Vertices of all parts that have the same position and value are one.
Wedges WedgesOf(const std::vector<const Primitive*>& primitives, const std::vector<TriangleMesh>& surfaces, const RoundedAttribute& attribute) {
  std::vector<float> rows;
  for (const RoundedAttribute::Part& part : attribute.parts) {
    const AccessorData& data = primitives[part.member]->attributes[part.index].data;
    for (uint64_t v = 0; v < data.count; ++v) {
      const Vec3f& position = surfaces[part.member].positions[v];
      rows.insert(rows.end(), {position.x, position.y, position.z});
      for (uint32_t c = 0; c < kMostComponents; ++c) rows.push_back(c < data.components ? data.Float(v, c) : 0.0f);
    }
  }
  Wedges wedges;
  wedges.of_row = FirstEqualRow(Span<const float>(rows), 3 + kMostComponents);
  size_t row = 0;
  for (const RoundedAttribute::Part& part : attribute.parts) {
    const AccessorData& data = primitives[part.member]->attributes[part.index].data;
    for (uint64_t v = 0; v < data.count; ++v, ++row) {
      if (wedges.of_row[row] != row) {
        wedges.of_row[row] = wedges.of_row[wedges.of_row[row]];  // that of the first one, which is a wedge by now
        continue;
      }
      wedges.of_row[row] = static_cast<uint32_t>(wedges.values.size());
      wedges.values.push_back(ValueAt(data, v, attribute.direction));
    }
  }
  return wedges;
}

using Corners = std::array<Corner, 3>;

// Corners of a triangle (u and v are two edges from the first) whose vertices moved like that.
Corners CornersOf(const std::array<uint32_t, 3>& wedges, const std::vector<AttributeValue>& values, const Vec3d& u, const Vec3d& v, const std::array<Vec3d, 3>& moves) {
  Corners corners;
  const AttributeValue along_u = values[wedges[1]] - values[wedges[0]], along_v = values[wedges[2]] - values[wedges[0]];
  for (size_t k = 0; k < 3; ++k) {
    const auto [p, q] = Within(u, v, moves[k]);
    corners[k] = {wedges[k], p * along_u + q * along_v};
  }
  return corners;
}

// By how much each value changes so that the squares of change - slide, linear on every triangle, are least.
std::vector<AttributeValue> LeastSquares(const std::vector<Corners>& triangles, const std::vector<double>& areas, size_t num_wedges) {
  constexpr int kSweeps = 6;  // of Gauss-Seidel; a mass matrix needs few
  std::vector<uint32_t> first(num_wedges + 1, 0), around(3 * triangles.size());
  for (const Corners& corners : triangles) {
    for (const Corner& corner : corners) ++first[corner.wedge + 1];
  }
  for (size_t w = 0; w < num_wedges; ++w) first[w + 1] += first[w];
  std::vector<uint32_t> next = first;
  for (uint32_t i = 0; i < around.size(); ++i) around[next[triangles[i / 3][i % 3].wedge]++] = i;
  std::vector<AttributeValue> changes(num_wedges);
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (size_t w = 0; w < num_wedges; ++w) {
      AttributeValue sum = {};
      double weight = 0.0;
      for (uint32_t i = first[w]; i < first[w + 1]; ++i) {
        const Corners& corners = triangles[around[i] / 3];
        const Corner &own = corners[around[i] % 3], &a = corners[(around[i] + 1) % 3], &b = corners[(around[i] + 2) % 3];
        const double area = areas[around[i] / 3];
        sum = sum + area * (2.0 * own.slide - (changes[a.wedge] - a.slide) - (changes[b.wedge] - b.slide));
        weight += 2.0 * area;
      }
      if (weight > 0.0) changes[w] = (1.0 / weight) * sum;
    }
  }
  return changes;
}

}  // namespace

SlideFit FitToSlides(const std::vector<const Primitive*>& primitives, const std::vector<TriangleMesh>& surfaces, const RoundedAttribute& attribute,
                     const std::vector<std::vector<Vec3f>>& moved) {
  const Wedges wedges = WedgesOf(primitives, surfaces, attribute);
  std::vector<Corners> triangles;
  std::vector<double> areas;
  size_t first_row = 0;
  for (const RoundedAttribute::Part& part : attribute.parts) {
    const TriangleMesh& surface = surfaces[part.member];
    for (const Triangle& t : surface.triangles) {
      std::array<Vec3d, 3> at, moves;
      std::array<uint32_t, 3> of_corners;
      for (size_t k = 0; k < 3; ++k) {
        at[k] = Vec3Cast<double>(surface.positions[t[k]]);
        moves[k] = Vec3Cast<double>(moved[part.member][t[k]]) - at[k];
        of_corners[k] = wedges.of_row[first_row + t[k]];
      }
      const Vec3d u = at[1] - at[0], v = at[2] - at[0];
      const double area = 0.5 * Norm(Cross(u, v));
      if (!(area > 0.0)) continue;
      triangles.push_back(CornersOf(of_corners, wedges.values, u, v, moves));
      areas.push_back(area);
    }
    first_row += surface.positions.size();
  }
  const std::vector<AttributeValue> changes = LeastSquares(triangles, areas, wedges.values.size());

  SlideFit fit;
  for (size_t t = 0; t < triangles.size(); ++t) {
    std::array<AttributeValue, 3> errors;
    for (size_t k = 0; k < 3; ++k) errors[k] = changes[triangles[t][k].wedge] - triangles[t][k].slide;
    fit.squares.emplace_back(MeanSquare(errors[0], errors[1], errors[2]), areas[t]);
  }
  first_row = 0;
  for (const RoundedAttribute::Part& part : attribute.parts) {
    AccessorData data = primitives[part.member]->attributes[part.index].data;
    for (uint64_t v = 0; v < data.count; ++v) {
      const uint32_t w = wedges.of_row[first_row + v];
      if (changes[w] != AttributeValue{}) StoreValue(wedges.values[w] + changes[w], attribute.direction ? 3 : data.components, v, &data);
    }
    first_row += data.count;
    fit.values.push_back(std::move(data));
  }
  return fit;
}

}  // namespace lacerta
