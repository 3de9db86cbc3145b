// Triangles that lie on their neighbors.
#ifndef LACERTA_REMESH_FOLDS_H_
#define LACERTA_REMESH_FOLDS_H_

#include <array>
#include <cstdint>
#include <vector>

#include "lacerta/mesh.h"

namespace lacerta {

// Whether the two triangles of a flap (remesh/mesh_neighbors.h) lie on each other, or nearly: with less than 30 degrees between them.
// position_of: vertex -> Vec3d.
template <typename PositionOf>
bool IsFolded(const std::array<uint32_t, 4>& flap, const PositionOf& position_of) {
  constexpr double kMostCosine = -0.87;  // of their normals
  const Vec3d from = position_of(flap[0]), edge = position_of(flap[1]) - from;
  const Vec3d normal = Cross(edge, position_of(flap[2]) - from), other = Cross(position_of(flap[3]) - from, edge);
  const double cosine = Dot(normal, other);  // times both lengths
  return cosine < 0 && cosine * cosine > kMostCosine * kMostCosine * SquaredNorm(normal) * SquaredNorm(other);
}

inline bool IsFolded(const std::array<uint32_t, 4>& flap, const std::vector<Vec3f>& positions) {
  return IsFolded(flap, [&](uint32_t v) { return Vec3Cast<double>(positions[v]); });
}

}  // namespace lacerta

#endif  // LACERTA_REMESH_FOLDS_H_
