#include "pack/slide_fit.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>

#include "geometry/by_vertex.h"
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

struct Wedges {
  std::vector<uint32_t> of_row;  // of the vertices of all parts, part after part
  std::vector<AttributeValue> values;
};

// Vertices of all parts that have the same position and value are one.
Wedges WedgesOf(const std::vector<const Primitive*>& primitives, const std::vector<TriangleMesh>& surfaces, const RoundedAttribute& attribute) {
  std::vector<float> rows;
  std::vector<AttributeValue> values;
  for (const RoundedAttribute::Part& part : attribute.parts) {
    const AccessorData& data = primitives[part.member]->attributes[part.index].data;
    for (uint64_t v = 0; v < data.count; ++v) {
      const Vec3f& position = surfaces[part.member].positions[v];
      rows.insert(rows.end(), {position.x, position.y, position.z});
      for (uint32_t c = 0; c < kMostComponents; ++c) rows.push_back(c < data.components ? data.Float(v, c) : 0.0f);
      values.push_back(ValueAt(data, v, attribute.direction));
    }
  }
  DistinctRows distinct = NumberRows(Span<const float>(rows), 3 + kMostComponents);
  Wedges wedges;
  for (const uint32_t row : distinct.rows) wedges.values.push_back(values[row]);
  wedges.of_row = std::move(distinct.of_row);
  return wedges;
}

// By how much the values at the corners of a triangle have to change for it.
using Slides = std::array<AttributeValue, 3>;

// u, v: two edges from the first corner; moves: of all three.
Slides SlidesOf(const std::array<uint32_t, 3>& wedges, const std::vector<AttributeValue>& values, const Vec3d& u, const Vec3d& v, const std::array<Vec3d, 3>& moves) {
  Slides slides;
  const AttributeValue along_u = values[wedges[1]] - values[wedges[0]], along_v = values[wedges[2]] - values[wedges[0]];
  for (size_t k = 0; k < 3; ++k) {
    const auto [p, q] = Within(u, v, moves[k]);
    slides[k] = p * along_u + q * along_v;
  }
  return slides;
}

// By how much each value changes so that the squares of change - slide, linear on every triangle, are least.
std::vector<AttributeValue> LeastSquares(const std::vector<std::array<uint32_t, 3>>& triangles, const std::vector<Slides>& slides, const std::vector<double>& areas,
                                         size_t num_wedges) {
  constexpr int kSweeps = 6;  // of Gauss-Seidel; a mass matrix needs few
  const ByVertex places = PlacesByVertex(triangles, num_wedges);
  std::vector<AttributeValue> changes(num_wedges);
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (size_t w = 0; w < num_wedges; ++w) {
      AttributeValue sum = {};
      double weight = 0.0;
      for (const uint32_t place : places[w]) {
        const uint32_t t = place / 3, a = (place + 1) % 3, b = (place + 2) % 3;
        const double area = areas[t];
        sum = sum + area * (2.0 * slides[t][place % 3] - (changes[triangles[t][a]] - slides[t][a]) - (changes[triangles[t][b]] - slides[t][b]));
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
  std::vector<std::array<uint32_t, 3>> triangles;  // of wedges
  std::vector<Slides> slides;
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
      triangles.push_back(of_corners);
      slides.push_back(SlidesOf(of_corners, wedges.values, u, v, moves));
      areas.push_back(area);
    }
    first_row += surface.positions.size();
  }
  const std::vector<AttributeValue> changes = LeastSquares(triangles, slides, areas, wedges.values.size());

  SlideFit fit;
  for (size_t t = 0; t < triangles.size(); ++t) {
    std::array<AttributeValue, 3> errors;
    for (size_t k = 0; k < 3; ++k) errors[k] = changes[triangles[t][k]] - slides[t][k];
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
