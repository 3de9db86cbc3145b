// Encoding with less memory than is usual: targets are kept, to the input itself, from both sides.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <map>
#include <utility>

#include "bench/heap_meter.h"
#include "draco/encode_mesh.h"
#include "lacerta/codec.h"
#include "lacerta/surface_distance.h"
#include "shapes/base_meshes.h"
#include "shapes/shapes.h"

namespace lacerta {
namespace {

using Kind = EncodeTarget::Kind;
using ::testing::HasSubstr;
using ::testing::Not;

EncodeOptions OptionsFor(Kind kind, double value, uint64_t memory = 0) {
  EncodeOptions options;
  options.target = {kind, value};
  options.effort = Effort::kFast;
  options.levels = LevelChoice::kAlways;
  options.memory = memory;
  return options;
}

// As PlanMemory makes it, for inputs a tenth as large.
MemoryPlan Tight() {
  MemoryPlan plan;
  plan.is_lean = true;
  plan.may_unsubdivide = false;
  plan.proxy.fewest_triangles = 3000;
  plan.proxy.most_triangles = 6000;
  plan.proxy.most_as_a_whole = 10'000;
  plan.proxy.part_triangles = 4000;
  return plan;
}

TriangleMesh Scan(float noise = 0.0005f) { return shapes::BumpySphere(5, 0.1f, noise); }  // 20,480 triangles

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
  return {{"closed", Scan(), 58, false},
          {"bordered", shapes::GridWithBorder(101, 90, 0.3f), 65, true},
          {"several components", Together(shapes::Torus(100, 50), shapes::BumpySphere(4, 0.2f), {3, 0, 0}), 56, false},
          {"creased", shapes::TwoHoledPlate(15), 60, false}};
}

TEST(EncodeWithinMemoryTest, KeepsPsnrFromBothSidesWithoutCracks) {
  for (const Case& c : Cases()) {
    SCOPED_TRACE(c.name);
    const EncodedMesh encoded = EncodeLean(c.mesh, OptionsFor(Kind::kPsnr, c.psnr), Tight()).value();
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
      EXPECT_GE(encoded.report.levels[level].psnr, encoded.report.levels[level - 1].psnr - 0.5);
    }
  }
}

TEST(EncodeWithinMemoryTest, KeepsOtherTargets) {
  const TriangleMesh mesh = Scan();
  const double diagonal = BoundingBoxDiagonal(mesh);
  const EncodedMesh bytes = EncodeLean(mesh, OptionsFor(Kind::kBytes, 800), Tight()).value();
  EXPECT_LE(bytes.stream.size(), 800u);
  EXPECT_GE(bytes.stream.size(), 784u);
  EXPECT_NEAR(bytes.report.levels.back().psnr, Psnr(MeasureSurfaceDistance(mesh, DecodeMesh(bytes.stream, {}).value().mesh).value().Rms(), diagonal), 0.05);
  const EncodedMesh error = EncodeLean(mesh, OptionsFor(Kind::kError, 0.0015), Tight()).value();
  EXPECT_LE(error.report.levels.back().error, 0.0015 * diagonal);
  EXPECT_GE(error.report.levels.back().error, 0.00135 * diagonal);
}

TEST(EncodeWithinMemoryTest, TakesHardlyMoreBytes) {
  const TriangleMesh mesh = shapes::WithEdgeFlipped(Scan(), 1000);  // which is not a subdivided one
  const Bytes stream = EncodeLean(mesh, OptionsFor(Kind::kPsnr, 55), Tight()).value().stream;
  const Bytes usual_stream = EncodeMesh(mesh, OptionsFor(Kind::kPsnr, 55)).value().stream;
  EXPECT_NE(stream, usual_stream);  // it went another way
  const size_t within = stream.size(), usual = usual_stream.size();
  EXPECT_LE(within, usual + usual / 8);
  EXPECT_GE(within, usual - usual / 8);
}

TEST(EncodeWithinMemoryTest, DoesNotDependOnTheNumberOfThreads) {
  const Bytes many = EncodeLean(Scan(), OptionsFor(Kind::kPsnr, 50), Tight()).value().stream;
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  EXPECT_EQ(EncodeLean(Scan(), OptionsFor(Kind::kPsnr, 50), Tight()).value().stream, many);
}

// What so few triangles cannot follow is told, with the reason, not promised.
TEST(EncodeWithinMemoryTest, TellsWhereMemoryIsTooLittleForTheTarget) {
  MemoryPlan plan = Tight();
  plan.proxy.fewest_triangles = 200;
  plan.proxy.most_triangles = 500;
  const EncodedMesh encoded = EncodeLean(Scan(), OptionsFor(Kind::kPsnr, 65), plan).value();
  EXPECT_LT(encoded.report.levels.back().psnr, 65);
  EXPECT_THAT(encoded.report.reason, HasSubstr("the memory allowed holds the input to"));
  const EncodedMesh enough = EncodeLean(Scan(), OptionsFor(Kind::kPsnr, 48), plan).value();
  EXPECT_GE(enough.report.levels.back().psnr, 48);
  EXPECT_THAT(enough.report.reason, Not(HasSubstr("the memory allowed")));
}

TEST(EncodeWithinMemoryTest, IsRefusedWhereNothingCouldStandForTheInput) {
  const StatusOr<EncodedMesh> encoded = EncodeMesh(shapes::BumpySphere(6), OptionsFor(Kind::kPsnr, 60, 150'000'000));
  EXPECT_EQ(encoded.status().code(), StatusCode::kLimitExceeded);
  EXPECT_THAT(encoded.status().message(), HasSubstr("81920 triangles take at least 198 MB, of which 150 are allowed"));
}

#ifdef LACERTA_HEAP_METER
// Of encoding a mesh that may be used up.
size_t PeakOf(const TriangleMesh& mesh, uint64_t memory) {
  TriangleMesh input = mesh;
  ResetHeapPeak();
  const size_t before = HeapInUse();
  EXPECT_TRUE(EncodeMesh(std::move(input), OptionsFor(Kind::kPsnr, 45, memory)).ok());
  return HeapPeak() - before;
}

// The input itself is left out of the figures: it is there before.
TEST(EncodeWithinMemoryTest, TakesNoMoreThanIsAllowed) {
  constexpr uint64_t kLittle = 230'000'000;
  const TriangleMesh mesh = shapes::WithEdgeFlipped(shapes::BumpySphere(7, 0.1f, 0.0005f), 1000);  // 327,680 triangles
  const size_t usual = PeakOf(mesh, 0), within = PeakOf(mesh, kLittle);
  EXPECT_GT(usual, kLittle);
  EXPECT_LT(within, kLittle);
  EXPECT_LT(within, usual / 2);
}

// Where the heap gives less than was planned with, another try with less of it succeeds.
TEST(EncodeWithinMemoryTest, TriesWithLessWhereAllocationsFail) {
  constexpr uint64_t kMuch = 800'000'000;
  const TriangleMesh mesh = shapes::WithEdgeFlipped(shapes::BumpySphere(7, 0.1f, 0.003f), 1000);
  const size_t most = PeakOf(mesh, kMuch);  // for all of the input simplified as a whole
  SetHeapLimit(HeapInUse() + most * 9 / 10);
  const StatusOr<EncodedMesh> encoded = EncodeMesh(TriangleMesh(mesh), OptionsFor(Kind::kPsnr, 45, kMuch));
  SetHeapLimit(0);
  ASSERT_TRUE(encoded.ok()) << encoded.status().message();
  EXPECT_GE(encoded.value().report.levels.back().psnr, 45);
}
#endif

}  // namespace
}  // namespace lacerta
