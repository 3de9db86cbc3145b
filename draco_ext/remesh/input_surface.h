// The input surface with what remeshing asks of it: rays, closest points and smooth normals.
#ifndef LACERTA_REMESH_INPUT_SURFACE_H_
#define LACERTA_REMESH_INPUT_SURFACE_H_

#include <vector>

#include "common/subdivision.h"
#include "geometry/triangle_tree.h"
#include "lacerta/mesh.h"

namespace lacerta {

class InputSurface {
 public:
  // topology: of `mesh`, with its curves. Keeps a reference: `mesh` must outlive the surface.
  InputSurface(const TriangleMesh& mesh, const Topology& topology);

  const TriangleMesh& mesh() const { return mesh_; }
  const TriangleTree& tree() const { return tree_; }
  // Angle-weighted unit normal of a vertex; zero where all its faces are degenerate.
  const Vec3f& vertex_normal(uint32_t v) const { return vertex_normals_[v]; }
  // Interpolated unit normal. At a crease or border that of the face's own side.
  Vec3f NormalAt(uint32_t face, const Vec3d& barycentric) const;
  Vec3f PositionAt(uint32_t face, const Vec3d& barycentric) const;

 private:
  const TriangleMesh& mesh_;
  TriangleTree tree_;
  std::vector<Vec3f> vertex_normals_;          // #V
  std::vector<Vec3f> side_normals_;            // at vertices on curves, one per side that the curves cut the fan into
  std::vector<Triangle> corner_normals_;       // #F x 3: vertices, or #V + index of a side normal
};

}  // namespace lacerta

#endif  // LACERTA_REMESH_INPUT_SURFACE_H_
