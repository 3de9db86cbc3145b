#include "draco/base_mesh_codec.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "draco_ext/draco/test_meshes.h"

namespace lacerta {
namespace {

using ::lacerta::testing::Octahedron;
using ::lacerta::testing::OnLattice;
using ::lacerta::testing::RealMesh;
using ::lacerta::testing::SameBits;
using ::lacerta::testing::Square;
using ::lacerta::testing::Torus;
using ::lacerta::testing::TwoOctahedra;
using ::testing::HasSubstr;

std::vector<Triangle> Normalized(std::vector<Triangle> triangles) {
  for (Triangle& t : triangles) std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

// Codes `base` and checks all that the header promises; floats are compared bit for bit where `exact`.
CodedBase ExpectRoundTrip(const BaseMesh& base, bool exact) {
  const StatusOr<CodedBase> result = EncodeBaseMesh(base);
  EXPECT_TRUE(result.ok()) << result.status().message();
  if (!result.ok()) return {};
  const CodedBase& coded = result.value();
  EXPECT_EQ(coded.mesh.step, base.step);
  EXPECT_EQ(coded.vertex_map.size(), base.lattice.size());
  std::vector<bool> seen(base.lattice.size(), false);
  for (size_t v = 0; v < coded.vertex_map.size(); ++v) {
    EXPECT_EQ(coded.mesh.lattice[v], base.lattice[coded.vertex_map[v]]);
    EXPECT_FALSE(seen[coded.vertex_map[v]]);
    seen[coded.vertex_map[v]] = true;
  }
  std::vector<Triangle> mapped = coded.mesh.triangles;
  for (Triangle& t : mapped) t = {{coded.vertex_map[t[0]], coded.vertex_map[t[1]], coded.vertex_map[t[2]]}};
  EXPECT_EQ(Normalized(mapped), Normalized(base.triangles));

  const StatusOr<DecodedBase> decoded = DecodeBaseMesh(coded.stream, {});
  EXPECT_TRUE(decoded.ok()) << decoded.status().message();
  if (!decoded.ok()) return {};
  EXPECT_EQ(decoded.value().bytes_used, coded.stream.size());
  EXPECT_EQ(decoded.value().mesh.triangles, coded.mesh.triangles);
  const StatusOr<BaseMesh> lattice = BaseMeshFromPositions(decoded.value().mesh, base.step);
  EXPECT_TRUE(lattice.ok()) << lattice.status().message();
  EXPECT_TRUE(lattice.ok() && lattice.value().lattice == coded.mesh.lattice);
  EXPECT_TRUE(!exact || SameBits(decoded.value().mesh.positions, coded.mesh.ToMesh().positions));
  return coded;
}

TEST(BaseMeshCodecTest, RoundTripsSmallShapesBitForBit) {
  ExpectRoundTrip(Octahedron(), true);
  ExpectRoundTrip(Square(), true);
  ExpectRoundTrip(Torus(6, 5), true);
  ExpectRoundTrip(BaseMesh{1.0f, {{{0, 0, 0}}, {{1, 0, 0}}, {{0, 1, 0}}}, {{{0, 1, 2}}}}, true);
}

TEST(BaseMeshCodecTest, KeepsVerticesAtTheSamePointApart) { ExpectRoundTrip(TwoOctahedra(), true); }

TEST(BaseMeshCodecTest, RoundTripsAllVerticesAtOnePoint) {
  BaseMesh base = Octahedron();
  for (auto& point : base.lattice) point = {7, -3, 0};
  ExpectRoundTrip(base, true);
}

TEST(BaseMeshCodecTest, RoundTripsLatticesOfAnyStep) {
  for (const float step : {1e-30f, 1.2e-7f, 0.1f, 1.0f / 3, 12345.678f, 1e30f}) {
    BaseMesh base = Torus(8, 7);
    base.step = step;
    ExpectRoundTrip(base, false);
    base.step = ShortStep(step);
    ExpectRoundTrip(base, true);
  }
}

BaseMesh FarAway(int32_t distance, float step) {
  BaseMesh base = Octahedron();
  base.step = step;
  for (auto& point : base.lattice) point = {point[0] + distance, point[1] - distance, point[2] + distance / 2};
  return base;
}

TEST(BaseMeshCodecTest, RoundTripsLatticeFarFromTheOrigin) {
  ExpectRoundTrip(FarAway(65000, ShortStep(0.0123f)), true);
  ExpectRoundTrip(FarAway(1000000, 0.0123f), false);
  ExpectRoundTrip(FarAway(16000000, 1.0f / 128), true);
}

TEST(BaseMeshCodecTest, RoundTripsLatticeOf24Bits) {
  BaseMesh base = Octahedron();
  base.step = 1e-5f;
  for (auto& point : base.lattice) {
    for (int32_t& value : point) value *= (1 << 16);
  }
  for (auto& point : base.lattice) point[0] = std::max(point[0], -(1 << 22));
  ExpectRoundTrip(base, false);
}

TEST(BaseMeshCodecTest, ShortStepHasEightBits) {
  EXPECT_EQ(ShortStep(1.0f), 1.0f);
  EXPECT_EQ(ShortStep(0.1f), 204.0f / 2048);
  for (const float step : {0.1f, 3e-12f, 7e20f}) {
    EXPECT_LE(ShortStep(step), step);
    EXPECT_GT(ShortStep(step), step * (1 - 1.0f / 128));
    EXPECT_EQ(ShortStep(step) * 65535.0f / 65535.0f, ShortStep(step));
  }
}

TEST(BaseMeshCodecTest, IsSmall) {
  // 300 regular vertices at 11 bits: a loss of compression is a change of behavior. 1095 bytes with libdraco 1.5.5.
  const CodedBase coded = ExpectRoundTrip(Torus(20, 15), true);
  EXPECT_LE(coded.stream.size(), 1120u);
  EXPECT_GE(coded.stream.size(), 500u);
}

TEST(BaseMeshCodecTest, IsDeterministic) {
  EXPECT_EQ(EncodeBaseMesh(Torus(9, 8)).value().stream, EncodeBaseMesh(Torus(9, 8)).value().stream);
}

TEST(BaseMeshCodecTest, RoundTripsRealMeshes) {
  int tried = 0;
  for (const char* name : {"fertility.ply", "fandisk.ply", "genus3.ply", "max_planck_5k.ply"}) {
    const auto mesh = RealMesh(name);
    if (!mesh.has_value()) continue;
    SCOPED_TRACE(name);
    ++tried;
    ExpectRoundTrip(OnLattice(*mesh, 12, &ShortStep), true);
  }
  if (tried == 0) GTEST_SKIP() << "no real mesh in " LACERTA_TEST_DATA_DIR;
}

void ExpectRefused(const BaseMesh& base, const std::string& reason) {
  const StatusOr<CodedBase> result = EncodeBaseMesh(base);
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.status().code(), StatusCode::kInvalidData);
  EXPECT_THAT(result.status().message(), HasSubstr(reason));
}

TEST(BaseMeshCodecTest, RefusesBadInput) {
  ExpectRefused(BaseMesh{1.0f, {}, {}}, "empty");
  BaseMesh base = Octahedron();
  for (const float step :
       {0.0f, -1.0f, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()}) {
    base.step = step;
    ExpectRefused(base, "step");
  }
  base.step = 1e38f;
  ExpectRefused(base, "does not fit a float");
  base = Octahedron();
  base.lattice[2][1] = 1 << 24;
  ExpectRefused(base, "2^24");
  base.lattice[2][1] = (1 << 24) - 1;
  base.lattice[3][1] = -(1 << 24) + 1;
  ExpectRefused(base, "24 bits");
  ExpectRefused(FarAway(16000000, 0.0123f), "too far from the origin");
  base = Octahedron();
  base.triangles[5][1] = 6;
  ExpectRefused(base, "base mesh");
  base = Octahedron();
  base.lattice.push_back({1, 1, 1});
  ExpectRefused(base, "base mesh");
}

TEST(BaseMeshCodecTest, RefusesWhatIsNoManifold) {
  BaseMesh pinched = TwoOctahedra();  // two octahedra that share one vertex
  for (Triangle& t : pinched.triangles) {
    for (uint32_t& v : t) v = v == 6 ? 0 : v > 6 ? v - 1 : v;
  }
  pinched.lattice.erase(pinched.lattice.begin() + 6);
  ExpectRefused(pinched, "base mesh");
  const BaseMesh fin{1.0f,
                     {{{0, 0, 0}}, {{2, 0, 0}}, {{0, 2, 0}}, {{0, 0, 2}}, {{0, -2, 0}}},
                     {{{0, 1, 2}}, {{1, 0, 3}}, {{0, 1, 4}}}};
  ExpectRefused(fin, "base mesh");
}

TEST(BaseMeshCodecTest, CodesCompactBasesInOneOrder) {
  for (const BaseMesh& base : {Octahedron(), Torus(7, 6), Square(), TwoOctahedra()}) {
    const CodedBase coded = EncodeBaseMesh(base, BaseCoding::kCompact).value();
    EXPECT_LT(coded.stream.size(), EncodeBaseMesh(base).value().stream.size());
    BaseMesh moved = coded.mesh;
    moved.step *= 2;
    for (auto& p : moved.lattice) p = {-p[1], 3 * p[2], p[0] + 11};
    const Bytes stream = RecodeBaseMesh(coded, moved).value();
    const DecodedBase decoded = DecodeBaseOf({stream, {}, BaseCoding::kCompact}, {}).value();
    EXPECT_EQ(decoded.mesh.triangles, coded.mesh.triangles);
    EXPECT_TRUE(SameBits(decoded.mesh.positions, moved.ToMesh().positions));
    EXPECT_EQ(decoded.bytes_used, stream.size());
    std::swap(moved.triangles[0], moved.triangles[1]);
    EXPECT_EQ(RecodeBaseMesh(coded, moved).status().code(), StatusCode::kInvalidArgument);
  }
}

}  // namespace
}  // namespace lacerta
