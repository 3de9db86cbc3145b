// Inputs and measures for the tests of remeshing and of what builds on it.
#ifndef LACERTA_TESTS_DRACO_EXT_REMESH_REMESHING_H_
#define LACERTA_TESTS_DRACO_EXT_REMESH_REMESHING_H_

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "lacerta/clean.h"
#include "lacerta/mesh.h"
#include "lacerta/remesh.h"
#include "lacerta/surface_distance.h"
#include "remesh/base_domain.h"
#include "remesh/collapse_history.h"
#include "remesh/decimate.h"
#include "remesh/input_surface.h"
#include "remesh/piercing.h"
#include "shapes/real_meshes.h"
#include "shapes/shapes.h"

namespace lacerta::testing {

// The closed manifold shapes, one component each.
inline std::vector<shapes::NamedShape> ClosedShapes() {
  std::vector<shapes::NamedShape> closed;
  for (shapes::NamedShape& shape : shapes::AllShapes()) {
    if (!shape.manifold || !shape.oriented || shape.num_borders > 0) continue;
    shape.mesh = Clean(shape.mesh).value().mesh;
    closed.push_back(std::move(shape));
  }
  return closed;
}

// Those of the closed real meshes of known genus that are there.
inline std::vector<shapes::NamedShape> ClosedRealMeshes(const std::vector<std::pair<std::string, int>>& names) {
  std::vector<shapes::NamedShape> meshes;
  for (const auto& [name, genus] : names) {
    if (std::optional<TriangleMesh> mesh = RealMesh(name)) meshes.push_back({name, std::move(*mesh), true, true, 0, genus});
  }
  return meshes;
}

inline TriangleMesh Moved(TriangleMesh mesh, const Vec3f& by) {
  for (Vec3f& p : mesh.positions) p += by;
  return mesh;
}

inline TriangleMesh Scaled(TriangleMesh mesh, float by) {
  for (Vec3f& p : mesh.positions) p *= by;
  return mesh;
}

// A pyramid upward and one downward over a regular polygon of n corners.
inline TriangleMesh DoublePyramid(uint32_t n) {
  TriangleMesh mesh;
  for (uint32_t i = 0; i < n; ++i) {
    const double angle = 6.283185307179586 * i / n;
    mesh.positions.push_back({static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)), 0});
    const uint32_t next = (i + 1) % n;
    mesh.triangles.push_back({n, i, next});
    mesh.triangles.push_back({n + 1, next, i});
  }
  mesh.positions.push_back({0, 0, 1});
  mesh.positions.push_back({0, 0, -1});
  return mesh;
}

inline TriangleMesh Tetrahedron() {
  return {{{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}}, {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}}};
}

// The topology of a manifold without creases.
inline Topology TopologyOf(const TriangleMesh& mesh) {
  return BuildTopology(static_cast<uint32_t>(mesh.positions.size()), mesh.triangles).value();
}

inline CollapseHistory Decimated(const TriangleMesh& mesh, const DecimateOptions& options = {}) {
  return Decimate(mesh, TopologyOf(mesh), options);
}

// Of the base mesh with about so many vertices.
inline uint32_t TimeOf(const CollapseHistory& history, const TriangleMesh& mesh, uint32_t num_base_vertices) {
  const auto count = static_cast<uint32_t>(mesh.positions.size());
  return std::min(history.num_collapses(), count - std::min(count, num_base_vertices));
}

inline std::vector<Vec3f> BasePositions(const BaseDomain& domain, const TriangleMesh& mesh) {
  std::vector<Vec3f> positions;
  for (uint32_t v = 0; v < domain.num_vertices(); ++v) positions.push_back(mesh.positions[domain.input_vertex(v)]);
  return positions;
}

// The normal mesh of `mesh` over a base of about so many vertices.
inline NormalMesh Remesh(const TriangleMesh& mesh, uint32_t num_base_vertices, int num_levels) {
  DecimateOptions decimation;
  decimation.target_vertices = num_base_vertices;
  const Topology topology = TopologyOf(mesh);
  const CollapseHistory history = Decimate(mesh, topology, decimation);
  const InputSurface surface(mesh, topology);
  const BaseDomain domain(history, history.num_collapses());
  PiercingOptions options;
  options.num_levels = num_levels;
  return Pierce(surface, domain, BasePositions(domain, mesh), options);
}

inline DomainPoint RandomPointOn(size_t face, std::mt19937* random) {
  std::uniform_real_distribution<double> unit(0, 1);
  double a = unit(*random), b = unit(*random);
  if (a + b > 1) a = 1 - a, b = 1 - b;
  return {static_cast<uint32_t>(face), {1 - a - b, a, b}};
}

inline Vec3d PositionOf(const std::vector<Vec3f>& positions, const Triangle& t, const Vec3d& weights) {
  Vec3d sum;
  for (int k = 0; k < 3; ++k) sum += Vec3Cast<double>(positions[t[k]]) * weights[k];
  return sum;
}

}  // namespace lacerta::testing

#endif  // LACERTA_TESTS_DRACO_EXT_REMESH_REMESHING_H_
