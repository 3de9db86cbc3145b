#include "baselines/remeshes.h"

#include <gmock/gmock.h>

#include <cmath>

#include "baselines/maps_remesh.h"
#include "remesh/decimate.h"
#include "shapes/shapes.h"

namespace lacerta::baselines {
namespace {

double LargestDistanceTo(const InputSurface& surface, const std::vector<Vec3f>& positions) {
  double largest = 0;
  for (const Vec3f& p : positions)
    largest = std::max<double>(largest, std::sqrt(surface.tree().ClosestPoint(p).squared_distance));
  return largest;
}

// Of the lengths of the finest edges, standard deviation over mean.
double SpreadOfEdges(const SemiRegularMesh& mesh) {
  Topology t = BuildTopology(mesh.num_base_vertices, mesh.base_triangles).value();
  for (int level = 0; level < mesh.num_levels; ++level) t = Refine(t);
  double sum = 0, squares = 0;
  for (const auto& [a, b] : t.edges) {
    const double length = Norm(mesh.positions[a] - mesh.positions[b]);
    sum += length;
    squares += length * length;
  }
  const double mean = sum / t.num_edges();
  return std::sqrt(squares / t.num_edges() - mean * mean) / mean;
}

TEST(MapsRemesh, PutsVerticesOnTheInputAndRelaxationEvensThem) {
  const TriangleMesh input = shapes::BumpySphere(4);
  const Topology topology = BuildTopology(static_cast<uint32_t>(input.positions.size()), input.triangles).value();
  DecimateOptions decimation;
  decimation.target_vertices = 40;
  const CollapseHistory history = Decimate(input, topology, decimation);
  const BaseDomain domain(history, history.num_collapses());
  const InputSurface surface(input, topology);
  const SemiRegularMesh raw = MapsRemesh(surface, domain, {3, 0}), relaxed = MapsRemesh(surface, domain, {3, 12});
  const LevelCounts counts =
      SubdividedCounts({domain.num_vertices(), domain.topology().num_edges(), domain.topology().num_faces()}, 3);
  for (const SemiRegularMesh& mesh : {raw, relaxed}) {
    EXPECT_EQ(mesh.positions.size(), counts.vertices);
    EXPECT_LT(LargestDistanceTo(surface, mesh.positions), 1e-5);
  }
  EXPECT_LT(SpreadOfEdges(relaxed), 0.9 * SpreadOfEdges(raw));
  EXPECT_GT(SpreadOfEdges(relaxed), 0.01);
}

// The midpoint of a base edge is where the parametrization says, and so on for finer ones in the same face.
TEST(MapsRemesh, FollowsTheParametrization) {
  const TriangleMesh input = shapes::BumpySphere(3);
  const Topology topology = BuildTopology(static_cast<uint32_t>(input.positions.size()), input.triangles).value();
  const CollapseHistory history = Decimate(input, topology, DecimateOptions());
  const BaseDomain domain(history, history.num_collapses());
  const InputSurface surface(input, topology);
  const SemiRegularMesh mesh = MapsRemesh(surface, domain, {2, 0});
  const Topology& base = domain.topology();
  const Topology finer = Refine(base);
  const auto at = [&](uint32_t face, const Vec3d& weights) {
    const DomainPoint p = domain.ToInput({face, weights});
    return surface.PositionAt(p.face, p.barycentric);
  };
  for (uint32_t f = 0; f < base.num_faces(); ++f) {
    EXPECT_LT(Norm(mesh.positions[base.num_vertices + base.face_edges[f][2]] - at(f, {0.5, 0.5, 0})), 1e-4f);
    // The inner edge that cuts off corner 0 runs between the midpoints of the sides at that corner.
    const uint32_t inner = 2 * base.num_edges() + 3 * f;
    EXPECT_LT(Norm(mesh.positions[finer.num_vertices + inner] - at(f, {0.5, 0.25, 0.25})), 1e-4f);
  }
}

TEST(Remeshes, ShareOneBase) {
  const TriangleMesh input = shapes::BumpySphere(4);
  const Remeshes remeshes = MakeRemeshes(input, 30, 3).value();
  EXPECT_EQ(remeshes.normal.mesh.base_triangles, remeshes.base.mesh.triangles);
  EXPECT_EQ(remeshes.maps.base_triangles, remeshes.base.mesh.triangles);
  EXPECT_EQ(remeshes.normal.mesh.positions.size(), remeshes.maps.positions.size());
  EXPECT_EQ(remeshes.base.mesh.lattice.size(), 30u);
  EXPECT_GT(NormalShare(remeshes.normal), 0.9);
}

}  // namespace
}  // namespace lacerta::baselines
