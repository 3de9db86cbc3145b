// Whether a surface leaves what a vertex of it stands for. A tip of little area that gets shorter is nothing in the mean, and the tip stays on the input.
#ifndef LACERTA_REMESH_RETREAT_H_
#define LACERTA_REMESH_RETREAT_H_

#include <cstdint>
#include <vector>

#include "geometry/closest_on_triangle.h"
#include "lacerta/mesh.h"
#include "remesh/mesh_neighbors.h"

namespace lacerta {

// Whether `place`, where vertex v was, is farther than `most` from all its triangles. most: 0 for any.
// position_of: vertex -> Vec3d.
template <typename PositionOf>
bool HasRetreated(const Vec3d& place, uint32_t v, const std::vector<Triangle>& triangles, const MeshNeighbors& neighbors, double most,
                  const PositionOf& position_of) {
  if (most == 0 || SquaredNorm(position_of(v) - place) <= most * most) return false;
  for (const uint32_t f : neighbors.vertex_faces[v]) {
    const Triangle& t = triangles[f];
    ClosestWeights closest;
    if (ClosestOnTriangle(place, position_of(t[0]), position_of(t[1]), position_of(t[2]), most * most, &closest) && closest.squared_distance <= most * most) return false;
  }
  return true;
}

}  // namespace lacerta

#endif  // LACERTA_REMESH_RETREAT_H_
