// The encode page: what goes in, what is promised of what comes out.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "draco/mesh_conversion.h"
#include "lacerta/codec.h"
#include "lacerta/draco.h"
#include "lacerta/surface_distance.h"
#include "shapes/base_meshes.h"
#include "lacerta/decoder.h"
#include "draco/custom_form.h"
#include "shapes/shapes.h"

namespace lacerta {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;
using Kind = EncodeTarget::Kind;

// One flipped edge, and an odd number of triangles around: no subdivision connectivity.
TriangleMesh Scan() { return shapes::WithEdgeFlipped(shapes::BumpySphere(4, 0.2f, 0.002f), 1000); }
TriangleMesh Ring() { return shapes::Torus(63, 32); }

EncodeOptions OptionsFor(Kind kind, double value, StreamForm form = StreamForm::kDraco) {
  EncodeOptions options;
  options.target = {kind, value};
  options.form = form;
  options.levels = LevelChoice::kAlways;  // shapes as small as these hardly need any
  return options;
}

EncodedMesh EncodeOrDie(const TriangleMesh& mesh, const EncodeOptions& options) {
  StatusOr<EncodedMesh> encoded = EncodeMesh(mesh, options);
  EXPECT_TRUE(encoded.ok()) << encoded.status().message();
  return encoded.ok() ? std::move(encoded.value()) : EncodedMesh();
}

// Measured from the stream alone.
double DecodedPsnr(const TriangleMesh& original, const Bytes& stream, int level) {
  DecodeOptions options;
  options.max_level = level;
  const SurfaceDistance distance = MeasureSurfaceDistance(original, DecodeMesh(stream, options).value().mesh).value();
  return Psnr(distance.Rms(), BoundingBoxDiagonal(original));
}

TEST(EncodeMeshTest, KeepsPsnrTargetsFromBothSides) {
  for (const TriangleMesh& mesh : {Scan(), Ring()}) {
    for (const double target : {54.0}) {
      const EncodedMesh encoded = EncodeOrDie(mesh, OptionsFor(Kind::kPsnr, target));
      ASSERT_TRUE(encoded.report.progressive) << encoded.report.reason;
      const int finest = static_cast<int>(encoded.report.levels.size()) - 1;
      const double psnr = DecodedPsnr(mesh, encoded.stream, finest);
      EXPECT_GE(psnr, target);
      EXPECT_LT(psnr, target + 0.3);
      EXPECT_EQ(encoded.report.reason, "");
      EXPECT_GE(encoded.report.measurements, 2);
      EXPECT_LE(encoded.report.measurements, 8);  // 6 but for the jumps in the curve of so small a mesh
    }
  }
}

TEST(EncodeMeshTest, KeepsRateTargetsFromBothSides) {
  const TriangleMesh mesh = Scan();
  const auto num_vertices = static_cast<double>(mesh.positions.size());
  for (const double bits_per_vertex : {2.0}) {
    const EncodedMesh encoded = EncodeOrDie(mesh, OptionsFor(Kind::kBitsPerVertex, bits_per_vertex));
    ASSERT_TRUE(encoded.report.progressive) << encoded.report.reason;
    const double rate = 8 * static_cast<double>(encoded.stream.size()) / num_vertices;
    EXPECT_LE(rate, bits_per_vertex);
    EXPECT_GE(rate, 0.98 * bits_per_vertex);
  }
}

TEST(EncodeMeshTest, CustomFormKeepsRateTargetsToo) {
  const EncodedMesh encoded = EncodeOrDie(Scan(), OptionsFor(Kind::kBytes, 800, StreamForm::kCustom));
  ASSERT_TRUE(encoded.report.progressive) << encoded.report.reason;
  EXPECT_LE(encoded.stream.size(), 800u);
  EXPECT_GE(encoded.stream.size(), 784u);
  EXPECT_EQ(encoded.report.levels.back().bytes, encoded.stream.size());
}

// Nothing of stock Draco is in it, and that is less.
TEST(EncodeMeshTest, CustomFormHoldsACompactBase) {
  TriangleMesh parts = Scan();  // with a small part, which stands still
  const auto offset = static_cast<uint32_t>(parts.positions.size());
  const TriangleMesh small = shapes::Icosphere(1, 0.1f);
  for (const Vec3f& p : small.positions) parts.positions.push_back(p + Vec3f{1.5f, 0, 0});
  for (const Triangle& t : small.triangles) parts.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  for (const LevelChoice levels : {LevelChoice::kAlways, LevelChoice::kNever}) {
    EncodeOptions options = OptionsFor(Kind::kPsnr, 50);
    options.levels = levels;
    const EncodedMesh stock = EncodeOrDie(parts, options);
    options.form = StreamForm::kCustom;
    const EncodedMesh custom = EncodeOrDie(parts, options);
    const StatusOr<StreamParts> split = SplitCustomForm(custom.stream);
    ASSERT_TRUE(split.ok()) << split.status().message();
    EXPECT_EQ(split.value().coding, BaseCoding::kCompact);
    EXPECT_EQ(split.value().refinement.empty(), levels == LevelChoice::kNever);
    EXPECT_TRUE(DecodeCompactBase(split.value().base, {}).ok());
    // Each search ends at its own base size and up to 0.3 dB over the target, so the sizes say little more than which is less.
    EXPECT_LT(custom.stream.size(), stock.stream.size());
    EXPECT_GT(static_cast<double>(custom.stream.size()), 0.6 * static_cast<double>(stock.stream.size()));
    EXPECT_GE(DecodedPsnr(parts, custom.stream, 99), 50);
    EXPECT_EQ(DecodeMesh(custom.stream, DecodeOptions()).value().mesh.triangles.size(), custom.report.levels.back().triangles);
  }
}

TEST(EncodeMeshTest, BestEffortIsNeverLargerAndSometimesSmaller) {
  size_t smaller = 0;
  for (const TriangleMesh& mesh : {Scan(), Ring()}) {
    for (const double psnr : {48.0, 52.0, 56.0}) {
      EncodeOptions options = OptionsFor(Kind::kPsnr, psnr);
      const size_t normal = EncodeOrDie(mesh, options).stream.size();
      options.effort = Effort::kBest;
      const size_t best = EncodeOrDie(mesh, options).stream.size();
      EXPECT_LE(best, normal) << psnr << " dB";
      EXPECT_GE(static_cast<double>(best), 0.75 * static_cast<double>(normal)) << psnr << " dB";
      smaller += best < normal;
    }
  }
  EXPECT_GT(smaller, 0u);
}

TEST(EncodeMeshTest, ErrorTargetIsThePsnrTargetInAnotherUnit) {
  const EncodedMesh error = EncodeOrDie(Scan(), OptionsFor(Kind::kError, 3.1622776601683794e-3));
  const EncodedMesh psnr = EncodeOrDie(Scan(), OptionsFor(Kind::kPsnr, 50));
  EXPECT_LE(error.report.levels.back().error, 3.1622776601683795e-3 * error.report.diagonal);
  EXPECT_NEAR(error.report.levels.back().psnr, psnr.report.levels.back().psnr, 0.3);
}

TEST(EncodeMeshTest, DistanceTargetIsTheErrorTargetInUnitsOfTheMesh) {
  const EncodedMesh error = EncodeOrDie(Scan(), OptionsFor(Kind::kError, 3.1622776601683794e-3));
  const double most = 3.1622776601683794e-3 * error.report.diagonal;
  const EncodedMesh distance = EncodeOrDie(Scan(), OptionsFor(Kind::kDistance, most));
  EXPECT_LE(distance.report.levels.back().error, most);
  EXPECT_GE(distance.report.levels.back().error, 0.96 * most);
  EXPECT_EQ(distance.stream.size(), error.stream.size());
}

TEST(EncodeMeshTest, ReportsWhatTheStreamHolds) {
  const TriangleMesh mesh = Scan();
  const EncodedMesh encoded = EncodeOrDie(mesh, OptionsFor(Kind::kPsnr, 50));
  const EncodeReport& report = encoded.report;
  EXPECT_EQ(report.input_vertices, mesh.positions.size());
  EXPECT_EQ(report.input_triangles, mesh.triangles.size());
  ASSERT_EQ(report.levels.size(), encoded.part_sizes.size());
  EXPECT_EQ(std::accumulate(encoded.part_sizes.begin(), encoded.part_sizes.end(), size_t{0}), encoded.stream.size());
  for (size_t level = 0; level < report.levels.size(); ++level) {
    DecodeOptions options;
    options.max_level = static_cast<int>(level);
    const DecodedMesh decoded = DecodeMesh(encoded.stream, options).value();
    EXPECT_EQ(decoded.mesh.positions.size(), report.levels[level].vertices);
    EXPECT_EQ(decoded.mesh.triangles.size(), report.levels[level].triangles);
    // Coarse levels are measured with 50,000 samples, and here with 200,000. That is the error of few samples: at level 2 six seeds say
    // 48.97 to 49.00 dB with 50,000, 48.95 to 48.96 with 200,000, and two 48.964 with 8,000,000.
    const double noise = level + 1 < report.levels.size() ? 5e-2 : 2e-2;
    EXPECT_NEAR(DecodedPsnr(mesh, encoded.stream, static_cast<int>(level)), report.levels[level].psnr, noise);
  }
  EXPECT_GT(report.remesh_psnr, report.levels.back().psnr);
  EXPECT_GT(report.normal_share, 0.5);
  EXPECT_LE(report.normal_share, 1.0);
}

TEST(EncodeMeshTest, EveryPrefixDecodesToItsLastCompleteLevel) {
  for (const StreamForm form : {StreamForm::kDraco, StreamForm::kCustom}) {
    const EncodedMesh encoded = EncodeOrDie(Scan(), OptionsFor(Kind::kPsnr, 50, form));
    ASSERT_GE(encoded.part_sizes.size(), 3u);
    size_t complete = encoded.part_sizes[0];
    int level = 0;
    for (size_t length = 0; length <= encoded.stream.size(); ++length) {
      const Bytes prefix(encoded.stream.begin(), encoded.stream.begin() + static_cast<std::ptrdiff_t>(length));
      const StatusOr<DecodedMesh> decoded = DecodeMesh(prefix, DecodeOptions());
      if (length < encoded.part_sizes[0]) {
        EXPECT_FALSE(decoded.ok()) << "prefix of " << length << " bytes, base of " << encoded.part_sizes[0];
        continue;
      }
      while (static_cast<size_t>(level) + 1 < encoded.part_sizes.size() &&
             complete + encoded.part_sizes[static_cast<size_t>(level) + 1] <= length) {
        complete += encoded.part_sizes[static_cast<size_t>(++level)];
      }
      ASSERT_TRUE(decoded.ok()) << "prefix of " << length << " bytes: " << decoded.status().message();
      EXPECT_EQ(decoded.value().level, level) << "prefix of " << length << " bytes";
      // A cut within a segment is reported; a stream that ends with its base is a stock stream, whole as it is.
      const bool whole = length == encoded.part_sizes[0] || length == encoded.stream.size();
      EXPECT_EQ(decoded.value().refinement.ok(), whole) << decoded.value().refinement.message();
    }
    EXPECT_EQ(level, static_cast<int>(encoded.part_sizes.size()) - 1);
  }
}

TEST(EncodeMeshTest, StatesOfLayersComeNearerAndNearer) {
  for (const StreamForm form : {StreamForm::kDraco, StreamForm::kCustom}) {
    EncodeOptions options = OptionsFor(Kind::kPsnr, 54, form);
    options.quality_layers = 3;
    const EncodedMesh encoded = EncodeOrDie(Scan(), options);
    EXPECT_GE(encoded.report.levels.back().psnr, 54);
    EXPECT_LT(encoded.report.levels.back().psnr, 54.45);  // a coefficient of so small a mesh is worth 0.5 dB
    ASSERT_EQ(encoded.part_sizes.size(), encoded.report.levels.size());
    const bool is_layered = DecodeMesh(encoded.stream, {}).value().has_layers;
    EXPECT_TRUE(is_layered);
    size_t end = 0;
    for (size_t i = 0; i < encoded.part_sizes.size(); ++i) {
      end += encoded.part_sizes[i];
      const Bytes prefix(encoded.stream.begin(), encoded.stream.begin() + static_cast<std::ptrdiff_t>(end));
      const DecodedMesh decoded = DecodeMesh(prefix, {}).value();
      const LevelReport& told = encoded.report.levels[i];
      EXPECT_EQ(decoded.state, static_cast<int>(i));
      EXPECT_EQ(decoded.mesh.positions.size(), told.vertices);
      EXPECT_EQ(decoded.mesh.triangles.size(), told.triangles);
      EXPECT_EQ(end, told.bytes);
      EXPECT_GE(told.psnr, encoded.report.levels[i > 0 ? i - 1 : 0].psnr);
    }
    EXPECT_EQ(end, encoded.stream.size());
  }
  EncodeOptions options = OptionsFor(Kind::kPsnr, 54);
  for (const int layers : {0, 9}) {
    options.quality_layers = layers;
    EXPECT_EQ(EncodeMesh(Scan(), options).status().code(), StatusCode::kInvalidArgument);
  }
}

TEST(EncodeMeshTest, SameBytesOnOneThreadAndOnTwo) {
  EncodeOptions options = OptionsFor(Kind::kPsnr, 50);
  for (const LevelChoice levels : {LevelChoice::kAlways, LevelChoice::kNever}) {
    options.levels = levels;
    std::vector<Bytes> streams;
    for (const size_t threads : {1, 2}) {
      const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
      streams.push_back(EncodeOrDie(Scan(), options).stream);
    }
    EXPECT_EQ(streams[0], streams[1]);
  }
}

TEST(EncodeMeshTest, LevelsAreLeftOutWhereTheyDoNotPay) {
  EncodeOptions options = OptionsFor(Kind::kPsnr, 54);
  const EncodedMesh always = EncodeOrDie(Ring(), options);
  options.levels = LevelChoice::kNever;
  const EncodedMesh never = EncodeOrDie(Ring(), options);
  options.levels = LevelChoice::kWhereTheyPay;
  const EncodedMesh best = EncodeOrDie(Ring(), options);
  EXPECT_TRUE(always.report.progressive);
  EXPECT_FALSE(never.report.progressive);
  EXPECT_EQ(best.report.progressive, 100 * never.stream.size() >= 95 * always.stream.size());
  EXPECT_EQ(best.stream.size(), best.report.progressive ? always.stream.size() : never.stream.size());
}

TEST(EncodeMeshTest, BordersCutsAndSmallPartsAreRefinedOrStandStill) {
  TriangleMesh mesh = shapes::BumpySphere(4, 0.2f, 0.002f);
  const auto offset = static_cast<uint32_t>(mesh.positions.size());
  const TriangleMesh chip = shapes::GridWithBorder(4, 4, 0.3f);
  for (const Vec3f& p : chip.positions) mesh.positions.push_back(p + Vec3f{3, 0, 0});
  for (const Triangle& t : chip.triangles) mesh.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  mesh.triangles.erase(mesh.triangles.begin() + 100, mesh.triangles.begin() + 107);
  const EncodedMesh encoded = EncodeOrDie(mesh, OptionsFor(Kind::kPsnr, 60));
  ASSERT_TRUE(encoded.report.progressive) << encoded.report.reason;
  EXPECT_EQ(encoded.report.parts.refined_components, 1u);
  EXPECT_EQ(encoded.report.parts.still_components, 2u) << "the chip, and what the cut left alone of the sphere";
  EXPECT_GE(DecodedPsnr(mesh, encoded.stream, static_cast<int>(encoded.report.levels.size()) - 1), 60.0);
}

TEST(EncodeMeshTest, WhatCannotBeRemeshedIsAStockStreamWithTheReason) {
  const std::vector<std::pair<TriangleMesh, std::string>> cases = {
      {shapes::Pinched(), "no component has triangles enough"},
      {shapes::NonManifoldEdge(), "no component has triangles enough"},
      {shapes::Icosphere(0), "no component has triangles enough"},
      {{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{{0, 1, 2}}}}, "no component has triangles enough"}};
  for (const auto& [mesh, reason] : cases) {
    const EncodedMesh encoded = EncodeOrDie(mesh, OptionsFor(Kind::kPsnr, 70));
    EXPECT_FALSE(encoded.report.progressive);
    EXPECT_THAT(encoded.report.reason, HasSubstr(reason));
    ASSERT_EQ(encoded.report.levels.size(), 1u);
    EXPECT_GE(encoded.report.levels[0].psnr, 70.0);
    const DecodedMesh decoded = DecodeMesh(encoded.stream, DecodeOptions()).value();
    EXPECT_EQ(decoded.num_levels, 0);
    EXPECT_EQ(decoded.mesh.triangles.size(), encoded.report.input_triangles);
    EXPECT_GE(DecodedPsnr(mesh, encoded.stream, 0), 70.0);
  }
}

// The input vertex nearest to each decoded one.
std::vector<uint32_t> NearestVertices(const TriangleMesh& decoded, const TriangleMesh& input) {
  std::vector<uint32_t> nearest;
  for (const Vec3f& p : decoded.positions) {
    const auto closer = [&](const Vec3f& a, const Vec3f& b) { return Norm(a - p) < Norm(b - p); };
    const auto it = std::min_element(input.positions.begin(), input.positions.end(), closer);
    nearest.push_back(static_cast<uint32_t>(it - input.positions.begin()));
  }
  return nearest;
}

std::vector<Triangle> AsSet(std::vector<Triangle> triangles) {
  for (Triangle& t : triangles) std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  std::sort(triangles.begin(), triangles.end());
  return triangles;
}

TEST(EncodeMeshTest, SubdividedInputComesBackVertexForVertex) {
  for (const TriangleMesh& mesh : {shapes::GridWithBorder(32, 24, 0.3f), shapes::BumpySphere(3, 0.1f)}) {
    for (const double target : {70.0, 90.0}) {
      const EncodedMesh encoded = EncodeOrDie(mesh, OptionsFor(Kind::kPsnr, target));
      EXPECT_TRUE(encoded.report.subdivided_input);
      ASSERT_TRUE(encoded.report.progressive) << encoded.report.reason;
      TriangleMesh decoded = DecodeMesh(encoded.stream, DecodeOptions()).value().mesh;
      ASSERT_EQ(decoded.positions.size(), mesh.positions.size());
      const std::vector<uint32_t> nearest = NearestVertices(decoded, mesh);
      for (size_t v = 0; v < nearest.size(); ++v) {
        EXPECT_LT(Norm(decoded.positions[v] - mesh.positions[nearest[v]]), 25 * DistanceOfPsnr(target, encoded.report.diagonal));
      }
      for (Triangle& t : decoded.triangles) {
        for (uint32_t& v : t) v = nearest[v];
      }
      EXPECT_EQ(AsSet(decoded.triangles), AsSet(mesh.triangles));
      const double psnr = DecodedPsnr(mesh, encoded.stream, static_cast<int>(encoded.report.levels.size()) - 1);
      EXPECT_GE(psnr, target);
      EXPECT_LT(psnr, target + 1.5);
    }
  }
  EXPECT_FALSE(EncodeOrDie(Ring(), OptionsFor(Kind::kPsnr, 50)).report.subdivided_input);
}

// Half of the bytes would go into the connectivity of the base, and what is left says nothing about its vertices.
TEST(EncodeMeshTest, SubdividedInputIsRemeshedWhereItsVerticesWouldNotBeTold) {
  TriangleMesh mesh = shapes::Torus(62, 34);
  for (size_t v = 0; v < mesh.positions.size(); ++v) mesh.positions[v] *= 1.0f + 0.05f * std::sin(1.7f * static_cast<float>(v * v % 1009));
  EXPECT_FALSE(EncodeOrDie(mesh, OptionsFor(Kind::kBytes, 200)).report.subdivided_input);
  EXPECT_TRUE(EncodeOrDie(mesh, OptionsFor(Kind::kBytes, 5000)).report.subdivided_input);
}

// A fine mesh that is split once has a base that costs more than the whole of another surface.
TEST(EncodeMeshTest, SubdividedInputIsRemeshedWhereItsBaseIsTooLarge) {
  TriangleMesh fine = shapes::Torus(61, 37);  // odd: nothing it could have been split from
  for (Vec3f& p : fine.positions) p *= 1.0f + 0.05f * std::sin(3.0f * p.x + 2.0f * p.z);
  const TriangleMesh split = shapes::Split(fine);
  const EncodedMesh encoded = EncodeOrDie(split, OptionsFor(Kind::kPsnr, 60));
  EXPECT_FALSE(encoded.report.subdivided_input);
  EXPECT_LT(encoded.report.levels.front().vertices, fine.positions.size() / 4);
  EXPECT_GE(DecodedPsnr(split, encoded.stream, static_cast<int>(encoded.report.levels.size()) - 1), 60.0);
}

TEST(EncodeMeshTest, CleansBeforeItRemeshes) {
  const EncodedMesh soup = EncodeOrDie(shapes::TriangleSoup(3), OptionsFor(Kind::kPsnr, 50));
  EXPECT_GT(soup.report.clean.welded_vertices, 0u);
  EXPECT_EQ(soup.report.input_vertices, shapes::Icosphere(3).positions.size());
}

// Triangles that are there several times count as often, and one without area does not make the mesh larger.
TEST(EncodeMeshTest, MeasuresAgainstWhatCameIn) {
  TriangleMesh mesh = Scan();
  for (size_t f = mesh.triangles.size(); f-- > 0;) {
    const Vec3f& p = mesh.positions[mesh.triangles[f][0]];
    if (p.z > 0 && p.x > 0.5f) mesh.triangles.insert(mesh.triangles.end(), 5, mesh.triangles[f]);
  }
  const double diagonal = BoundingBoxDiagonal(mesh);
  mesh.positions.push_back({50, 0, 0});
  const auto far = static_cast<uint32_t>(mesh.positions.size() - 1);
  mesh.triangles.push_back({far, far, 0});
  for (const LevelChoice levels : {LevelChoice::kAlways, LevelChoice::kNever}) {
    EncodeOptions options = OptionsFor(Kind::kPsnr, 54);
    options.levels = levels;
    const EncodedMesh encoded = EncodeOrDie(mesh, options);
    EXPECT_GT(encoded.report.clean.duplicate_triangles, 1000u);
    EXPECT_NEAR(encoded.report.diagonal, diagonal, 1e-6 * diagonal);
    const LevelReport& finest = encoded.report.levels.back();
    EXPECT_GE(finest.psnr, 54.0);
    EXPECT_NEAR(DecodedPsnr(mesh, encoded.stream, static_cast<int>(encoded.report.levels.size()) - 1), finest.psnr, 0.01);
  }
}

TEST(EncodeMeshTest, RefusesDamagedMeshesByName) {
  const float nan = std::numeric_limits<float>::quiet_NaN(), infinity = std::numeric_limits<float>::infinity();
  for (const float bad : {nan, infinity, -infinity}) {
    TriangleMesh mesh = shapes::Icosphere(3);
    mesh.positions[7].y = bad;
    const StatusOr<EncodedMesh> encoded = EncodeMesh(mesh, EncodeOptions());
    ASSERT_FALSE(encoded.ok());
    EXPECT_EQ(encoded.status().code(), StatusCode::kInvalidData);
    EXPECT_THAT(encoded.status().message(), HasSubstr("7"));
  }
  TriangleMesh out_of_range = shapes::Icosphere(3);
  out_of_range.triangles[5][1] = 1'000'000;
  EXPECT_EQ(EncodeMesh(out_of_range, EncodeOptions()).status().code(), StatusCode::kInvalidData);
  EXPECT_EQ(EncodeMesh(TriangleMesh(), EncodeOptions()).status().code(), StatusCode::kInvalidData);
  const TriangleMesh one_point = {{{1, 1, 1}, {1, 1, 1}, {1, 1, 1}}, {{{0, 1, 2}}}};
  EXPECT_EQ(EncodeMesh(one_point, EncodeOptions()).status().code(), StatusCode::kInvalidData);
}

TEST(EncodeMeshTest, RefusesTargetsThatMakeNoSense) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Kind kind : {Kind::kBytes, Kind::kBitsPerVertex, Kind::kPsnr, Kind::kError, Kind::kDistance}) {
    for (const double value : {nan, -1.0, 0.0, 1e300}) {
      EXPECT_EQ(EncodeMesh(shapes::Icosphere(2), OptionsFor(kind, value)).status().code(), StatusCode::kInvalidArgument)
          << static_cast<int>(kind) << " " << value;
    }
  }
}

TEST(EncodeMeshTest, AnUnreachableTargetIsReportedAsSuch) {
  const EncodedMesh encoded = EncodeOrDie(Scan(), OptionsFor(Kind::kBytes, 100));
  EXPECT_GT(encoded.stream.size(), 100u);
  EXPECT_THAT(encoded.report.reason, HasSubstr("out of reach"));
  EXPECT_TRUE(DecodeMesh(encoded.stream, DecodeOptions()).ok());
  EXPECT_THAT(encoded.report.reason, Not(HasSubstr("far from zero")));
  TriangleMesh far = shapes::BumpySphere(3, 0.2f, 0.002f);
  for (Vec3f& p : far.positions) p.x += 1e5f;
  EncodeOptions options = OptionsFor(Kind::kPsnr, 90);
  options.levels = LevelChoice::kNever;
  EXPECT_THAT(EncodeOrDie(far, options).report.reason, HasSubstr("so far from zero floats hold positions to"));
}

// At 50 dB this scan is a few hundred bytes, and one coefficient more or less decides which mode is ahead.
TEST(EncodeMeshTest, PaperModeKeepsItsTargetTooAndTakesMoreBytes) {
  constexpr double kPsnr = 60;
  EncodeOptions options = OptionsFor(Kind::kPsnr, kPsnr);
  options.mode = EncodeMode::kPaper;
  const EncodedMesh encoded = EncodeOrDie(Scan(), options);
  EXPECT_GE(encoded.report.levels.back().psnr, kPsnr);
  EXPECT_GT(encoded.stream.size(), EncodeOrDie(Scan(), OptionsFor(Kind::kPsnr, kPsnr)).stream.size());
}

TEST(EncodeMeshTest, TheDracoPairAgreesInBothForms) {
  const TriangleMesh mesh = Scan();
  for (const StreamForm form : {StreamForm::kDraco, StreamForm::kCustom}) {
    const EncodeOptions options = OptionsFor(Kind::kPsnr, 50, form);
    const EncodedMesh expected = EncodeOrDie(mesh, options);
    Encoder encoder(options);
    draco::EncoderBuffer buffer;
    const std::unique_ptr<draco::Mesh> draco_mesh = ToDracoMesh(mesh);
    const draco::Status status = encoder.EncodeMeshToBuffer(*draco_mesh, &buffer);
    ASSERT_TRUE(status.ok()) << status.error_msg();
    EXPECT_EQ(Bytes(buffer.data(), buffer.data() + buffer.size()), expected.stream);
    EXPECT_EQ(encoder.report().levels.size(), expected.report.levels.size());

    draco::DecoderBuffer in;
    in.Init(buffer.data(), buffer.size());
    Decoder decoder;
    const auto decoded = decoder.DecodeMeshFromBuffer(&in);
    ASSERT_TRUE(decoded.ok()) << decoded.status().error_msg();
    EXPECT_EQ(decoder.level(), static_cast<int>(expected.report.levels.size()) - 1);
    EXPECT_EQ(decoded.value()->num_faces(), expected.report.levels.back().triangles);
  }
}

}  // namespace
}  // namespace lacerta
