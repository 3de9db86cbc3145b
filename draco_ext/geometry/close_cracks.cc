#include "geometry/close_cracks.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <unordered_map>

#include "geometry/vertex_ranges.h"
#include "lacerta/surface_distance.h"

namespace lacerta {
namespace {

constexpr double kWidestCrack = 1.0 / (1 << 20);  // of the diagonal

constexpr uint64_t kEdgesAtATime = 4'000'000;

// The edges whose lower end is in a range, once for each of their triangles, as (lower end) 2^32 + higher end, in ascending order.
std::vector<uint64_t> EdgesOf(const std::vector<Triangle>& triangles, const VertexRange& range) {
  std::vector<uint64_t> edges;
  for (const Triangle& t : triangles) {
    for (int k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax(t[k], t[(k + 1) % 3]);
      if (range.Has(low)) edges.push_back(uint64_t{low} << 32 | high);
    }
  }
  std::sort(edges.begin(), edges.end());
  return edges;
}

// The ends of edges that are not of two triangles, in ascending order.
std::vector<uint32_t> BorderVertices(const TriangleMesh& mesh) {
  const auto for_each_edge = [&](const auto& visit) {
    for (const Triangle& t : mesh.triangles) {
      for (int k = 0; k < 3; ++k) visit(std::min(t[k], t[(k + 1) % 3]));
    }
  };
  std::vector<uint32_t> vertices;
  for (const VertexRange& range : CutVertices(static_cast<uint32_t>(mesh.positions.size()), kEdgesAtATime, for_each_edge)) {
    const std::vector<uint64_t> edges = EdgesOf(mesh.triangles, range);
    for (size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
      while (end < edges.size() && edges[end] == edges[begin]) ++end;
      if (end - begin != 2)
        vertices.insert(vertices.end(), {static_cast<uint32_t>(edges[begin] >> 32), static_cast<uint32_t>(edges[begin])});
    }
  }
  std::sort(vertices.begin(), vertices.end());
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  return vertices;
}

// Points in cubes of twice a distance: those nearer than it are in the eight cubes around.
class NearPoints {
 public:
  NearPoints(const std::vector<Vec3f>& positions, Vec3f origin, double distance)
      : positions_(positions), origin_(origin), distance_(distance) {}

  void Add(uint32_t v) { cubes_[Cube(v, {0, 0, 0})].push_back(v); }

  // The nearest point within the distance of v, or v.
  uint32_t NearestTo(uint32_t v) const {
    uint32_t nearest = v;
    double least = distance_ * distance_;
    for (int i = 0; i < 8; ++i) {
      const auto cube = cubes_.find(Cube(v, {i & 1 ? 0.5 : -0.5, i & 2 ? 0.5 : -0.5, i & 4 ? 0.5 : -0.5}));
      if (cube == cubes_.end()) continue;
      for (const uint32_t u : cube->second) {
        const Vec3f to = positions_[u] - positions_[v];
        const double squared = Dot(to, to);
        if (squared > least || (squared == least && nearest != v)) continue;
        least = squared;
        nearest = u;
      }
    }
    return nearest;
  }

 private:
  uint64_t Cube(uint32_t v, const std::array<double, 3>& shift) const {
    constexpr int kBits = 21;  // the box is 2^19 cubes wide at most, in either direction
    uint64_t cube = 0;
    for (int c = 0; c < 3; ++c) {
      const double at = (double{positions_[v][c]} - origin_[c]) / (2 * distance_) + shift[c];
      cube = cube << kBits | (static_cast<uint64_t>(static_cast<int64_t>(std::floor(at))) & ((1u << kBits) - 1));
    }
    return cube;
  }

  const std::vector<Vec3f>& positions_;
  const Vec3f origin_;
  const double distance_;
  std::unordered_map<uint64_t, std::vector<uint32_t>> cubes_;
};

}  // namespace

std::vector<uint32_t> VerticesWithoutCracks(const TriangleMesh& mesh) {
  std::vector<uint32_t> result(mesh.positions.size());
  std::iota(result.begin(), result.end(), 0u);
  const std::vector<uint32_t> border = BorderVertices(mesh);
  const double widest = kWidestCrack * BoundingBoxDiagonal(mesh);
  if (border.empty() || widest == 0) return result;
  NearPoints kept(mesh.positions, mesh.positions[border[0]], widest);
  for (const uint32_t v : border) {
    result[v] = kept.NearestTo(v);
    if (result[v] == v) kept.Add(v);
  }
  return result;
}

}  // namespace lacerta
