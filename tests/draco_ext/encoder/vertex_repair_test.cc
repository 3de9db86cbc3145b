#include "encoder/vertex_repair.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "draco_ext/encoder/coded_surfaces.h"
#include "encoder/quantizer.h"
#include "encoder/step_law.h"
#include "remesh/input_surface.h"
#include "shapes/base_meshes.h"

namespace lacerta {
namespace {

using lacerta::testing::ExpectDecodesAsSynthesized;

// A subdivided mesh as it is, all of whose vertices are to be kept.
SurfaceTarget KeptVertices(const TriangleMesh& base, int num_levels) {
  NormalMesh mesh;
  mesh.mesh = shapes::Subdivided(base, num_levels, shapes::Bumpy);
  Topology finest = shapes::TopologyOf(base);
  for (int level = 0; level < num_levels; ++level) finest = Refine(finest);
  const TriangleMesh plain = {mesh.mesh.positions, finest.triangles};
  const InputSurface surface(plain, finest);
  for (uint32_t v = 0; v < finest.num_vertices; ++v) mesh.surface_normals.push_back(surface.vertex_normal(v));
  mesh.piercing.assign(mesh.mesh.positions.size() - mesh.mesh.num_base_vertices, PiercingKind::kParametric);
  mesh.keeps_vertices = true;
  return MakeSurfaceTarget(mesh);
}

std::vector<LevelSteps> StepsAt(const SurfaceTarget& target, double lambda) {
  return StepsForSlope(target, DetailScales(target), lambda);
}

CodedSurface ClosedLoopAt(const SurfaceTarget& target, double lambda) {
  const std::vector<Vec3f> base(target.points.begin(), target.points.begin() + target.topologies[0].num_vertices);
  const BaseMesh lattice = RoundToLattice({base, target.topologies[0].triangles}, static_cast<float>(BaseStepForSlope(lambda, target.topologies[0].num_vertices)));
  return QuantizeClosedLoop(target, lattice, StepsAt(target, lambda));
}

// The largest distance of a decoded vertex to its point, in diagonals of the box that a step along each axis spans.
double LargestMiss(const SurfaceTarget& target, const CodedSurface& coded, const std::vector<LevelSteps>& steps) {
  const std::vector<Vec3f> decoded = Synthesize(target, coded);
  double largest = 0;
  for (int level = 0; level <= target.num_levels(); ++level) {
    const uint32_t first = level == 0 ? 0 : target.topologies[level - 1].num_vertices;
    const double normal = level == 0 ? coded.base.step : steps[level - 1].normal_step;
    const double tangential = level == 0 ? coded.base.step : steps[level - 1].tangential_step;
    const double box = std::sqrt(normal * normal + 2 * tangential * tangential);
    for (uint32_t v = first; v < target.topologies[level].num_vertices; ++v) {
      largest = std::max(largest, Norm(decoded[v] - target.points[v]) / box);
    }
  }
  return largest;
}

TEST(RepairVerticesTest, BoundsEveryVertexByTheStepsOfItsLevel) {
  for (const TriangleMesh& base : {shapes::Icosahedron(), shapes::Fan(7), shapes::Grid(3)}) {
    const SurfaceTarget target = KeptVertices(base, 4);
    double largest = 0;
    for (const double lambda : {1e-6, 1e-8, 1e-10}) {
      CodedSurface coded = Descend(target, ClosedLoopAt(target, lambda), {lambda, 2, true});
      RepairVertices(target, &coded);
      const double miss = LargestMiss(target, coded, StepsAt(target, lambda));
      EXPECT_LE(miss, 1.0001);
      largest = std::max(largest, miss);
      ExpectDecodesAsSynthesized(target, coded);
    }
    EXPECT_GT(largest, 0.3);
  }
}

TEST(RepairVerticesTest, MendsWhatIsOffAndLeavesTheRest) {
  const SurfaceTarget target = KeptVertices(shapes::Icosahedron(), 3);
  constexpr double kLambda = 1e-10;
  const CodedSurface sound = ClosedLoopAt(target, kLambda);
  CodedSurface coded = sound;
  coded.base.lattice[5][1] += 4;
  coded.levels[0].normal[7] -= 3;
  coded.levels[1].tangential[20] += 5;
  coded.levels[2].normal[11] += 2;
  EXPECT_GT(LargestMiss(target, coded, sound.steps), 1.0);
  RepairVertices(target, &coded);
  EXPECT_EQ(coded.base.lattice, sound.base.lattice);
  for (size_t i = 0; i < sound.levels.size(); ++i) {
    EXPECT_EQ(coded.levels[i].normal, sound.levels[i].normal);
    EXPECT_EQ(coded.levels[i].tangential, sound.levels[i].tangential);
  }
}

TEST(RepairVerticesTest, SetsOfZerosAreSilent) {
  SurfaceTarget target = KeptVertices(shapes::Icosahedron(), 4);
  CodedSurface coded = ClosedLoopAt(target, 1e-7);
  for (std::vector<int32_t>* values : {&coded.levels.back().normal, &coded.levels.back().tangential}) {
    std::fill(values->begin(), values->end(), 0);
  }
  target.points = Synthesize(target, coded);  // nothing to repair
  const std::vector<LevelSteps> steps = coded.steps;
  const std::vector<Vec3f> before = Synthesize(target, coded);
  RepairVertices(target, &coded);
  EXPECT_EQ(coded.steps.front().normal_step, steps.front().normal_step);
  EXPECT_EQ(coded.steps.back().normal_step, 0);
  EXPECT_EQ(coded.steps.back().tangential_step, 0);
  EXPECT_EQ(Synthesize(target, coded), before);
}

}  // namespace
}  // namespace lacerta
