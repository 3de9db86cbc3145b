// Meshes that no scanner makes: EncodeMesh refuses them by name or makes a stream that decodes to a sound mesh, and where and how large a
// mesh is says little to its bytes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <ctime>
#include <map>
#include <numeric>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "lacerta/codec.h"
#include "lacerta/surface_distance.h"
#include "shapes/base_meshes.h"
#include "shapes/shapes.h"

namespace lacerta {
namespace {

using ::testing::HasSubstr;
using Kind = EncodeTarget::Kind;

// No subdivision connectivity, so that it is remeshed.
TriangleMesh Bumpy() { return shapes::WithEdgeFlipped(shapes::BumpySphere(3, 0.2f, 0.002f), 300); }

TriangleMesh Moved(TriangleMesh mesh, float scale, const Vec3f& offset) {
  for (Vec3f& p : mesh.positions) p = p * scale + offset;
  return mesh;
}

EncodeOptions Options(LevelChoice levels) {
  EncodeOptions options;
  options.target = {Kind::kPsnr, 48.0};
  options.levels = levels;
  options.effort = Effort::kFast;
  return options;
}

#ifdef LACERTA_SANITIZED
constexpr double kMostSeconds = 600;
#else
constexpr double kMostSeconds = 60;  // of all threads; measured are up to 8
#endif

// The message of a refusal, or nothing; a stream is sound. Either comes soon.
std::string Encode(const TriangleMesh& mesh, LevelChoice levels) {
  const std::clock_t begin = std::clock();
  const StatusOr<EncodedMesh> encoded = EncodeMesh(mesh, Options(levels));
  EXPECT_LE(static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC, kMostSeconds);
  if (!encoded.ok()) {
    EXPECT_NE(encoded.status().message(), "");
    return encoded.status().message();
  }
  const std::vector<size_t>& parts = encoded.value().part_sizes;
  EXPECT_EQ(std::accumulate(parts.begin(), parts.end(), size_t{0}), encoded.value().stream.size());
  const StatusOr<DecodedMesh> decoded = DecodeMesh(encoded.value().stream, {});
  EXPECT_TRUE(decoded.ok()) << decoded.status().message();
  if (!decoded.ok()) return "";
  EXPECT_TRUE(decoded.value().refinement.ok()) << decoded.value().refinement.message();
  const TriangleMesh& result = decoded.value().mesh;
  EXPECT_FALSE(result.triangles.empty());
  for (const Vec3f& p : result.positions) EXPECT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
  for (const Triangle& t : result.triangles) EXPECT_LT(*std::max_element(t.begin(), t.end()), result.positions.size());
  return "";
}

class ScaleTest : public ::testing::TestWithParam<float> {};

TEST_P(ScaleTest, IsEncodedOrRefusedByName) {
  const float scale = GetParam();
  const bool is_large = scale > 1e18f, is_small = scale < 1e-13f;
  for (const LevelChoice levels : {LevelChoice::kAlways, LevelChoice::kNever}) {
    const std::string message = Encode(Moved(Bumpy(), scale, {}), levels);
    if (is_large) {
      EXPECT_THAT(message, HasSubstr("beyond 1e18"));
    } else if (is_small) {
      EXPECT_THAT(message, HasSubstr("smaller than 1e-12"));
    } else {
      EXPECT_EQ(message, "");
    }
  }
}

// Denormal numbers, the least and the largest that are taken, and what is beyond.
INSTANTIATE_TEST_SUITE_P(Scales, ScaleTest, ::testing::Values(1e-40f, 1e-30f, 1e-14f, 1e-11f, 1e17f, 1e19f, 1e30f, 2e38f));

TEST(EncodeRobustnessTest, SurfacesWithoutAreaAreRefused) {
  TriangleMesh point = Bumpy(), line = point;
  std::fill(point.positions.begin(), point.positions.end(), Vec3f{1, 2, 3});
  for (Vec3f& p : line.positions) p.y = p.z = 0;
  for (const LevelChoice levels : {LevelChoice::kAlways, LevelChoice::kWhereTheyPay}) {
    EXPECT_THAT(Encode(point, levels), HasSubstr("no triangle left"));
    EXPECT_THAT(Encode(line, levels), HasSubstr("degenerate"));
    EXPECT_THAT(Encode({}, levels), HasSubstr("no triangle"));
  }
}

TEST(EncodeRobustnessTest, OneTriangleIsEncoded) {
  const TriangleMesh one = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  for (const LevelChoice levels : {LevelChoice::kAlways, LevelChoice::kWhereTheyPay, LevelChoice::kNever}) EXPECT_EQ(Encode(one, levels), "");
}

TEST(EncodeRobustnessTest, ManyTinyComponentsAreEncoded) {
  std::mt19937 random(3);
  const auto coordinate = [&] { return static_cast<float>(random() % 10001) / 5000 - 1; };
  TriangleMesh mesh;
  for (uint32_t i = 0; i < 400; ++i) {
    const Vec3f corner = {coordinate(), coordinate(), coordinate()};
    mesh.positions.insert(mesh.positions.end(), {corner, corner + Vec3f{0.02f, 0, 0}, corner + Vec3f{0, 0.02f, 0}, corner + Vec3f{0, 0, 0.02f}});
    const uint32_t a = 4 * i;
    mesh.triangles.insert(mesh.triangles.end(), {{a, a + 2, a + 1}, {a, a + 1, a + 3}, {a, a + 3, a + 2}, {a + 1, a + 2, a + 3}});
  }
  EXPECT_EQ(Encode(mesh, LevelChoice::kAlways), "");
}

// Edges of many faces, faces through each other, vertices of no face.
TEST(EncodeRobustnessTest, RandomTrianglesAreEncoded) {
  for (const uint32_t num_vertices : {8u, 120u}) {
    std::mt19937 random(num_vertices);
    const auto coordinate = [&] { return static_cast<float>(random() % 10001) / 5000 - 1; };
    TriangleMesh mesh;
    for (uint32_t v = 0; v < num_vertices; ++v) mesh.positions.push_back({coordinate(), coordinate(), coordinate()});
    for (uint32_t f = 0; f < 150; ++f) {
      mesh.triangles.push_back({static_cast<uint32_t>(random() % num_vertices), static_cast<uint32_t>(random() % num_vertices),
                                static_cast<uint32_t>(random() % num_vertices)});
    }
    for (const LevelChoice levels : {LevelChoice::kAlways, LevelChoice::kNever}) EXPECT_EQ(Encode(mesh, levels), "");
  }
}

// As many as a library of instances has when somebody joins them.
TEST(EncodeRobustnessTest, TenThousandQuadsAreEncoded) {
  std::mt19937 random(4);
  const auto coordinate = [&] { return static_cast<float>(random() % 100001) / 50000 - 1; };
  TriangleMesh mesh;
  for (uint32_t i = 0; i < 10'000; ++i) {
    const Vec3f corner = {coordinate(), coordinate(), coordinate()};
    mesh.positions.insert(mesh.positions.end(), {corner, corner + Vec3f{0.01f, 0, 0}, corner + Vec3f{0.01f, 0.01f, 0}, corner + Vec3f{0, 0.01f, 0}});
    const uint32_t a = 4 * i;
    mesh.triangles.insert(mesh.triangles.end(), {{a, a + 1, a + 2}, {a, a + 2, a + 3}});
  }
  EXPECT_EQ(Encode(mesh, LevelChoice::kWhereTheyPay), "");
}

// Twice the components take twice the time, about.
TEST(EncodeRobustnessTest, TimeGoesWithTheNumberOfComponents) {
  const auto seconds = [](uint32_t num_components) {
    const TriangleMesh mesh = shapes::Scattered(shapes::Tetrahedron(), num_components);
    const double begin = static_cast<double>(std::clock());
    EncodeOptions options = Options(LevelChoice::kWhereTheyPay);
    options.target.value = 66;
    const EncodedMesh encoded = EncodeMesh(mesh, options).value();
    const double end = static_cast<double>(std::clock());
    EXPECT_GE(encoded.report.levels.back().psnr, 66);
    EXPECT_LE(encoded.report.levels.back().psnr, 68);  // few steps are tried
    EXPECT_LT(static_cast<double>(encoded.stream.size()), 9.5 * num_components);
    return (end - begin) / CLOCKS_PER_SEC;
  };
  const double once = seconds(20'000), twice = seconds(40'000);
  EXPECT_LT(twice, kMostSeconds / 2);
  EXPECT_LT(twice, 4 * once);
  EXPECT_GT(twice, 1.2 * once);
}

// Every query of a closest point looks at a share of all triangles here, so that there may not be many queries.
TEST(EncodeRobustnessTest, SoupsAreEncodedAsTheyAre) {
  for (const uint32_t num_triangles : {1'500u, 20'000u}) {
    std::mt19937 random(num_triangles);
    const auto coordinate = [&] { return static_cast<float>(random() % 10001) / 5000 - 1; };
    TriangleMesh mesh;
    for (uint32_t f = 0; f < num_triangles; ++f) {
      for (int k = 0; k < 3; ++k) mesh.positions.push_back({coordinate(), coordinate(), coordinate()});
      mesh.triangles.push_back({3 * f, 3 * f + 1, 3 * f + 2});
    }
    EXPECT_EQ(Encode(mesh, LevelChoice::kWhereTheyPay), "");
    if (num_triangles > 1'500u) continue;
    const EncodedMesh encoded = EncodeMesh(mesh, Options(LevelChoice::kAlways)).value();
    EXPECT_THAT(encoded.report.reason, HasSubstr("go through each other"));
    EXPECT_EQ(encoded.report.levels.back().triangles, num_triangles);
    EXPECT_GE(encoded.report.levels.back().psnr, 48.0);
    EXPECT_LE(encoded.report.levels.back().psnr, 48.5);
  }
}

// Far from zero floats are coarse: from steps of 1/128 of the radius to triangles that fall together.
// At every level the edges where three sheets meet are edges of all three, and no border comes off them.
TEST(EncodeRobustnessTest, ThreeSheetsStayJoinedWhereTheyMeet) {
  constexpr uint32_t kRows = 32;
  EncodeOptions options;
  options.target.value = 60.0;
  options.levels = LevelChoice::kAlways;
  const EncodedMesh encoded = EncodeMesh(shapes::SheetsAroundACurve(3, kRows, 24), options).value();
  const int num_levels = DecodeMesh(encoded.stream, {}).value().num_levels;
  ASSERT_GE(num_levels, 1);
  for (int level = 0; level <= num_levels; ++level) {
    SCOPED_TRACE(level);
    DecodeOptions decode;
    decode.max_level = level;
    const TriangleMesh mesh = DecodeMesh(encoded.stream, decode).value().mesh;
    std::map<std::array<float, 3>, uint32_t> points;
    std::map<std::pair<uint32_t, uint32_t>, int> num_faces;
    std::vector<Vec3f> places;
    const auto point = [&](uint32_t v) {
      const Vec3f& p = mesh.positions[v];
      const auto [found, is_new] = points.emplace(std::array<float, 3>{p.x, p.y, p.z}, static_cast<uint32_t>(places.size()));
      if (is_new) places.push_back(p);
      return found->second;
    };
    for (const Triangle& t : mesh.triangles) {
      for (size_t k = 0; k < 3; ++k) {
        const uint32_t a = point(t[k]), b = point(t[(k + 1) % 3]);
        ++num_faces[{std::min(a, b), std::max(a, b)}];
      }
    }
    const auto is_near = [](const Vec3f& p) { return std::hypot(p.x - 2 * std::sin(0.2f * p.z), p.y - 2 * std::cos(0.15f * p.z)) < 3; };
    float joined = 0, parted = 0;  // lengths along the curve
    for (const auto& [edge, count] : num_faces) {
      const Vec3f &p = places[edge.first], &q = places[edge.second];
      const float height = std::abs(p.z - q.z);
      if (count == 3) joined += height;
      if (count == 1 && is_near(p) && is_near(q) && height > 0.1f) parted += height;
    }
    EXPECT_GT(joined, 0.98f * kRows);
    EXPECT_LT(parted, 0.02f * kRows);
  }
}

TEST(EncodeRobustnessTest, SurfacesFarFromZeroAreEncoded) {
  const TriangleMesh scan = shapes::BumpySphere(5, 0.2f, 0.002f);
  for (const float offset : {1e5f, 1e6f, 1e7f}) EXPECT_EQ(Encode(Moved(scan, 1.0f, {offset, offset, offset}), LevelChoice::kWhereTheyPay), "") << offset;
}

// Coordinates of a far corner round differently, and lattices fit differently; otherwise bytes are a matter of shape.
TEST(EncodeRobustnessTest, PlaceSizeAndOrderHardlyChangeTheBytes) {
  const TriangleMesh mesh = Bumpy();
  TriangleMesh turned = mesh, reordered = mesh, renumbered = mesh;
  for (Vec3f& p : turned.positions) p = {0.8f * p.x - 0.6f * p.y, 0.6f * p.x + 0.8f * p.y, p.z};
  std::mt19937 random(6);
  std::shuffle(reordered.triangles.begin(), reordered.triangles.end(), random);
  for (Triangle& t : reordered.triangles) std::rotate(t.begin(), t.begin() + random() % 3, t.end());
  std::reverse(renumbered.positions.begin(), renumbered.positions.end());
  const auto last = static_cast<uint32_t>(mesh.positions.size() - 1);
  for (Triangle& t : renumbered.triangles) t = {last - t[0], last - t[1], last - t[2]};
  const auto encode = [](const TriangleMesh& input) { return EncodeMesh(input, Options(LevelChoice::kAlways)).value(); };
  const EncodedMesh plain = encode(mesh);
  ASSERT_TRUE(plain.report.progressive);
  const auto bytes = static_cast<double>(plain.stream.size());
  const TriangleMesh far = Moved(mesh, 1.0f, {2000, -3000, 100});  // 1,000 diagonals
  for (const TriangleMesh& other : {Moved(mesh, 1000.0f, {}), Moved(mesh, 1e-6f, {}), Moved(mesh, 1.0f, {3, -2, 1}), far, turned, reordered, renumbered}) {
    const EncodedMesh encoded = encode(other);
    EXPECT_NEAR(static_cast<double>(encoded.stream.size()), bytes, 0.15 * bytes);
    EXPECT_NEAR(encoded.report.levels.back().psnr, plain.report.levels.back().psnr, 0.5);  // both over the target; so small a stream jumps
  }
}

}  // namespace
}  // namespace lacerta
