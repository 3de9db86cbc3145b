#include "remesh/input_surface.h"

#include <cmath>

namespace lacerta {

namespace {

// The normal of a face, weighted by its angle at a corner [Thuermer, Wuethrich 1998].
Vec3d CornerNormal(const TriangleMesh& mesh, uint32_t face, int k) {
  Vec3d p[3];
  for (int i = 0; i < 3; ++i) p[i] = Vec3Cast<double>(mesh.positions[mesh.triangles[face][(k + i) % 3]]);
  const Vec3d a = p[1] - p[0], b = p[2] - p[0], cross = Cross(a, b);
  return Normalized(cross) * std::atan2(Norm(cross), Dot(a, b));
}

}  // namespace

InputSurface::InputSurface(const TriangleMesh& mesh, const Topology& topology)
    : mesh_(mesh), tree_(mesh), corner_normals_(mesh.triangles) {
  const auto num_vertices = static_cast<uint32_t>(mesh.positions.size());
  std::vector<Vec3d> sums(num_vertices);
  for (uint32_t f = 0; f < topology.num_faces(); ++f) {
    for (int k = 0; k < 3; ++k) sums[mesh.triangles[f][k]] += CornerNormal(mesh, f, k);
  }
  vertex_normals_.reserve(num_vertices);
  for (const Vec3d& sum : sums) vertex_normals_.push_back(Vec3Cast<float>(Normalized(sum)));

  // One side of a curve at a vertex: from corner to corner as long as no curve is in between.
  for (uint32_t first = 0; first < topology.num_faces(); ++first) {
    for (int k = 0; k < 3; ++k) {
      const uint32_t v = mesh.triangles[first][k];
      if (topology.role[v] == CurveRole::kSmooth || corner_normals_[first][k] != v) continue;
      Vec3d sum;
      for (const int direction : {1, 2}) {
        for (uint32_t f = first; f != kNone;) {
          const Triangle& t = mesh.triangles[f];
          const int corner = t[0] == v ? 0 : t[1] == v ? 1 : 2;
          if (corner_normals_[f][corner] == v) {
            sum += CornerNormal(mesh, f, corner);
            corner_normals_[f][corner] = num_vertices + static_cast<uint32_t>(side_normals_.size());
          } else if (f != first) {
            break;  // once around
          }
          const uint32_t edge = topology.face_edges[f][(corner + direction) % 3];
          f = topology.on_curve[edge] ? kNone : FaceAcross(topology, f, edge);
        }
      }
      side_normals_.push_back(Vec3Cast<float>(Normalized(sum)));
    }
  }
}

Vec3f InputSurface::NormalAt(uint32_t face, const Vec3d& w) const {
  const size_t num_vertices = vertex_normals_.size();
  Vec3d sum;
  for (int k = 0; k < 3; ++k) {
    const uint32_t n = corner_normals_[face][k];
    sum += Vec3Cast<double>(n < num_vertices ? vertex_normals_[n] : side_normals_[n - num_vertices]) * w[k];
  }
  return Vec3Cast<float>(Normalized(sum));
}

Vec3f InputSurface::PositionAt(uint32_t face, const Vec3d& w) const {
  const Triangle& t = mesh_.triangles[face];
  Vec3d sum;
  for (int k = 0; k < 3; ++k) sum += Vec3Cast<double>(mesh_.positions[t[k]]) * w[k];
  return Vec3Cast<float>(sum);
}

}  // namespace lacerta
