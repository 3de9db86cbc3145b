#include "common/curved_prediction.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "common/butterfly.h"
#include "common/local_frame.h"
#include "shapes/base_meshes.h"

namespace lacerta {
namespace {

struct Curved {
  Topology topology;
  std::vector<Vec3f> butterfly, offsets;  // #E

  Vec3f Midpoint(uint32_t e) const { return butterfly[e] + offsets[e]; }
};

Curved CurvesOf(const TriangleMesh& mesh) {
  Curved result{shapes::TopologyOf(mesh), {}, {}};
  result.butterfly = PredictMidpoints(result.topology, StencilTable(result.topology), mesh.positions);
  result.offsets = CurveOffsets(result.topology, mesh.positions, result.butterfly, FrameNormals(result.topology, mesh.positions, result.butterfly));
  return result;
}

// Closed meshes alone: 3/64 of the mean offset of both opposite vertices from the middle of an edge, less 1/32 of that of its four wings.
Vec3f Surroundings(const Topology& t, const std::vector<Vec3f>& positions, uint32_t edge) {
  const Vec3f middle = (positions[t.edges[edge][0]] + positions[t.edges[edge][1]]) * 0.5f;
  Vec3f opposite, wings;
  for (const uint32_t face : t.edge_faces[edge]) {
    opposite += positions[OppositeVertex(t, face, edge)] * 0.5f;
    for (const uint32_t side : t.face_edges[face]) {
      if (side != edge) wings += positions[OppositeVertex(t, FaceAcross(t, face, side), side)] * 0.25f;
    }
  }
  return (opposite - middle) * (3.0f / 64) - (wings - middle) * (1.0f / 32);
}

TEST(CurvedPrediction, IsTheHermiteCurveOverAnArc) {
  // The normals of an icosahedron are those of its sphere, so that over an edge of angle a the curve rises by sin(a/2)^2 cos(a/2) / 2 above
  // a chord at cos(a/2); the butterfly's midpoints stay well below.
  const TriangleMesh mesh = shapes::Icosahedron();
  const Curved c = CurvesOf(mesh);
  for (uint32_t e = 0; e < c.topology.num_edges(); ++e) {
    const auto& [a, b] = c.topology.edges[e];
    const float radius = Norm(mesh.positions[a]);
    const float half = 0.5f * std::acos(Dot(mesh.positions[a], mesh.positions[b]) / (radius * radius));
    const Vec3f middle = (mesh.positions[a] + mesh.positions[b]) * 0.5f;
    const float around = Dot(Surroundings(c.topology, mesh.positions, e), Normalized(middle));
    const float expected = radius * std::cos(half) * (1 + 0.5f * std::sin(half) * std::sin(half)) + around;
    EXPECT_NEAR(Norm(c.Midpoint(e)), expected, 1e-5f * radius);
    EXPECT_GT(Norm(c.Midpoint(e)), 0.95f * radius);
  }
}

// A unit sphere with triangles of all shapes, as coarse bases have them: the icosahedron split once, its vertices strayed.
TriangleMesh UnevenSphere() {
  const TriangleMesh icosahedron = shapes::Icosahedron();
  const Topology t = shapes::TopologyOf(icosahedron);
  TriangleMesh mesh{icosahedron.positions, RefineTriangles(t)};
  for (const auto& [a, b] : t.edges) mesh.positions.push_back(icosahedron.positions[a] + icosahedron.positions[b]);
  std::mt19937 random(5);
  const auto stray = [&] { return 0.2f * (static_cast<float>(random() % 1024) / 512.0f - 1.0f); };
  for (Vec3f& p : mesh.positions) p = Normalized(Normalized(p) + Vec3f{stray(), stray(), stray()});
  return mesh;
}

TEST(CurvedPrediction, ComesNearerToAnUnevenSphereThanTheButterfly) {
  const Curved c = CurvesOf(UnevenSphere());
  float butterfly = 0, curved = 0;
  for (uint32_t e = 0; e < c.topology.num_edges(); ++e) {
    butterfly += std::fabs(Norm(c.butterfly[e]) - 1);
    curved += std::fabs(Norm(c.Midpoint(e)) - 1);
  }
  EXPECT_LT(curved, 0.6f * butterfly);
  EXPECT_GT(curved, 0.0f);
}

TEST(CurvedPrediction, MovesAlongTheNormalOfTheFrame) {
  const TriangleMesh mesh = UnevenSphere();
  const Curved c = CurvesOf(mesh);
  const std::vector<LocalFrame> frames = ComputeLocalFrames(c.topology, mesh.positions, c.butterfly);
  float largest = 0;
  for (uint32_t e = 0; e < c.topology.num_edges(); ++e) {
    EXPECT_NEAR(Norm(Cross(c.offsets[e], frames[e].normal)), 0, 1e-6f);
    largest = std::max(largest, Norm(c.offsets[e]));
  }
  EXPECT_GT(largest, 0.01f);
}

TEST(CurvedPrediction, StaysInAPlaneAndAtCurves) {
  for (const Vec3f& offset : CurvesOf(shapes::Grid(6)).offsets) EXPECT_NEAR(Norm(offset), 0, 1e-6f);
  TriangleMesh bent = shapes::Grid(6);
  for (Vec3f& p : bent.positions) p.z = 0.5f * std::sin(1.1f * p.x) * std::cos(0.9f * p.y);
  const Curved c = CurvesOf(bent);
  bool moves = false;
  for (uint32_t e = 0; e < c.topology.num_edges(); ++e) {
    const auto& [a, b] = c.topology.edges[e];
    const bool touches_border = c.topology.role[a] != CurveRole::kSmooth || c.topology.role[b] != CurveRole::kSmooth;
    if (touches_border) {
      EXPECT_EQ(c.offsets[e], Vec3f());
    }
    moves = moves || !(c.offsets[e] == Vec3f());
  }
  EXPECT_TRUE(moves);
}

TEST(CurvedPrediction, IsTheSameInRegisters) {
  TriangleMesh bent = shapes::Grid(6);
  for (Vec3f& p : bent.positions) p.z = 0.5f * std::sin(1.1f * p.x) * std::cos(0.9f * p.y);
  for (const TriangleMesh& mesh : {UnevenSphere(), bent}) {
    const Curved c = CurvesOf(mesh);
    std::vector<Vec3f> more = mesh.positions;
    more.emplace_back();
    EXPECT_EQ(CurveOffsets(c.topology, more, c.butterfly, FrameNormals(c.topology, more, c.butterfly)), c.offsets);
  }
}

TEST(CurvedPrediction, ScalesAndTurnsWithTheMesh) {
  const TriangleMesh mesh = shapes::Torus(7, 6);
  const Curved c = CurvesOf(mesh);
  TriangleMesh turned = mesh;
  for (Vec3f& p : turned.positions) p = Vec3f{p.y, p.z, p.x} * 64.0f;
  const Curved t = CurvesOf(turned);
  for (uint32_t e = 0; e < c.topology.num_edges(); ++e) {
    const Vec3f& o = c.offsets[e];
    EXPECT_NEAR(Norm(t.offsets[e] * (1 / 64.0f) - Vec3f{o.y, o.z, o.x}), 0, 1e-5f);
  }
}

TEST(CurvedPrediction, IsFiniteOnDegenerateAndHugeMeshes) {
  TriangleMesh point = shapes::Icosahedron();
  for (Vec3f& p : point.positions) p = {1, 2, 3};
  TriangleMesh huge = shapes::Icosahedron(), tiny = huge;
  for (Vec3f& p : huge.positions) p = p * 1e30f;
  for (Vec3f& p : tiny.positions) p = p * 1e-30f;
  for (const TriangleMesh& mesh : {shapes::Pillow(), shapes::Tetrahedron(), shapes::Bipyramid(50), point, huge, tiny}) {
    for (const Vec3f& o : CurvesOf(mesh).offsets) EXPECT_TRUE(std::isfinite(o.x) && std::isfinite(o.y) && std::isfinite(o.z));
  }
}

}  // namespace
}  // namespace lacerta
