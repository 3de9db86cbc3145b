#include "remesh/mend_tears.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "draco_ext/remesh/remeshing.h"
#include "lacerta/clean.h"
#include "lacerta/surface_distance.h"
#include "remesh/manifold.h"
#include "remesh/surface_parts.h"

namespace lacerta {
namespace {

constexpr double kDistance = 0.02;  // model units, of spheres of radius 1

// Flaps as raw scans have them: each shares an edge with two triangles of the mesh and is the straighter continuation of one of them.
TriangleMesh WithFlaps(TriangleMesh mesh, uint32_t every, float length) {
  const size_t num_faces = mesh.triangles.size();
  for (uint32_t f = 0; f < num_faces; f += every) {
    const Triangle t = mesh.triangles[f];
    const Vec3f a = mesh.positions[t[0]], b = mesh.positions[t[1]], c = mesh.positions[t[2]];
    mesh.triangles.push_back({t[1], t[0], static_cast<uint32_t>(mesh.positions.size())});
    mesh.positions.push_back((a + b) * 0.5f + ((a + b) * 0.5f - c) * length);
  }
  return mesh;
}

TriangleMesh CleanedOf(const TriangleMesh& mesh) { return Clean(mesh).value().mesh; }

ManifoldReport RefinedReport(const TriangleMesh& mesh) { return MakeManifold(SplitSurface(mesh).refined).report; }

TEST(MendTears, ClosesWhatFlapsTearOpen) {
  const TriangleMesh sphere = shapes::BumpySphere(4);
  const TriangleMesh torn = CleanedOf(WithFlaps(sphere, 40, 0.5f));
  ASSERT_GT(RefinedReport(torn).borders, 20u);
  const std::optional<MendedMesh> mended = MendTears(torn, kDistance);
  ASSERT_TRUE(mended.has_value());
  EXPECT_GE(mended->closed_tears, RefinedReport(torn).borders);
  const SurfaceParts parts = SplitSurface(mended->mesh);
  const ManifoldReport report = MakeManifold(parts.refined).report;
  EXPECT_EQ(report.borders, 0u);
  EXPECT_EQ(report.components, 1u);
  EXPECT_GE(parts.refined.triangles.size(), sphere.triangles.size());
  const size_t num_flaps = torn.triangles.size() - sphere.triangles.size();
  EXPECT_LE(parts.refined.triangles.size(), torn.triangles.size() + 4 * num_flaps);
  const double distance = SurfaceDistanceMeter::Create(torn).value().Measure(mended->mesh).value().Rms();
  EXPECT_LE(distance, std::sqrt(MendOptions().share) * kDistance);
}

TEST(MendTears, LeavesAloneWhatIsNotTorn) {
  for (const TriangleMesh& mesh : {shapes::BumpySphere(3), shapes::GridWithBorder(30, 30, 0.3f), shapes::PuncturedSphere(4), shapes::CreasedBox(10),
                                   shapes::TouchingBoxes(8)}) {
    EXPECT_FALSE(MendTears(CleanedOf(mesh), kDistance).has_value());
  }
}

TEST(MendTears, FillsNoHoleWithNothingInIt) {
  // A flap lies at the rim of a hole: torn, but there is no surface to fill it with.
  TriangleMesh sphere = shapes::Icosphere(4);
  const auto is_near_pole = [&](const Triangle& t) { return std::all_of(t.begin(), t.end(), [&](uint32_t v) { return sphere.positions[v].z > 0.93f; }); };
  sphere.triangles.erase(std::remove_if(sphere.triangles.begin(), sphere.triangles.end(), is_near_pole), sphere.triangles.end());
  const TriangleMesh torn = CleanedOf(WithFlaps(sphere, 40, 0.5f));
  const std::optional<MendedMesh> mended = MendTears(torn, kDistance);
  ASSERT_TRUE(mended.has_value());
  EXPECT_EQ(RefinedReport(mended->mesh).borders, 1u);
}

TEST(MendTears, KeepsFlapsThatStandOut) {
  const TriangleMesh torn = CleanedOf(WithFlaps(shapes::BumpySphere(4), 40, 3.0f));
  const std::optional<MendedMesh> mended = MendTears(torn, 0.001);
  const TriangleMesh& after = mended ? mended->mesh : torn;
  const double distance = SurfaceDistanceMeter::Create(torn).value().Measure(after).value().Rms();
  EXPECT_LE(distance, std::sqrt(MendOptions().share) * 0.001);
  EXPECT_GE(SplitSurface(after).refined.triangles.size() + SplitSurface(after).still.triangles.size(), torn.triangles.size());
}

TEST(MendTears, AnyMeshComesOutUsable) {
  for (const uint32_t every : {1u, 2u, 3u, 7u}) {
    for (const float length : {0.0f, 0.01f, 0.5f, 5.0f}) {
      const TriangleMesh torn = CleanedOf(WithFlaps(shapes::BumpySphere(3), every, length));
      for (const double distance : {1e-6, 1e-2, 1.0}) {
        const std::optional<MendedMesh> mended = MendTears(torn, distance);
        if (!mended) continue;
        for (const Triangle& t : mended->mesh.triangles) {
          for (const uint32_t v : t) ASSERT_LT(v, mended->mesh.positions.size());
        }
        for (const Vec3f& p : mended->mesh.positions) ASSERT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
        EXPECT_FALSE(SplitSurface(mended->mesh).refined.triangles.empty());
      }
    }
  }
}

}  // namespace
}  // namespace lacerta
