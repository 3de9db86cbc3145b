#include "pack/position_descent.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "document/draco_encode.h"
#include "gltf/test_assets.h"

namespace lacerta {
namespace {

Lattice BoxLattice(int bits) { return PositionLattice({-1.2f, -1.2f, -1.2f}, {1.2f, 1.2f, 1.2f}, bits); }

double Step(const Lattice& lattice) { return lattice.range / static_cast<double>((int64_t{1} << lattice.bits) - 1); }

// RMS along the normals over the surface, of moves that are linear on every triangle.
double DistanceOf(const TriangleMesh& before, const std::vector<Vec3f>& after) {
  double squares = 0.0, areas = 0.0;
  for (const Triangle& t : before.triangles) {
    const auto at = [&](size_t k) { return Vec3Cast<double>(before.positions[t[k]]); };
    const Vec3d area = Cross(at(1) - at(0), at(2) - at(0));
    double along[3];
    for (size_t k = 0; k < 3; ++k) along[k] = Dot(Normalized(area), Vec3Cast<double>(after[t[k]]) - at(k));
    double sum = 0.0;
    for (int i = 0; i < 3; ++i) {
      for (int j = i; j < 3; ++j) sum += along[i] * along[j];
    }
    squares += Norm(area) * sum / 6.0;
    areas += Norm(area);
  }
  return std::sqrt(squares / areas);
}

std::vector<Vec3f> Nearest(const TriangleMesh& mesh, const Lattice& lattice) {
  std::vector<Vec3f> result;
  for (const Vec3f& p : mesh.positions) result.push_back({lattice.At(lattice.Round(p.x, 0), 0), lattice.At(lattice.Round(p.y, 1), 1), lattice.At(lattice.Round(p.z, 2), 2)});
  return result;
}

size_t BytesOf(const TriangleMesh& mesh, const Lattice& lattice, const std::vector<Vec3f>& positions) {
  Primitive primitive;
  primitive.num_vertices = mesh.positions.size();
  primitive.triangles = mesh.triangles;
  primitive.attributes = {{"POSITION", MakeFloatAccessor(mesh.positions)}};
  DracoPrecision precision{lattice, {}, 0};
  precision.values["POSITION"] = MakeFloatAccessor(positions);
  return EncodeDracoPrimitive(primitive, precision).value().bytes.size();
}

// On lattices of the same step it is nearer, so that a coarser one, with fewer bytes, is near enough.
TEST(PositionDescent, NearerThanTheNearestPointsInFewerBytes) {
  const TriangleMesh mesh = testing::WavySphere(40, 60);
  const PositionDescent descent({mesh});
  for (const int bits : {9, 10, 11}) {
    const Lattice lattice = BoxLattice(bits);
    const std::vector<Vec3f> moved = descent.On(lattice)[0], nearest = Nearest(mesh, lattice);
    ASSERT_EQ(moved.size(), mesh.positions.size());
    for (size_t v = 0; v < moved.size(); ++v) {
      for (int axis = 0; axis < 3; ++axis) {
        const auto c = static_cast<uint32_t>(axis);
        EXPECT_EQ(moved[v][axis], lattice.At(lattice.Round(moved[v][axis], c), c));
        EXPECT_LE(std::fabs(moved[v][axis] - mesh.positions[v][axis]), 1.001 * Step(lattice));
      }
    }
    const double allowed = DistanceOf(mesh, nearest);
    EXPECT_LT(DistanceOf(mesh, moved), 0.9 * allowed);
    EXPECT_GT(DistanceOf(mesh, moved), 0.3 * allowed);
    size_t least = BytesOf(mesh, lattice, nearest);
    const size_t before = least;
    for (const double coarser : {1.1, 1.2, 1.3, 1.4, 1.5, 1.6}) {
      const Lattice other = LatticeOfStep(lattice, static_cast<float>(coarser * Step(lattice)));
      const std::vector<Vec3f> positions = descent.On(other)[0];
      if (DistanceOf(mesh, positions) <= allowed) least = std::min(least, BytesOf(mesh, other, positions));
    }
    EXPECT_LT(static_cast<double>(least), 0.99 * static_cast<double>(before)) << bits;
  }
}

// Vertices of two surfaces at one place stay at one.
TEST(PositionDescent, SurfacesThatTouchStayTogether) {
  const TriangleMesh mesh = testing::WavySphere(24, 36);
  TriangleMesh front = mesh, back = mesh;
  front.triangles.resize(mesh.triangles.size() / 2);
  back.triangles.erase(back.triangles.begin(), back.triangles.begin() + static_cast<std::ptrdiff_t>(front.triangles.size()));
  const std::vector<std::vector<Vec3f>> moved = PositionDescent({front, back}).On(BoxLattice(8));
  ASSERT_EQ(moved.size(), 2u);
  size_t num_moved = 0;
  const std::vector<Vec3f> nearest = Nearest(mesh, BoxLattice(8));
  for (size_t v = 0; v < mesh.positions.size(); ++v) {
    EXPECT_EQ(moved[0][v], moved[1][v]);
    num_moved += moved[0][v] == nearest[v] ? 0 : 1;
  }
  EXPECT_GT(num_moved, mesh.positions.size() / 10);
}

// On a lattice as coarse as the triangles none turns over that did not at the nearest points.
TEST(PositionDescent, TrianglesDoNotTurnOver) {
  const TriangleMesh mesh = testing::WavySphere(60, 90);
  const Lattice lattice = BoxLattice(5);
  const auto num_turned = [&](const std::vector<Vec3f>& after) {
    size_t sum = 0;
    for (const Triangle& t : mesh.triangles) {
      const Vec3f before = Cross(mesh.positions[t[1]] - mesh.positions[t[0]], mesh.positions[t[2]] - mesh.positions[t[0]]);
      sum += Dot(before, Cross(after[t[1]] - after[t[0]], after[t[2]] - after[t[0]])) < 0.0f ? 1 : 0;
    }
    return sum;
  };
  const std::vector<Vec3f> nearest = Nearest(mesh, lattice);
  EXPECT_GT(num_turned(nearest), 20u);
  EXPECT_LE(num_turned(PositionDescent({mesh}).On(lattice)[0]), num_turned(nearest));
}

TEST(PositionDescent, WithoutTriangles) {
  TriangleMesh mesh;
  mesh.positions = {{0.1f, 0.2f, 0.3f}, {0.1f, 0.2f, 0.3f}};
  mesh.triangles = {{0, 0, 1}};
  const Lattice lattice = BoxLattice(6);
  EXPECT_EQ(PositionDescent({mesh}).On(lattice)[0], Nearest(mesh, lattice));
  EXPECT_TRUE(PositionDescent({}).On(lattice).empty());
}

}  // namespace
}  // namespace lacerta
