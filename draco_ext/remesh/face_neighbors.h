// Neighbors across edges, and one orientation for all of them.
#ifndef LACERTA_REMESH_FACE_NEIGHBORS_H_
#define LACERTA_REMESH_FACE_NEIGHBORS_H_

#include <cstdint>
#include <vector>

#include "lacerta/mesh.h"
#include "remesh/edge_corners.h"

namespace lacerta {

struct FaceNeighbors {
  std::vector<uint32_t> mate;  // 3 #F, the corner opposite the same edge in the neighboring face, or kNone
  std::vector<uint8_t>
      flipped;  // #F, 1: once these are turned over, mates run through their edge in opposite directions
};

// edges: GroupByEdge of the mesh. See MakeManifold for who becomes a neighbor and who is turned over.
FaceNeighbors FindNeighbors(const TriangleMesh& mesh, const EdgeCorners& edges);

}  // namespace lacerta

#endif  // LACERTA_REMESH_FACE_NEIGHBORS_H_
