// Encoding with less memory than is usual: targets are kept, to the input itself, from both sides.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <map>
#include <utility>

#include "bench/heap_meter.h"
#include "lacerta/codec.h"
#include "lacerta/surface_distance.h"
#include "shapes/shapes.h"

namespace lacerta {
namespace {

using Kind = EncodeTarget::Kind;
using ::testing::HasSubstr;

// For inputs of 75,000 to 330,000 triangles: 50,000 or few more stand for them.
constexpr uint64_t kLittle = 190'000'000;

EncodeOptions OptionsFor(Kind kind, double value, uint64_t memory = kLittle) {
  EncodeOptions options;
  options.target = {kind, value};
  options.effort = Effort::kFast;
  options.levels = LevelChoice::kAlways;
  options.memory = memory;
  return options;
}

TriangleMesh Together(TriangleMesh a, const TriangleMesh& b, const Vec3f& by) {
  const auto first = static_cast<uint32_t>(a.positions.size());
  for (const Vec3f& p : b.positions) a.positions.push_back(p + by);
  for (const Triangle& t : b.triangles) a.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  return a;
}

size_t NumBorderEdges(const TriangleMesh& mesh) {
  std::map<std::pair<uint32_t, uint32_t>, int> faces;
  for (const Triangle& t : mesh.triangles) {
    for (int k = 0; k < 3; ++k) ++faces[std::minmax(t[k], t[(k + 1) % 3])];
  }
  return static_cast<size_t>(std::count_if(faces.begin(), faces.end(), [](const auto& edge) { return edge.second == 1; }));
}

struct Case {
  const char* name;
  TriangleMesh mesh;
  double psnr;
  bool has_border;
};

std::vector<Case> Cases() {
  return {{"closed", shapes::BumpySphere(6, 0.1f, 0.0005f), 62, false},
          {"bordered", shapes::GridWithBorder(200, 190, 0.3f), 70, true},
          {"several components", Together(shapes::Torus(200, 100), shapes::BumpySphere(5, 0.2f), {3, 0, 0}), 62, false},
          {"creased", shapes::TwoHoledPlate(40), 60, false}};
}

TEST(EncodeWithinMemoryTest, KeepsPsnrFromBothSidesWithoutCracks) {
  for (const Case& c : Cases()) {
    SCOPED_TRACE(c.name);
    const EncodedMesh encoded = EncodeMesh(c.mesh, OptionsFor(Kind::kPsnr, c.psnr)).value();
    const TriangleMesh decoded = DecodeMesh(encoded.stream, {}).value().mesh;
    // By the usual meter: what was reported was measured by the lean one.
    const SurfaceDistance distance = MeasureSurfaceDistance(c.mesh, decoded).value();
    const double psnr = Psnr(distance.Rms(), BoundingBoxDiagonal(c.mesh)), reported = encoded.report.levels.back().psnr;
    EXPECT_NEAR(psnr, reported, 0.05);
    EXPECT_GE(reported, c.psnr);
    EXPECT_LT(reported, c.psnr + (encoded.report.reason.empty() ? 0.3 : 12)) << encoded.report.reason;
    EXPECT_LE(distance.Hausdorff(), 0.02 * BoundingBoxDiagonal(c.mesh));  // no part is missing
    EXPECT_EQ(NumBorderEdges(decoded) > 0, c.has_border);
    EXPECT_EQ(encoded.report.input_triangles, c.mesh.triangles.size());
    EXPECT_EQ(encoded.report.diagonal, BoundingBoxDiagonal(c.mesh));
    for (size_t level = 1; level < encoded.report.levels.size(); ++level) {
      EXPECT_GE(encoded.report.levels[level].psnr, encoded.report.levels[level - 1].psnr - 0.1);
    }
  }
}

TEST(EncodeWithinMemoryTest, KeepsOtherTargets) {
  const TriangleMesh mesh = shapes::BumpySphere(6, 0.1f, 0.0005f);
  const double diagonal = BoundingBoxDiagonal(mesh);
  const EncodedMesh bytes = EncodeMesh(mesh, OptionsFor(Kind::kBytes, 1500)).value();
  EXPECT_LE(bytes.stream.size(), 1500u);
  EXPECT_GE(bytes.stream.size(), 1470u);
  EXPECT_NEAR(bytes.report.levels.back().psnr, Psnr(MeasureSurfaceDistance(mesh, DecodeMesh(bytes.stream, {}).value().mesh).value().Rms(), diagonal), 0.05);
  const EncodedMesh error = EncodeMesh(mesh, OptionsFor(Kind::kError, 0.001)).value();
  EXPECT_LE(error.report.levels.back().error, 0.001 * diagonal);
  EXPECT_GE(error.report.levels.back().error, 0.0009 * diagonal);
}

// Bytes are about as many as without a limit.
TEST(EncodeWithinMemoryTest, TakesHardlyMoreBytes) {
  const TriangleMesh mesh = shapes::BumpySphere(6, 0.1f, 0.0005f);
  const size_t within = EncodeMesh(mesh, OptionsFor(Kind::kPsnr, 60)).value().stream.size();
  const size_t usual = EncodeMesh(mesh, OptionsFor(Kind::kPsnr, 60, 0)).value().stream.size();
  EXPECT_NE(within, usual);  // it went another way
  EXPECT_LE(within, usual + usual / 8);
  EXPECT_GE(within, usual - usual / 8);
}

TEST(EncodeWithinMemoryTest, DoesNotDependOnTheNumberOfThreads) {
  const TriangleMesh mesh = shapes::BumpySphere(6, 0.1f, 0.0005f);
  const Bytes many = EncodeMesh(mesh, OptionsFor(Kind::kPsnr, 55)).value().stream;
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(EncodeMesh(mesh, OptionsFor(Kind::kPsnr, 55)).value().stream, many);
  EXPECT_EQ(EncodeMesh(TriangleMesh(mesh), OptionsFor(Kind::kPsnr, 55)).value().stream, many);  // as one that may be used up
}

// What so few triangles cannot follow is told, with the reason, not promised: noise beyond the target.
TEST(EncodeWithinMemoryTest, TellsWhereMemoryIsTooLittleForTheTarget) {
  const EncodedMesh encoded = EncodeMesh(shapes::BumpySphere(6, 0.1f, 0.003f), OptionsFor(Kind::kPsnr, 75)).value();
  EXPECT_LT(encoded.report.levels.back().psnr, 75);
  EXPECT_THAT(encoded.report.reason, HasSubstr("the memory allowed holds the input to"));
}

TEST(EncodeWithinMemoryTest, IsRefusedWhereNothingCouldStandForTheInput) {
  const StatusOr<EncodedMesh> encoded = EncodeMesh(shapes::BumpySphere(6), OptionsFor(Kind::kPsnr, 60, 150'000'000));
  EXPECT_EQ(encoded.status().code(), StatusCode::kLimitExceeded);
  EXPECT_THAT(encoded.status().message(), HasSubstr("81920 triangles take at least 173 MB, of which 150 are allowed"));
}

#ifdef LACERTA_HEAP_METER
size_t PeakOf(const TriangleMesh& mesh, uint64_t memory) {
  TriangleMesh input = mesh;
  ResetHeapPeak();
  const size_t before = HeapInUse();
  EXPECT_TRUE(EncodeMesh(std::move(input), OptionsFor(Kind::kPsnr, 62, memory)).ok());
  return HeapPeak() - before;
}

TEST(EncodeWithinMemoryTest, TakesNoMoreThanIsAllowed) {
  const TriangleMesh mesh = shapes::BumpySphere(7, 0.1f, 0.0005f);  // 327,680 triangles
  const size_t usual = PeakOf(mesh, 0), within = PeakOf(mesh, kLittle);
  EXPECT_GT(usual, kLittle);
  EXPECT_LT(within, kLittle);
  EXPECT_LT(within, usual / 2);
}

// Where the heap gives less than was planned with, another try with less of it succeeds.
TEST(EncodeWithinMemoryTest, TriesWithLessWhereAllocationsFail) {
  const TriangleMesh mesh = shapes::BumpySphere(7, 0.1f, 0.0005f);
  const size_t usual = PeakOf(mesh, 500'000'000);
  SetHeapLimit(HeapInUse() + usual * 3 / 4);
  const StatusOr<EncodedMesh> encoded = EncodeMesh(mesh, OptionsFor(Kind::kPsnr, 62, 500'000'000));
  SetHeapLimit(0);
  ASSERT_TRUE(encoded.ok()) << encoded.status().message();
  EXPECT_GE(encoded.value().report.levels.back().psnr, 62);
}
#endif

}  // namespace
}  // namespace lacerta
