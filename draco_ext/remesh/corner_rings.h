// The triangles around each vertex while collapses join vertices and remove triangles.
#ifndef LACERTA_REMESH_CORNER_RINGS_H_
#define LACERTA_REMESH_CORNER_RINGS_H_

#include <algorithm>
#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "lacerta/mesh.h"

namespace lacerta {

// The corners 3 t + k of each vertex as a ring, so that those of two vertices are joined at once.
class CornerRings {
 public:
  static constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();

  CornerRings(size_t num_vertices, const std::vector<Triangle>& triangles)
      : next_(3 * triangles.size()), first_(num_vertices, kNone) {
    for (uint32_t corner = 0; corner < next_.size(); ++corner) {
      uint32_t& first = first_[triangles[corner / 3][corner % 3]];
      next_[corner] = first == kNone ? corner : next_[first];
      if (first != kNone) next_[first] = corner;
      first = corner;
    }
  }

  bool is_empty(uint32_t v) const { return first_[v] == kNone; }

  // The corners of v whose triangles are not `dead`; forgets the others.
  void Collect(uint32_t v, const std::vector<uint8_t>& dead, std::vector<uint32_t>* corners) {
    corners->clear();
    if (first_[v] == kNone) return;
    const uint32_t last = first_[v];
    uint32_t first_kept = kNone, last_kept = kNone, corner = last;
    do {
      corner = next_[corner];
      if (dead[corner / 3]) continue;
      if (first_kept == kNone) first_kept = corner;
      if (last_kept != kNone) next_[last_kept] = corner;
      last_kept = corner;
      corners->push_back(corner);
    } while (corner != last);
    if (last_kept != kNone) next_[last_kept] = first_kept;
    first_[v] = last_kept;
  }

  // The corners of `removed` become corners of `kept`; neither is empty.
  void Join(uint32_t kept, uint32_t removed) {
    std::swap(next_[first_[kept]], next_[first_[removed]]);
    first_[removed] = kNone;
  }

 private:
  std::vector<uint32_t> next_, first_;
};

// Whether a triangle with the corner `before` and the others a and b turns over, or becomes a needle, when that corner moves to `after`.
inline bool TurnsOver(const Vec3d& before, const Vec3d& after, const Vec3d& a, const Vec3d& b) {
  constexpr double kMinNormalCosine = 0.2;  // between the triangle and what it was before
  const Vec3d old_normal = Cross(a - before, b - before), new_normal = Cross(a - after, b - after);
  const double old_size = Norm(old_normal), new_size = Norm(new_normal);
  const double longest = std::max({SquaredNorm(a - after), SquaredNorm(b - after), SquaredNorm(b - a)});
  if (new_size < 1e-3 * longest && new_size < old_size) return true;  // a needle where there was a better triangle
  return Dot(old_normal, new_normal) < kMinNormalCosine * old_size * new_size;
}

}  // namespace lacerta

#endif  // LACERTA_REMESH_CORNER_RINGS_H_
