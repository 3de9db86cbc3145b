#include "common/local_frame.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "common/butterfly.h"
#include "shapes/base_meshes.h"

namespace lacerta {
namespace {

std::vector<LocalFrame> FramesOf(const TriangleMesh& mesh) {
  const Topology t = shapes::TopologyOf(mesh);
  return ComputeLocalFrames(t, mesh.positions, PredictMidpoints(t, StencilTable(t), mesh.positions));
}

void ExpectOrthonormal(const LocalFrame& frame) {
  constexpr float kTolerance = 1e-6f;
  EXPECT_NEAR(Norm(frame.tangent1), 1, kTolerance);
  EXPECT_NEAR(Norm(frame.tangent2), 1, kTolerance);
  EXPECT_NEAR(Norm(frame.normal), 1, kTolerance);
  EXPECT_NEAR(Dot(frame.tangent1, frame.tangent2), 0, kTolerance);
  EXPECT_NEAR(Dot(frame.tangent1, frame.normal), 0, kTolerance);
  EXPECT_NEAR(Dot(frame.tangent2, frame.normal), 0, kTolerance);
  EXPECT_NEAR(Dot(Cross(frame.tangent1, frame.tangent2), frame.normal), 1, kTolerance);  // right-handed
}

TEST(LocalFrameTest, IsOrthonormalOnAllShapes) {
  for (const TriangleMesh& mesh :
       {shapes::Pillow(), shapes::Tetrahedron(), shapes::Bipyramid(4), shapes::Bipyramid(50), shapes::Icosahedron(),
        shapes::Torus(4, 5), shapes::Grid(3), shapes::SingleTriangle()}) {
    for (const LocalFrame& frame : FramesOf(mesh)) ExpectOrthonormal(frame);
  }
}

TEST(LocalFrameTest, NormalPointsOutwardOnTheIcosahedron) {
  const TriangleMesh mesh = shapes::Icosahedron();
  const Topology t = shapes::TopologyOf(mesh);
  const std::vector<Vec3f> midpoints = PredictMidpoints(t, StencilTable(t), mesh.positions);
  const std::vector<LocalFrame> frames = ComputeLocalFrames(t, mesh.positions, midpoints);
  for (uint32_t e = 0; e < t.num_edges(); ++e) EXPECT_GT(Dot(frames[e].normal, Normalized(midpoints[e])), 0.999f);
}

TEST(LocalFrameTest, OneAtATimeIsTheSameAsAll) {
  for (const TriangleMesh& mesh : {shapes::Torus(7, 5), shapes::Pillow(), shapes::Grid(4), shapes::Fan(6)}) {
    const Topology t = shapes::TopologyOf(mesh);
    const std::vector<Vec3f> midpoints = PredictMidpoints(t, StencilTable(t), mesh.positions);
    const std::vector<LocalFrame> frames = ComputeLocalFrames(t, mesh.positions, midpoints);
    for (uint32_t e = 0; e < t.num_edges(); ++e) {
      const LocalFrame frame = FrameWithNormal(t, mesh.positions, e, FrameNormalAt(t, mesh.positions, midpoints, e));
      EXPECT_EQ(frame.normal, frames[e].normal);  // to the last bit
      EXPECT_EQ(frame.tangent1, frames[e].tangent1);
      EXPECT_EQ(frame.tangent2, frames[e].tangent2);
    }
  }
}

TEST(LocalFrameTest, FollowsThePlaneAndTheEdges) {
  const TriangleMesh mesh = shapes::Grid(3);
  const Topology t = shapes::TopologyOf(mesh);
  const std::vector<LocalFrame> frames = FramesOf(mesh);
  for (uint32_t e = 0; e < t.num_edges(); ++e) {
    EXPECT_EQ(frames[e].normal, (Vec3f{0, 0, 1}));
    const Vec3f along = Normalized(mesh.positions[t.edges[e][1]] - mesh.positions[t.edges[e][0]]);
    EXPECT_NEAR(Dot(frames[e].tangent1, along), 1, 1e-6);
    EXPECT_NEAR(Norm(frames[e].tangent2 - Cross(frames[e].normal, along)), 0, 1e-6);
  }
}

TEST(LocalFrameTest, TurnsWithTheMesh) {
  TriangleMesh mesh = shapes::Bipyramid(5);
  const std::vector<LocalFrame> before = FramesOf(mesh);
  const auto turn = [](const Vec3f& p) { return Vec3f{p.y, p.z, p.x}; };
  for (Vec3f& p : mesh.positions) p = turn(p);
  const std::vector<LocalFrame> after = FramesOf(mesh);
  for (size_t e = 0; e < before.size(); ++e) {
    EXPECT_NEAR(Norm(after[e].normal - turn(before[e].normal)), 0, 1e-6);
    EXPECT_NEAR(Norm(after[e].tangent1 - turn(before[e].tangent1)), 0, 1e-6);
  }
}

TEST(LocalFrameTest, IsTheSameAtEveryScale) {
  const TriangleMesh mesh = shapes::Icosahedron();
  const std::vector<LocalFrame> frames = FramesOf(mesh);
  for (const float scale : {1e-15f, 1e-12f, 1e-6f, 1e6f, 1e15f}) {
    SCOPED_TRACE(scale);
    TriangleMesh scaled = mesh;
    for (Vec3f& p : scaled.positions) p *= scale;
    const std::vector<LocalFrame> scaled_frames = FramesOf(scaled);
    for (size_t e = 0; e < frames.size(); ++e) {
      EXPECT_NEAR(Norm(scaled_frames[e].normal - frames[e].normal), 0, 1e-5);
      EXPECT_NEAR(Norm(scaled_frames[e].tangent1 - frames[e].tangent1), 0, 1e-5);
    }
  }
}

TEST(LocalFrameTest, LocalAndWorldAreInverse) {
  for (const LocalFrame& frame : FramesOf(shapes::Bipyramid(7))) {
    const Vec3f d = {0.3f, -1.7f, 2.5f};
    EXPECT_NEAR(Norm(frame.ToWorld(frame.ToLocal(d)) - d), 0, 3e-6);
    EXPECT_NEAR(Norm(frame.ToLocal(frame.normal) - Vec3f{0, 0, 1}), 0, 1e-6);
  }
}

TEST(LocalFrameTest, DegenerateSurfacesStillHaveOrthonormalFrames) {
  const float kBig = 1e30f, kInf = std::numeric_limits<float>::infinity(),
              kNan = std::numeric_limits<float>::quiet_NaN();
  std::vector<TriangleMesh> meshes(5, shapes::Bipyramid(4));
  for (size_t v = 0; v < meshes[0].positions.size(); ++v) {
    const float i = static_cast<float>(v);
    meshes[0].positions[v] = {1, 2, 3};                      // a point
    meshes[1].positions[v] = {0.1f * i, 0, 0};               // a line along x
    meshes[2].positions[v] = {0, 0, i * i};                  // a line along z, the axis that stands in for the normal
    meshes[3].positions[v] = meshes[3].positions[v] * kBig;  // areas overflow
    meshes[4].positions[v] = v == 0 ? Vec3f{kNan, 0, 0} : v == 1 ? Vec3f{0, kInf, 0} : meshes[4].positions[v];
  }
  for (const TriangleMesh& mesh : meshes) {
    for (const LocalFrame& frame : FramesOf(mesh)) ExpectOrthonormal(frame);
  }
}

TEST(LocalFrameTest, EdgeNearlyParallelToTheNormalStillYieldsAnOrthonormalFrame) {
  // A single edge leans out of the plane of the fine triangles by 2e-3 of a right angle: midpoints are given, not
  // predicted.
  const Topology t = shapes::TopologyOf(shapes::SingleTriangle());
  for (const float lean : {1e-4f, 9e-4f, 1.1e-3f, 2e-3f, 1e-2f}) {
    SCOPED_TRACE(lean);
    const std::vector<Vec3f> positions = {{0, 0, 0}, {lean, 0, 1}, {0.3f * lean, lean, 0.5f}};
    const std::vector<Vec3f> midpoints = {{10, 0, 0}, {0, 10, 0}, {-10, -10, 0}};
    for (const LocalFrame& frame : ComputeLocalFrames(t, positions, midpoints)) ExpectOrthonormal(frame);
  }
}

}  // namespace
}  // namespace lacerta
