// The triangles around a vertex, flattened into the plane.
#ifndef LACERTA_REMESH_FAN_CHART_H_
#define LACERTA_REMESH_FAN_CHART_H_

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "lacerta/mesh.h"

namespace lacerta {

// A point of a chart.
struct Vec2d {
  double x = 0, y = 0;
};

inline double CrossProduct(const Vec2d& a, const Vec2d& b) { return a.x * b.y - a.y * b.x; }
inline Vec2d Minus(const Vec2d& a, const Vec2d& b) { return {a.x - b.x, a.y - b.y}; }

// Twice the signed area of a triangle, above zero counterclockwise.
inline double DoubledArea(const Vec2d& a, const Vec2d& b, const Vec2d& c) { return CrossProduct(Minus(b, a), Minus(c, a)); }

// Barycentric weights of q in the triangle (a, b, c); weights below zero say that q lies outside.
inline Vec3d BarycentricIn(const Vec2d& q, const Vec2d& a, const Vec2d& b, const Vec2d& c) {
  const double area = DoubledArea(a, b, c);
  if (!(area > 0)) return {-std::numeric_limits<double>::max(), 0, 0};
  const double wb = CrossProduct(Minus(q, a), Minus(c, a)) / area;
  const double wc = CrossProduct(Minus(b, a), Minus(q, a)) / area;
  return {1 - wb - wc, wb, wc};
}

inline double MinWeight(const Vec3d& w) { return std::min({w.x, w.y, w.z}); }

// The nearest weights without one below zero, with sum one: rounding may put a point a hair outside of every triangle.
inline Vec3d ClampWeights(const Vec3d& weights) {
  const Vec3d w = {std::max(weights.x, 0.0), std::max(weights.y, 0.0), std::max(weights.z, 0.0)};
  const double sum = w.x + w.y + w.z;
  return sum > 0 ? w * (1 / sum) : Vec3d{1, 0, 0};
}

// The fan of faces around one vertex v. ring[i] are its neighbors counterclockwise; faces[i] = (v, ring[i], ring[i+1]), one less
// than neighbors where the vertex is on the border.
struct Fan {
  std::vector<uint32_t> ring;
  std::vector<uint32_t> faces;
  int curve[2] = {-1, -1};  // of a vertex on a curve: the neighbors on it, as indices into the ring

  int size() const { return static_cast<int>(ring.size()); }
  bool is_open() const { return faces.size() < ring.size(); }
};

// The ring flattened around v, which is at `center`, at the origin by the conformal map z^a of [Duchamp et al. 1997]: angles scaled to 2 pi. At a
// vertex on a curve the angles on either side of the curve are scaled to pi, so that the curve runs straight through it.
std::vector<Vec2d> FlattenFan(const Vec3d& center, const Fan& fan, const std::vector<Vec3d>& positions);

// Whether every face of the fan has area in its chart. An angle is at most the sum of the others, so flattening opens it to 180
// degrees at most, which it does at a vertex in the plane of its ring but outside of it.
bool IsStarShaped(const std::vector<Vec2d>& chart, size_t num_faces);

// The triangle of a chart in which a point lies, of those numbered up to `count` with the corners corners(i), and its weights there. By rounding in none, it is the one that it is
// least far out of.
struct PlaceInTriangles {
  int triangle = 0;
  Vec3d weights{1, 0, 0};
};
template <typename Corners>
PlaceInTriangles FindInTriangles(const Vec2d& point, int count, const Corners& corners) {
  PlaceInTriangles place;
  double best = -std::numeric_limits<double>::max();
  for (int i = 0; i < count && best < 0; ++i) {
    const std::array<Vec2d, 3> triangle = corners(i);
    const Vec3d weights = BarycentricIn(point, triangle[0], triangle[1], triangle[2]);
    if (MinWeight(weights) <= best) continue;
    best = MinWeight(weights);
    place = {i, weights};
  }
  place.weights = ClampWeights(place.weights);
  return place;
}

}  // namespace lacerta

#endif  // LACERTA_REMESH_FAN_CHART_H_
