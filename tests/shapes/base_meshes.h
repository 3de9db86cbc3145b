// Small base meshes, named for what they exercise, and semi-regular meshes over them.
#ifndef LACERTA_TESTS_SHAPES_BASE_MESHES_H_
#define LACERTA_TESTS_SHAPES_BASE_MESHES_H_

#include <cmath>
#include <cstdint>
#include <vector>

#include "common/butterfly.h"
#include "common/subdivision.h"
#include "lacerta/mesh.h"

namespace lacerta::shapes {

inline constexpr double kPi = 3.14159265358979323846;

// Two triangles back to back: closed, two faces that share all edges, valence 2.
inline TriangleMesh Pillow() { return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 1}}}; }

// Closed, all valences 3.
inline TriangleMesh Tetrahedron() {
  return {{{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}}, {{0, 1, 2}, {0, 3, 1}, {0, 2, 3}, {1, 3, 2}}};
}

// Closed, two poles of valence `sides` and a belt of valence 4; sides >= 3. Four sides: the octahedron.
inline TriangleMesh Bipyramid(uint32_t sides) {
  TriangleMesh mesh;
  for (uint32_t i = 0; i < sides; ++i) {
    const double angle = 2 * kPi * i / sides;
    mesh.positions.push_back({static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle)), 0.0f});
  }
  mesh.positions.push_back({0, 0, 1});
  mesh.positions.push_back({0, 0, -1});
  for (uint32_t i = 0; i < sides; ++i) {
    const uint32_t j = (i + 1) % sides;
    mesh.triangles.push_back({i, j, sides});
    mesh.triangles.push_back({j, i, sides + 1});
  }
  return mesh;
}

// Closed, all valences 5: north pole, two rings, south pole; on the unit sphere.
inline TriangleMesh Icosahedron() {
  TriangleMesh mesh;
  mesh.positions.push_back({0, 0, 1});
  for (int ring = 0; ring < 2; ++ring) {
    for (int i = 0; i < 5; ++i) {
      const double angle = 2 * kPi * (i + 0.5 * ring) / 5, z = (ring == 0 ? 1 : -1) / std::sqrt(5.0);
      const double r = 2 / std::sqrt(5.0);
      mesh.positions.push_back(Vec3Cast<float>(Vec3d{r * std::cos(angle), r * std::sin(angle), z}));
    }
  }
  mesh.positions.push_back({0, 0, -1});
  for (uint32_t i = 0; i < 5; ++i) {
    const uint32_t a = 1 + i, b = 1 + (i + 1) % 5, c = 6 + i, d = 6 + (i + 1) % 5;
    mesh.triangles.push_back({0, a, b});
    mesh.triangles.push_back({a, c, b});
    mesh.triangles.push_back({b, c, d});
    mesh.triangles.push_back({11, d, c});
  }
  return mesh;
}

// Closed, genus 1, all valences 6; rows, columns >= 3.
inline TriangleMesh Torus(uint32_t rows, uint32_t columns) {
  TriangleMesh mesh;
  for (uint32_t r = 0; r < rows; ++r) {
    for (uint32_t c = 0; c < columns; ++c) {
      const double u = 2 * kPi * c / columns, v = 2 * kPi * r / rows, radius = 2 + std::cos(v);
      mesh.positions.push_back(Vec3Cast<float>(Vec3d{radius * std::cos(u), radius * std::sin(u), std::sin(v)}));
    }
  }
  for (uint32_t r = 0; r < rows; ++r) {
    for (uint32_t c = 0; c < columns; ++c) {
      const uint32_t r1 = (r + 1) % rows, c1 = (c + 1) % columns;
      const uint32_t a = r * columns + c, b = r * columns + c1, d = r1 * columns + c, e = r1 * columns + c1;
      mesh.triangles.push_back({a, b, e});
      mesh.triangles.push_back({a, e, d});
    }
  }
  return mesh;
}

// With border: a square of size x size cells in the plane z = 0, vertex (c, r) at the position (c, r), regular inside.
inline TriangleMesh Grid(uint32_t size) {
  TriangleMesh mesh;
  for (uint32_t r = 0; r <= size; ++r) {
    for (uint32_t c = 0; c <= size; ++c) mesh.positions.push_back({static_cast<float>(c), static_cast<float>(r), 0.0f});
  }
  for (uint32_t r = 0; r < size; ++r) {
    for (uint32_t c = 0; c < size; ++c) {
      const uint32_t a = r * (size + 1) + c, d = a + size + 1;
      mesh.triangles.push_back({a, a + 1, d + 1});
      mesh.triangles.push_back({a, d + 1, d});
    }
  }
  return mesh;
}

// One triangle: all edges on the border.
inline TriangleMesh SingleTriangle() { return {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}}; }

// With border: a disk of `sides` triangles around vertex 0.
inline TriangleMesh Fan(uint32_t sides) {
  TriangleMesh mesh;
  mesh.positions.push_back({0, 0, 0.25f});
  for (uint32_t i = 0; i < sides; ++i) {
    const double angle = 2 * kPi * i / sides;
    mesh.positions.push_back(Vec3Cast<float>(Vec3d{std::cos(angle), std::sin(angle), 0.0}));
    mesh.triangles.push_back({0, 1 + i, 1 + (i + 1) % sides});
  }
  return mesh;
}

inline Topology TopologyOf(const TriangleMesh& mesh) {
  return BuildTopology(static_cast<uint32_t>(mesh.positions.size()), mesh.triangles).value();
}

// The two triangles at an inner edge, turned into the two across it.
inline TriangleMesh WithEdgeFlipped(TriangleMesh mesh, uint32_t edge) {
  const Topology t = TopologyOf(mesh);
  const uint32_t f = t.edge_faces[edge][0], g = t.edge_faces[edge][1];
  const uint32_t a = OppositeVertex(t, f, edge), b = OppositeVertex(t, g, edge);
  mesh.triangles[f] = {a, t.edges[edge][0], b};  // edges run as in their first face
  mesh.triangles[g] = {b, t.edges[edge][1], a};
  return mesh;
}

// The mesh subdivided num_levels times by the butterfly, every vertex then moved by displace(position).
template <typename Displace>
SemiRegularMesh Subdivided(const TriangleMesh& base, int num_levels, const Displace& displace) {
  Topology topology = TopologyOf(base);
  SemiRegularMesh mesh{base.triangles, topology.num_vertices, num_levels, base.positions};
  for (int level = 0; level < num_levels; ++level) {
    const std::vector<Vec3f> midpoints = PredictMidpoints(topology, StencilTable(topology), mesh.positions);
    mesh.positions.insert(mesh.positions.end(), midpoints.begin(), midpoints.end());
    topology = Refine(topology);
  }
  for (Vec3f& p : mesh.positions) p = displace(p);
  return mesh;
}

// Moves along the direction from the origin by gentle bumps.
inline Vec3f Bumpy(const Vec3f& p) {
  return p * (1.0f + 0.1f * std::sin(3 * p.x) * std::cos(2 * p.y) + 0.05f * std::sin(7 * p.z + p.x));
}

}  // namespace lacerta::shapes

#endif  // LACERTA_TESTS_SHAPES_BASE_MESHES_H_
