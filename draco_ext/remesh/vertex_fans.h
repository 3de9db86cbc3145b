// One vertex for every fan of neighboring faces.
#ifndef LACERTA_REMESH_VERTEX_FANS_H_
#define LACERTA_REMESH_VERTEX_FANS_H_

#include <cstdint>
#include <vector>

#include "lacerta/mesh.h"
#include "remesh/edge_corners.h"

namespace lacerta {

struct VertexFans {
  std::vector<uint32_t> vertex;  // 3 #F, the new vertex of each corner
  std::vector<uint32_t> source;  // #V new, the old vertex: the old ones first, then copies for further fans
};

// mesh: mates run through their edge in opposite directions. mate: as FaceNeighbors tells. No two edges get the same
// two new vertices and no fan has more than 65,534 faces: where either would be, `mate` is changed. Where cutting
// changes nothing (both ends of the cut stay in one piece) the faces become mates again, or the cut goes on along one
// of them.
VertexFans SplitVertices(const TriangleMesh& mesh, const EdgeCorners& edges, std::vector<uint32_t>* mate);

}  // namespace lacerta

#endif  // LACERTA_REMESH_VERTEX_FANS_H_
