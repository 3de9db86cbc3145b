// Triangles that lie on their neighbors.
#ifndef LACERTA_REMESH_FOLDS_H_
#define LACERTA_REMESH_FOLDS_H_

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "lacerta/mesh.h"

namespace lacerta {

// Whether triangles with these normals, of any length, on either side of an edge lie on each other, or nearly: with less than 30 degrees between them.
inline bool AreFolded(const Vec3d& normal, const Vec3d& other) {
  constexpr double kMostCosine = -0.87;
  const double cosine = Dot(normal, other);  // times both lengths
  return cosine < 0 && cosine * cosine > kMostCosine * kMostCosine * SquaredNorm(normal) * SquaredNorm(other);
}

// Whether the two triangles of a flap (remesh/mesh_neighbors.h) do.
// position_of: vertex -> Vec3d.
template <typename PositionOf>
bool IsFolded(const std::array<uint32_t, 4>& flap, const PositionOf& position_of) {
  const Vec3d from = position_of(flap[0]), edge = position_of(flap[1]) - from;
  const Vec3d normal = Cross(edge, position_of(flap[2]) - from), other = Cross(position_of(flap[3]) - from, edge);
  return AreFolded(normal, other);
}

inline bool IsFolded(const std::array<uint32_t, 4>& flap, const std::vector<Vec3f>& positions) {
  return IsFolded(flap, [&](uint32_t v) { return Vec3Cast<double>(positions[v]); });
}

// The triangles around a vertex, gathered by the edges there.
class FoldedSpokes {
 public:
  // A triangle of the vertex with the corners next and previous, counterclockwise, and its area vector, doubled.
  void Add(uint32_t next, uint32_t previous, const Vec3d& area) {
    spokes_.push_back({next, true, area});
    spokes_.push_back({previous, false, area});
  }

  // The area over which triangles at edges of two lie on each other; forgets them all. Triangles may be oriented in any way.
  double TakeArea() {
    std::sort(spokes_.begin(), spokes_.end(), [](const Spoke& a, const Spoke& b) { return a.end < b.end; });
    double folded = 0;
    for (size_t i = 0; i < spokes_.size();) {
      size_t end = i + 1;
      while (end < spokes_.size() && spokes_[end].end == spokes_[i].end) ++end;
      if (end - i == 2) {
        const Spoke &a = spokes_[i], &b = spokes_[i + 1];
        if (AreFolded(a.area, a.leaves == b.leaves ? -b.area : b.area)) folded += std::min(Norm(a.area), Norm(b.area)) / 2;
      }
      i = end;
    }
    spokes_.clear();
    return folded;
  }

 private:
  struct Spoke {
    uint32_t end;
    bool leaves;  // the triangle goes from the vertex to the end
    Vec3d area;
  };
  std::vector<Spoke> spokes_;
};

}  // namespace lacerta

#endif  // LACERTA_REMESH_FOLDS_H_
