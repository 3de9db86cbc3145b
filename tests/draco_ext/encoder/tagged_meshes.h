// Normal meshes over the tagged bases of test_streams.h.
#ifndef LACERTA_TESTS_DRACO_EXT_ENCODER_TAGGED_MESHES_H_
#define LACERTA_TESTS_DRACO_EXT_ENCODER_TAGGED_MESHES_H_

#include <vector>

#include "common/butterfly.h"
#include "draco_ext/encoder/test_streams.h"
#include "lacerta/remesh.h"
#include "shapes/base_meshes.h"

namespace lacerta::testing {

// The base subdivided, then bent; joined vertices stay together.
inline NormalMesh Bent(const TaggedBase& tagged, int num_levels) {
  NormalMesh result;
  SemiRegularMesh& mesh = result.mesh;
  mesh.base_triangles = tagged.base.triangles;
  mesh.num_base_vertices = static_cast<uint32_t>(tagged.base.lattice.size());
  mesh.num_levels = num_levels;
  mesh.tags = tagged.tags;
  mesh.positions = tagged.base.ToMesh().positions;
  Topology t = BuildTopology(mesh.num_base_vertices, mesh.base_triangles, mesh.tags).value();
  for (int level = 0; level < num_levels; ++level, t = Refine(t)) {
    const std::vector<Vec3f> midpoints = PredictMidpoints(t, StencilTable(t), mesh.positions);
    mesh.positions.insert(mesh.positions.end(), midpoints.begin(), midpoints.end());
  }
  for (Vec3f& p : mesh.positions) p = shapes::Bumpy(p);
  result.surface_normals.assign(mesh.positions.size(), Vec3f());
  for (const Triangle& tri : t.triangles) {
    const Vec3f& a = mesh.positions[tri[0]];
    const Vec3f area = Cross(mesh.positions[tri[1]] - a, mesh.positions[tri[2]] - a);
    for (const uint32_t v : tri) result.surface_normals[v] += area;
  }
  for (Vec3f& n : result.surface_normals) n = n == Vec3f() ? Vec3f{0, 0, 1} : Normalized(n);
  result.piercing.assign(mesh.positions.size() - mesh.num_base_vertices, PiercingKind::kClosest);
  return result;
}

}  // namespace lacerta::testing

#endif  // LACERTA_TESTS_DRACO_EXT_ENCODER_TAGGED_MESHES_H_
