// The coders that ours is compared with, in the same process: stock Draco, and meshoptimizer where it is installed (LACERTA_HAVE_MESHOPTIMIZER).
#ifndef LACERTA_TESTS_BENCH_OTHER_CODECS_H_
#define LACERTA_TESTS_BENCH_OTHER_CODECS_H_

#include <draco/mesh/mesh.h>

#include <cstddef>
#include <memory>

#include "lacerta/mesh.h"
#include "lacerta/status.h"
#include "lacerta/vec3.h"

namespace lacerta {

// Positions and triangles by stock Draco at speed 0, with so many bits for positions (1 to 30).
StatusOr<Bytes> EncodeByDraco(const TriangleMesh& mesh, int bits);
StatusOr<std::unique_ptr<draco::Mesh>> DecodeByDraco(const Bytes& stream);

#ifdef LACERTA_HAVE_MESHOPTIMIZER
struct MeshoptStreams {
  size_t num_vertices = 0, num_triangles = 0;
  float step = 0;
  Vec3f corner;
  Bytes vertices, indices;

  size_t size() const { return vertices.size() + indices.size(); }
};

// By meshoptimizer's coders of vertices and indices, in an order that they like, on a lattice of so many bits (1 to 16) along the longest side.
// mesh: with at least one triangle.
MeshoptStreams EncodeByMeshopt(TriangleMesh mesh, int bits);
// With floats for positions.
StatusOr<TriangleMesh> DecodeByMeshopt(const MeshoptStreams& coded);
#endif

}  // namespace lacerta

#endif  // LACERTA_TESTS_BENCH_OTHER_CODECS_H_
