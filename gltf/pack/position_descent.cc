#include "pack/position_descent.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

#include "geometry/equal_rows.h"
#include "pack/for_each_near.h"
#include "pack/lattice_points.h"

namespace lacerta {
namespace {

constexpr size_t kAxes = 3;

ValueWedges Joined(const std::vector<TriangleMesh>& surfaces) {
  std::vector<float> rows;
  for (const TriangleMesh& surface : surfaces) {
    for (const Vec3f& position : surface.positions) rows.insert(rows.end(), {position.x, position.y, position.z});
  }
  DistinctRows distinct = NumberRows(Span<const float>(rows), kAxes);
  ValueWedges wedges;
  for (const size_t v : distinct.rows) wedges.positions.push_back({rows[kAxes * v], rows[kAxes * v + 1], rows[kAxes * v + 2]});
  wedges.of_vertex = std::move(distinct.of_row);
  uint32_t base = 0;
  for (const TriangleMesh& surface : surfaces) {
    for (const Triangle& t : surface.triangles) AddTriangle({wedges.of_vertex[base + t[0]], wedges.of_vertex[base + t[1]], wedges.of_vertex[base + t[2]]}, surface, t, &wedges);
    base += static_cast<uint32_t>(surface.positions.size());
  }
  wedges.corners = PlacesByVertex(wedges.triangles, wedges.size());
  return wedges;
}

// Whether there is another point like it.
std::vector<char> AreShared(const std::vector<LatticePoint>& points) {
  std::vector<int32_t> rows;
  for (const LatticePoint& point : points) rows.insert(rows.end(), {point[0], point[1], point[2]});
  const std::vector<uint32_t> first = FirstEqualRow(Span<const int32_t>(rows), kAxes);
  std::vector<char> shared(points.size(), 0);
  for (uint32_t v = 0; v < first.size(); ++v) {
    if (first[v] != v) shared[v] = shared[first[v]] = 1;
  }
  return shared;
}

}  // namespace

struct PositionDescent::Vertices {
  std::vector<LatticePoint> points;
  std::vector<Vec3d> moves;  // from where they should be
};

PositionDescent::PositionDescent(const std::vector<TriangleMesh>& surfaces) : wedges_(Joined(surfaces)), prediction_(wedges_, {0, 1, 2}) {
  for (const TriangleMesh& surface : surfaces) sizes_.push_back(surface.positions.size());
  for (const std::array<uint32_t, 3>& t : wedges_.triangles) {
    normals_.push_back(Normalized(Cross(wedges_.positions[t[1]] - wedges_.positions[t[0]], wedges_.positions[t[2]] - wedges_.positions[t[0]])));
  }
  for (const double area : wedges_.areas) area_ += area;
}

std::vector<std::vector<Vec3f>> PositionDescent::On(const Lattice& lattice) const {
  constexpr int kSweeps = 3;
  constexpr double kSlope = 0.02;  // what a bit of a vertex is worth, in squared steps
  const LatticeNumbers numbers(lattice, static_cast<uint32_t>(kAxes), false);
  Vertices vertices;
  for (const Vec3d& position : wedges_.positions) {
    vertices.points.push_back(numbers.Nearest({position.x, position.y, position.z, 0.0}));
    const AttributeValue value = numbers.Stored(vertices.points.back());
    vertices.moves.push_back(Vec3d{value[0], value[1], value[2]} - position);
  }
  const std::vector<char> stands = AreShared(vertices.points);  // what comes together there is coded as one vertex, and triangles in between are not
  const double slope = kSlope * numbers.step() * numbers.step() * area_ / std::max(1.0, static_cast<double>(wedges_.size()));
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    ResidualCosts costs;
    prediction_.Count(vertices.points, &costs);
    costs.Settle();
    for (size_t w = 0; w < wedges_.size(); ++w) {
      if (stands[w] == 0) Move(w, numbers, slope, costs, &vertices);
    }
  }
  std::vector<std::vector<Vec3f>> moved;
  size_t v = 0;
  for (const size_t size : sizes_) {
    moved.emplace_back();
    for (const size_t end = v + size; v < end; ++v) {
      const LatticePoint& point = vertices.points[wedges_.of_vertex[v]];
      moved.back().push_back({lattice.At(point[0], 0), lattice.At(point[1], 1), lattice.At(point[2], 2)});
    }
  }
  return moved;
}

// Area vector of a triangle, twice, with the vertex w moved like that.
Vec3d PositionDescent::AreaWith(const std::array<uint32_t, 3>& triangle, size_t w, const Vec3d& move, const Vertices& vertices) const {
  std::array<Vec3d, 3> at;
  for (size_t k = 0; k < 3; ++k) at[k] = wedges_.positions[triangle[k]] + (triangle[k] == w ? move : vertices.moves[triangle[k]]);
  return Cross(at[1] - at[0], at[2] - at[0]);
}

void PositionDescent::Move(size_t w, const LatticeNumbers& lattice, double slope, const ResidualCosts& costs, Vertices* vertices) const {
  constexpr double kSlide = 0.25;  // of what moves within the surface, and takes attributes with it, beside what leaves it
  constexpr double kCorners = 6.0;
  struct Side {
    uint32_t triangle;
    double share;   // of its area
    double others;  // moves of its other corners along its normal
    bool is_turned;
  };
  std::vector<Side> sides;
  for (const uint32_t place : wedges_.corners[w]) {
    const uint32_t triangle = place / 3, corner = place % 3;
    const std::array<uint32_t, 3>& t = wedges_.triangles[triangle];
    const Vec3d& normal = normals_[triangle];
    const double others = Dot(normal, vertices->moves[t[(corner + 1) % 3]] + vertices->moves[t[(corner + 2) % 3]]);
    sides.push_back({triangle, wedges_.areas[triangle] / kCorners, others, !(Dot(AreaWith(t, w, vertices->moves[w], *vertices), normal) > 0.0)});
  }
  const auto bits = prediction_.BitsNear(w, vertices->points, costs);
  const LatticePoint now = vertices->points[w];
  LatticePoint best = now;
  Vec3d best_move = vertices->moves[w];
  double least = std::numeric_limits<double>::infinity();
  ForEachNear(now, static_cast<uint32_t>(kAxes), 1, [&](const LatticePoint& point) {
    const std::optional<AttributeValue> value = lattice.At(point);
    if (!value.has_value()) return;
    const Vec3d move = Vec3d{(*value)[0], (*value)[1], (*value)[2]} - wedges_.positions[w];
    if (point != now && std::max({std::fabs(move.x), std::fabs(move.y), std::fabs(move.z)}) > lattice.step()) return;
    double distortion = 0.0;
    for (const Side& side : sides) {
      const double along = Dot(normals_[side.triangle], move);
      distortion += side.share * (along * along + along * side.others + kSlide * Dot(move, move));
    }
    if (distortion >= least) return;
    const double cost = distortion + slope * bits(point);
    if (cost >= least) return;
    const auto turns = [&](const Side& side) {
      return !side.is_turned && !(Dot(AreaWith(wedges_.triangles[side.triangle], w, move, *vertices), normals_[side.triangle]) > 0.0);
    };
    if (point != now && std::any_of(sides.begin(), sides.end(), turns)) return;
    least = cost;
    best = point;
    best_move = move;
  });
  vertices->points[w] = best;
  vertices->moves[w] = best_move;
}

}  // namespace lacerta
