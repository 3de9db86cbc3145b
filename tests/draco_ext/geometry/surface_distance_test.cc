#include "lacerta/surface_distance.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "shapes/shapes.h"

namespace lacerta {
namespace {

using ::testing::HasSubstr;

TriangleMesh Moved(TriangleMesh mesh, const Vec3f& by, float scale = 1.0f) {
  for (Vec3f& p : mesh.positions) p = p * scale + by;
  return mesh;
}

// On a lattice of 2^bits points along the longest side, as Draco quantizes positions.
TriangleMesh Quantized(TriangleMesh mesh, int bits) {
  Vec3f min = mesh.positions[0], max = min;
  for (const Vec3f& p : mesh.positions) {
    for (int k = 0; k < 3; ++k) {
      min[k] = std::min(min[k], p[k]);
      max[k] = std::max(max[k], p[k]);
    }
  }
  const Vec3f size = max - min;
  const float step = std::max({size.x, size.y, size.z}) / static_cast<float>((1 << bits) - 1);
  for (Vec3f& p : mesh.positions) {
    for (int k = 0; k < 3; ++k) p[k] = min[k] + step * std::floor((p[k] - min[k]) / step + 0.5f);
  }
  return mesh;
}

SurfaceDistance Measure(const TriangleMesh& a, const TriangleMesh& b, const SurfaceDistanceOptions& options = {}) {
  const StatusOr<SurfaceDistance> distance = MeasureSurfaceDistance(a, b, options);
  EXPECT_TRUE(distance.ok()) << distance.status().message();
  return distance.ok() ? distance.value() : SurfaceDistance{};
}

SurfaceDistanceOptions Samples(uint64_t count, uint32_t seed = 0) {
  SurfaceDistanceOptions options;
  options.num_samples = count;
  options.seed = seed;
  return options;
}

TEST(SurfaceDistance, OffsetPlanesAreTheOffsetApart) {
  const TriangleMesh plane = shapes::GridWithBorder(7, 5);
  for (const float offset : {0.5f, 1e-3f, 1e-6f}) {
    const SurfaceDistance d = Measure(plane, Moved(plane, {0, 0, offset}));
    for (const double value : {d.forward.rms, d.forward.max, d.backward.rms, d.backward.max}) {
      EXPECT_NEAR(value, static_cast<double>(offset), 1e-5 * static_cast<double>(offset));
    }
  }
}

TEST(SurfaceDistance, ConcentricSpheresAreTheDifferenceOfRadiiApart) {
  const TriangleMesh sphere = shapes::Icosphere(5);
  for (const float gap : {0.1f, 0.01f, 0.001f}) {
    const SurfaceDistance d = Measure(sphere, shapes::Icosphere(5, 1.0f + gap));
    // Parallel faces are as far apart as their inscribed radii, which are up to 4e-4 smaller.
    EXPECT_LE(d.Rms(), 1.0001 * static_cast<double>(gap));
    EXPECT_GE(d.Rms(), 0.9994 * static_cast<double>(gap));
    EXPECT_LE(d.Hausdorff(), 1.001 * static_cast<double>(gap));
    EXPECT_GE(d.Hausdorff(), 0.9994 * static_cast<double>(gap));
  }
}

TEST(SurfaceDistance, InscribedPolyhedronAgreesWithTheSphere) {
  const TriangleMesh fine = shapes::Icosphere(6);
  double previous = 0.0;
  for (const int level : {1, 2, 3}) {
    const TriangleMesh coarse = shapes::Icosphere(level);
    // A point x of the polyhedron is 1 - |x| from the sphere; mean over a fine lattice in each face.
    double sum = 0.0, area_sum = 0.0;
    for (const Triangle& t : coarse.triangles) {
      const Vec3d a = Vec3Cast<double>(coarse.positions[t[0]]);
      const Vec3d ab = Vec3Cast<double>(coarse.positions[t[1]]) - a, ac = Vec3Cast<double>(coarse.positions[t[2]]) - a;
      const double area = Norm(Cross(ab, ac));
      constexpr int kSteps = 24;
      double face_sum = 0.0;
      int count = 0;
      for (int i = 0; i < kSteps; ++i) {
        for (int j = 0; i + j < kSteps; ++j) {
          // The centers of the small triangles that point up and, where there is one, down.
          for (const double shift : {1.0 / 3.0, 2.0 / 3.0}) {
            if (shift > 0.5 && i + j == kSteps - 1) continue;
            const double gap = 1.0 - Norm(a + ab * ((i + shift) / kSteps) + ac * ((j + shift) / kSteps));
            face_sum += gap * gap;
            ++count;
          }
        }
      }
      sum += area * face_sum / count;
      area_sum += area;
    }
    const double expected = std::sqrt(sum / area_sum);
    const double measured = Measure(coarse, fine).forward.rms;
    EXPECT_NEAR(measured, expected, 0.02 * expected) << level;
    // Second order: a quarter of the error at half the edge length.
    if (previous > 0.0) {
      EXPECT_NEAR(previous / measured, 4.0, 0.35) << level;
    }
    previous = measured;
  }
}

TEST(SurfaceDistance, PartOfAPlaneIsFarInOneDirectionOnly) {
  const TriangleMesh whole = shapes::GridWithBorder(8, 8);
  const SurfaceDistance d = Measure(Moved(whole, {}, 0.5f), whole);
  EXPECT_LT(d.forward.max, 1e-7);
  // By integration over the unit square outside of a quarter of it.
  EXPECT_NEAR(d.backward.rms, std::sqrt(1.0 / 12.0), 1e-4);
  EXPECT_NEAR(d.backward.max, std::sqrt(0.5), 1e-6);
  EXPECT_EQ(d.Rms(), d.backward.rms);
  EXPECT_EQ(d.Hausdorff(), d.backward.max);
  const SurfaceDistance swapped = Measure(whole, Moved(whole, {}, 0.5f));
  EXPECT_EQ(swapped.forward.rms, d.backward.rms);
  EXPECT_EQ(swapped.backward.rms, d.forward.rms);
}

TEST(SurfaceDistance, MeshWithItselfIsLossless) {
  for (const shapes::NamedShape& shape : shapes::AllShapes()) {
    const SurfaceDistance d = Measure(shape.mesh, shape.mesh, Samples(20'000));
    EXPECT_GT(Psnr(d.Rms(), BoundingBoxDiagonal(shape.mesh)), 140.0) << shape.name;
    EXPECT_GT(Psnr(d.Hausdorff(), BoundingBoxDiagonal(shape.mesh)), 125.0) << shape.name;
  }
}

TEST(SurfaceDistance, ConvergesWithSamples) {
  const TriangleMesh mesh = shapes::BumpySphere(5, 0.1f, 0.002f), other = Quantized(mesh, 9);
  const double reference = Measure(mesh, other, Samples(2'000'000)).Rms();
  const auto worst_db = [&](uint64_t count) {
    double worst = 0.0;
    for (uint32_t seed = 0; seed < 4; ++seed) {
      worst =
          std::max(worst, std::fabs(20.0 * std::log10(Measure(mesh, other, Samples(count, seed)).Rms() / reference)));
    }
    return worst;
  };
  EXPECT_LT(worst_db(100), 2.0);
  EXPECT_LT(worst_db(10'000), 0.2);
  const double at_default = worst_db(SurfaceDistanceOptions().num_samples);
  EXPECT_LT(at_default, 0.02);
  EXPECT_GT(at_default, 0.0);
}

TEST(SurfaceDistance, SamplesFollowTheAreaNotTheTriangles) {
  // A unit square at z = 0 of 2 triangles and one at z = 1 of 20 000, measured against the lower one.
  TriangleMesh lower = shapes::GridWithBorder(1, 1), both = Moved(shapes::GridWithBorder(100, 100), {0, 0, 1});
  const auto first = static_cast<uint32_t>(both.positions.size());
  both.positions.insert(both.positions.end(), lower.positions.begin(), lower.positions.end());
  for (const Triangle& t : lower.triangles) both.triangles.push_back({first + t[0], first + t[1], first + t[2]});
  EXPECT_NEAR(Measure(both, lower).forward.rms, std::sqrt(0.5), 1e-4);
  EXPECT_NEAR(Measure(both, lower, Samples(100)).forward.rms, std::sqrt(0.5), 0.01);
}

TEST(SurfaceDistance, PeriodicTrianglesDoNotKeepStepWithTheSamples) {
  // Strips at heights 0, 0, 0, 1, ...: as many samples as strips, then a quarter, then four times as many.
  TriangleMesh strips;
  for (int k = 0; k < 4096; ++k) {
    const float x = static_cast<float>(k), z = k % 4 == 3 ? 1.0f : 0.0f;
    const auto first = static_cast<uint32_t>(strips.positions.size());
    strips.positions.insert(strips.positions.end(), {{x, 0, z}, {x + 1, 0, z}, {x, 1, z}});
    strips.triangles.push_back({first, first + 1, first + 2});
  }
  const TriangleMesh ground = Moved(shapes::GridWithBorder(1, 1), {-100, -100, 0}, 5000.0f);
  for (const uint64_t count : {1024u, 4096u, 16384u}) {
    EXPECT_NEAR(Measure(strips, ground, Samples(count)).forward.rms, 0.5, 0.02) << count;
  }
}

TEST(SurfaceDistance, DoesNotDependOnTheNumberOfThreads) {
  // Large enough for the trees, too, to be built by several threads.
  const TriangleMesh mesh = shapes::BumpySphere(5), other = Quantized(mesh, 8);
  SurfaceDistance results[2];
  for (const int threads : {1, 2}) {
    tbb::task_arena arena(threads);
    arena.execute([&] { results[threads - 1] = Measure(mesh, other, Samples(50'001)); });
  }
  EXPECT_EQ(std::memcmp(&results[0], &results[1], sizeof(SurfaceDistance)), 0);
  EXPECT_GT(results[0].Rms(), 0.0);
}

TEST(SurfaceDistance, MeterGivesTheSameAsASingleMeasurement) {
  const TriangleMesh mesh = shapes::Torus(40, 20), other = Quantized(mesh, 7);
  const StatusOr<SurfaceDistanceMeter> meter = SurfaceDistanceMeter::Create(mesh);
  ASSERT_TRUE(meter.ok());
  EXPECT_EQ(meter.value().diagonal(), BoundingBoxDiagonal(mesh));
  for (const uint64_t count : {1u, 777u, 200'000u}) {
    const StatusOr<SurfaceDistance> d = meter.value().Measure(other, Samples(count));
    ASSERT_TRUE(d.ok());
    EXPECT_EQ(d.value().Rms(), Measure(mesh, other, Samples(count)).Rms());
  }
}

// Horse against stock Draco 1.5.5 at -qp 9 measured 70.495 dB and 11.31e-4 with an independent tool.
TEST(SurfaceDistance, AgreesWithAnIndependentToolOnHorse) {
  std::ifstream file(LACERTA_TEST_DATA_DIR "/horse.ply", std::ios::binary);
  if (!file) GTEST_SKIP() << "horse.ply is not there";
  TriangleMesh horse;
  horse.positions.resize(48485);
  horse.triangles.resize(96966);
  for (std::string line; std::getline(file, line) && line != "end_header";) {
  }
  file.read(reinterpret_cast<char*>(horse.positions.data()), static_cast<std::streamsize>(horse.positions.size() * 12));
  for (Triangle& t : horse.triangles) {
    file.ignore(1);
    file.read(reinterpret_cast<char*>(t.data()), 12);
  }
  ASSERT_TRUE(file.good());
  const double diagonal = BoundingBoxDiagonal(horse);
  const SurfaceDistance d = Measure(horse, Quantized(horse, 9));
  EXPECT_NEAR(Psnr(d.Rms(), diagonal), 70.495, 0.03);
  EXPECT_NEAR(d.Hausdorff() / diagonal, 11.3108e-4, 0.01e-4);
}

TEST(SurfaceDistance, VerticesSharpenTheMaximumOnly) {
  // A needle on a plane: no sample falls on its tip.
  TriangleMesh needle = shapes::GridWithBorder(40, 40);
  const TriangleMesh plane = needle;
  needle.positions[20 * 41 + 20].z = 1.0f;
  SurfaceDistanceOptions options = Samples(1000);
  const SurfaceDistance with = Measure(needle, plane, options);
  options.max_at_vertices = false;
  const SurfaceDistance without = Measure(needle, plane, options);
  EXPECT_EQ(with.forward.max, 1.0);
  EXPECT_LT(without.forward.max, 0.99);
  EXPECT_GT(without.forward.max, 0.5);
  EXPECT_EQ(with.forward.rms, without.forward.rms);
}

TEST(SurfaceDistance, BadMeshesAreRefusedByName) {
  const TriangleMesh good = shapes::Icosphere(1);
  const auto refuse = [&](const TriangleMesh& bad, const std::string& what) {
    const Status forward = MeasureSurfaceDistance(bad, good).status(),
                 backward = MeasureSurfaceDistance(good, bad).status();
    EXPECT_EQ(forward.code(), StatusCode::kInvalidData);
    EXPECT_EQ(backward.code(), StatusCode::kInvalidData);
    EXPECT_THAT(forward.message(), HasSubstr("original: "));
    EXPECT_THAT(backward.message(), HasSubstr("measured mesh: "));
    EXPECT_THAT(forward.message(), HasSubstr(what));
    EXPECT_THAT(backward.message(), HasSubstr(what));
  };
  refuse({}, "no triangles");
  TriangleMesh bad = good;
  bad.triangles[7] = {0, 1, 1000};
  refuse(bad, "triangle 7 uses vertex 1000 of 42");
  bad = good;
  bad.positions[3].y = std::numeric_limits<float>::quiet_NaN();
  refuse(bad, "vertex 3");
  bad.positions[3].y = -std::numeric_limits<float>::infinity();
  refuse(bad, "not finite");
  bad = good;
  bad.triangles = {{0, 0, 1}, {2, 2, 2}};
  refuse(bad, "degenerate");
}

TEST(SurfaceDistance, ScaleDoesNotMatterUntilItIsTooSmall) {
  const TriangleMesh mesh = shapes::BumpySphere(3), other = Quantized(mesh, 12);
  const double expected = Psnr(Measure(mesh, other, Samples(20'000)).Rms(), BoundingBoxDiagonal(mesh));
  EXPECT_GT(expected, 80.0);
  EXPECT_LT(expected, 95.0);
  for (const float scale : {1e-11f, 1e-3f, 1e5f, 1e17f}) {
    const TriangleMesh a = Moved(mesh, {}, scale), b = Moved(other, {}, scale);
    EXPECT_NEAR(Psnr(Measure(a, b, Samples(20'000)).Rms(), BoundingBoxDiagonal(a)), expected, 0.05) << scale;
  }
  const Status status = SurfaceDistanceMeter::Create(Moved(mesh, {}, 1e-13f)).status();
  EXPECT_EQ(status.code(), StatusCode::kInvalidData);
  EXPECT_THAT(status.message(), HasSubstr("smaller than 1e-12"));
}

TEST(SurfaceDistance, UnusedBadVerticesDoNotMatter) {
  TriangleMesh mesh = shapes::Icosphere(2);
  const double diagonal = BoundingBoxDiagonal(mesh);
  mesh.positions.push_back({std::numeric_limits<float>::quiet_NaN(), 1e30f, 0});
  EXPECT_EQ(BoundingBoxDiagonal(mesh), diagonal);
  EXPECT_LT(Measure(mesh, shapes::Icosphere(2), Samples(1000)).Rms(), 1e-7);
}

TEST(SurfaceDistance, SampleCountsOutOfRangeAreRefused) {
  const TriangleMesh mesh = shapes::Icosphere(1);
  for (const uint64_t count : {uint64_t{0}, SurfaceDistanceOptions::kMaxSamples + 1}) {
    const Status status = MeasureSurfaceDistance(mesh, mesh, Samples(count)).status();
    EXPECT_EQ(status.code(), StatusCode::kInvalidArgument);
    EXPECT_THAT(status.message(), HasSubstr("num_samples is " + std::to_string(count)));
  }
}

TEST(Psnr, IsTwentyLogOfTheRatio) {
  EXPECT_NEAR(Psnr(1e-3, 1.0), 60.0, 1e-12);
  EXPECT_NEAR(Psnr(2.0, 2.0), 0.0, 1e-12);
  EXPECT_NEAR(Psnr(10.0, 1.0), -20.0, 1e-12);
  EXPECT_EQ(Psnr(0.0, 1.0), kMaxPsnr);
  EXPECT_EQ(Psnr(1e-300, 1.0), kMaxPsnr);
  EXPECT_EQ(Psnr(0.0, 0.0), kMaxPsnr);
  EXPECT_EQ(Psnr(1.0, 0.0), -std::numeric_limits<double>::infinity());
  EXPECT_TRUE(std::isnan(Psnr(std::numeric_limits<double>::quiet_NaN(), 1.0)));
  for (const double psnr : {20.0, 70.0, 100.0}) EXPECT_NEAR(Psnr(DistanceOfPsnr(psnr, 3.0), 3.0), psnr, 1e-9);
}

TEST(BoundingBoxDiagonal, IsThatOfTheUsedVertices) {
  TriangleMesh mesh = shapes::CreasedBox(2);
  EXPECT_NEAR(BoundingBoxDiagonal(mesh), std::sqrt(3.0), 1e-12);
  mesh.positions.push_back({100, 100, 100});
  mesh.triangles.push_back({0, 1, 12345});
  const auto far = static_cast<uint32_t>(mesh.positions.size() - 1);
  mesh.triangles.push_back({0, far, far});
  EXPECT_NEAR(BoundingBoxDiagonal(mesh), std::sqrt(3.0), 1e-12);
  EXPECT_EQ(BoundingBoxDiagonal({}), 0.0);
}

// The same distances of other samples: apart by the error of sampling, and exactly the same where every sample is as far.
TEST(LeanMeter, AgreesWithTheUsualOne) {
  const std::pair<TriangleMesh, TriangleMesh> pairs[] = {{shapes::BumpySphere(5, 0.1f, 0.01f), shapes::BumpySphere(3, 0.1f)},
                                                         {shapes::Torus(80, 40), Quantized(shapes::Torus(80, 40), 8)},
                                                         {shapes::CreasedBox(30), Moved(shapes::CreasedBox(7), {0.01f, 0, 0})},
                                                         {shapes::GridWithBorder(90, 40, 0.2f), shapes::GridWithBorder(20, 10, 0.2f)},
                                                         {shapes::SpheresOverAPlate(5, 0.05f), shapes::GridWithBorder(4, 4)}};
  for (const auto& [original, mesh] : pairs) {
    const SurfaceDistance usual = SurfaceDistanceMeter::Create(original).value().Measure(mesh).value();
    const SurfaceDistanceMeter meter = SurfaceDistanceMeter::CreateLean(original).value();
    const SurfaceDistance lean = meter.Measure(mesh).value();
    EXPECT_NEAR(lean.forward.rms, usual.forward.rms, 0.005 * usual.forward.rms);
    EXPECT_NEAR(lean.backward.rms, usual.backward.rms, 1e-6 * usual.backward.rms);  // the same samples
    EXPECT_NEAR(lean.forward.max, usual.forward.max, 0.05 * usual.forward.max);
    EXPECT_NEAR(lean.backward.max, usual.backward.max, 1e-6 * usual.backward.max);
    EXPECT_EQ(meter.diagonal(), BoundingBoxDiagonal(original));
    // Few samples go through the blocks by long steps, many by short ones.
    const SurfaceDistance few = meter.Measure(mesh, SurfaceDistanceOptions::RmsOnly(2000)).value();
    EXPECT_NEAR(few.forward.rms, usual.forward.rms, 0.15 * usual.forward.rms);
  }
  const TriangleMesh plane = shapes::GridWithBorder(7, 5);
  const SurfaceDistance d = SurfaceDistanceMeter::CreateLean(plane).value().Measure(Moved(plane, {0, 0, 0.5f})).value();
  for (const double value : {d.forward.rms, d.forward.max, d.backward.rms, d.backward.max}) EXPECT_NEAR(value, 0.5, 1e-6);
}

// Samples are even over the area, whatever the triangles: a fan of thin ones beside two large ones, of which one is away.
TEST(LeanMeter, WeighsTrianglesByTheirArea) {
  TriangleMesh mesh{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}}};
  constexpr uint32_t kThin = 1000;
  for (uint32_t i = 0; i <= kThin; ++i) mesh.positions.push_back({1 - static_cast<float>(i) / kThin, 1, 0});
  for (uint32_t i = 0; i < kThin; ++i) mesh.triangles.push_back({0, 4 + i, 5 + i});
  const TriangleMesh half{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}}, {{0, 1, 2}}};
  const double usual = SurfaceDistanceMeter::Create(mesh).value().Measure(half).value().forward.rms;
  EXPECT_NEAR(SurfaceDistanceMeter::CreateLean(mesh).value().Measure(half).value().forward.rms, usual, 0.001 * usual);
}

TEST(LeanMeter, RefusesWhatTheUsualOneRefuses) {
  const TriangleMesh flat{{{0, 0, 0}, {1, 0, 0}}, {{0, 1, 1}}}, out_of_range{{{0, 0, 0}, {1, 0, 0}}, {{0, 1, 2}}}, none;
  for (const TriangleMesh* mesh : {&flat, &out_of_range, &none}) {
    EXPECT_EQ(SurfaceDistanceMeter::CreateLean(*mesh).status().message(), SurfaceDistanceMeter::Create(*mesh).status().message());
    EXPECT_EQ(SurfaceDistanceMeter::CreateLean(*mesh).status().code(), StatusCode::kInvalidData);
  }
}

// Unused vertices, far away, are nothing that is measured.
TEST(LeanMeter, LooksAtUsedVerticesAlone) {
  TriangleMesh mesh = shapes::Torus(30, 20);
  const double usual = SurfaceDistanceMeter::Create(mesh).value().Measure(shapes::Torus(15, 10)).value().forward.max;
  mesh.positions.push_back({100, 0, 0});
  EXPECT_NEAR(SurfaceDistanceMeter::CreateLean(mesh).value().Measure(shapes::Torus(15, 10)).value().forward.max, usual, 0.01 * usual);
}

TEST(LeanMeter, DoesNotDependOnTheNumberOfThreads) {
  const TriangleMesh original = shapes::BumpySphere(5, 0.1f, 0.01f), mesh = shapes::BumpySphere(3, 0.1f);
  const SurfaceDistance many = SurfaceDistanceMeter::CreateLean(original).value().Measure(mesh).value();
  tbb::task_arena one(1);
  const SurfaceDistance single = one.execute([&] { return SurfaceDistanceMeter::CreateLean(original).value().Measure(mesh).value(); });
  EXPECT_EQ(many.forward.rms, single.forward.rms);
  EXPECT_EQ(many.backward.rms, single.backward.rms);
  EXPECT_EQ(many.forward.max, single.forward.max);
}

}  // namespace
}  // namespace lacerta
