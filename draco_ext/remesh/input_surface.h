// The input surface with what remeshing asks of it: rays, closest points and smooth normals.
#ifndef LACERTA_REMESH_INPUT_SURFACE_H_
#define LACERTA_REMESH_INPUT_SURFACE_H_

#include <vector>

#include "geometry/triangle_tree.h"
#include "lacerta/mesh.h"

namespace lacerta {

class InputSurface {
 public:
  // Keeps a reference: `mesh` must outlive the surface.
  explicit InputSurface(const TriangleMesh& mesh);

  const TriangleMesh& mesh() const { return mesh_; }
  const TriangleTree& tree() const { return tree_; }
  // Angle-weighted unit normal of a vertex; zero where all its faces are degenerate.
  const Vec3f& vertex_normal(uint32_t v) const { return vertex_normals_[v]; }
  // Interpolated unit normal.
  Vec3f NormalAt(uint32_t face, const Vec3d& barycentric) const;
  Vec3f PositionAt(uint32_t face, const Vec3d& barycentric) const;

 private:
  const TriangleMesh& mesh_;
  TriangleTree tree_;
  std::vector<Vec3f> vertex_normals_;
};

}  // namespace lacerta

#endif  // LACERTA_REMESH_INPUT_SURFACE_H_
