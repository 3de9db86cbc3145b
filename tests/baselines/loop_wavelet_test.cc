#include "baselines/loop_wavelet.h"

#include <gmock/gmock.h>

#include <cmath>

#include "baselines/transform.h"
#include "lacerta/decoder.h"
#include "shapes/shapes.h"

namespace lacerta::baselines {
namespace {

Topology TopologyOf(const TriangleMesh& mesh) {
  return BuildTopology(static_cast<uint32_t>(mesh.positions.size()), mesh.triangles).value();
}

double LargestDistance(const std::vector<Vec3f>& a, const std::vector<Vec3f>& b) {
  double largest = 0;
  for (size_t i = 0; i < a.size(); ++i) largest = std::max<double>(largest, Norm(a[i] - b[i]));
  return a.size() == b.size() ? largest : INFINITY;
}

// Something without a pattern, in [-1, 1].
Vec3f Wave(uint32_t i) {
  const double x = i;
  return Vec3Cast<float>(Vec3d{std::sin(2 * x), std::cos(5 * x), std::sin(x * x)});
}

// [Loop 1987]: an inner vertex of valence 6 keeps 10/16 and gives 1/16 to each neighbor, of valence 3 7/16 and 3/16;
// new vertices take 3/8, 3/8, 1/8, 1/8.
TEST(LoopWavelet, HasKnownStencils) {
  const TriangleMesh torus = shapes::Torus(6, 5);  // all valences are 6
  const Topology t = TopologyOf(torus);
  std::vector<Vec3f> impulse(t.num_vertices);
  impulse[0] = {1, 0, 0};
  const std::vector<Vec3f> fine = LoopWavelet(t).Subdivide(impulse);
  EXPECT_FLOAT_EQ(fine[0].x, 0.625f);
  double sum = 0;
  for (uint32_t e = 0; e < t.num_edges(); ++e) {
    const bool touches = t.edges[e][0] == 0 || t.edges[e][1] == 0;
    if (touches) {
      EXPECT_FLOAT_EQ(fine[t.edges[e][0] + t.edges[e][1]].x, 0.0625f);
      EXPECT_FLOAT_EQ(fine[t.num_vertices + e].x, 0.375f);
    }
    sum += fine[t.num_vertices + e].x;
  }
  EXPECT_FLOAT_EQ(static_cast<float>(sum), 6 * 0.375f + 6 * 0.125f);

  const TriangleMesh tetrahedron = {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                                    {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}}};
  const std::vector<Vec3f> corner = LoopWavelet(TopologyOf(tetrahedron)).Subdivide({{1, 0, 0}, {}, {}, {}});
  EXPECT_FLOAT_EQ(corner[0].x, 7.0f / 16);
  EXPECT_FLOAT_EQ(corner[1].x, 3.0f / 16);
}

TEST(LoopWavelet, BordersFollowTheCubicSpline) {
  const TriangleMesh grid = shapes::GridWithBorder(4, 4);
  const Topology t = TopologyOf(grid);
  const std::vector<Vec3f> fine = LoopWavelet(t).Subdivide(grid.positions);
  for (uint32_t e = 0; e < t.num_edges(); ++e) {
    if (!t.is_border(e)) continue;
    const Vec3f middle = (grid.positions[t.edges[e][0]] + grid.positions[t.edges[e][1]]) * 0.5f;
    EXPECT_LT(Norm(fine[t.num_vertices + e] - middle), 1e-6f);
  }
}

TEST(LoopWavelet, SynthesisUndoesAnalysis) {
  for (const TriangleMesh& mesh : {shapes::BumpySphere(2), shapes::GridWithBorder(5, 4, 0.3f), shapes::Icosphere(0)}) {
    const Topology t = TopologyOf(mesh);
    std::vector<Vec3f> fine = mesh.positions;
    for (uint32_t e = 0; e < t.num_edges(); ++e) {
      fine.push_back((fine[t.edges[e][0]] + fine[t.edges[e][1]]) * 0.5f + Wave(e) * 0.02f);
    }
    const LoopWavelet wavelet(t);
    const LoopWavelet::Bands bands = wavelet.Analyze(fine).value();
    EXPECT_LT(LargestDistance(wavelet.Synthesize(bands).value(), fine), 3e-6);
    EXPECT_GT(Norm(bands.detail[1]), 1e-4f);
  }
}

// P^T Q = 0: no choice of control points comes closer in the least-squares sense.
TEST(LoopWavelet, DetailsAreOrthogonalToTheSubdividedSurface) {
  const Topology t = TopologyOf(shapes::BumpySphere(1));
  const LoopWavelet wavelet(t);
  std::vector<Vec3f> coarse(t.num_vertices), detail(t.num_edges());
  for (uint32_t v = 0; v < t.num_vertices; ++v) coarse[v] = Wave(v);
  for (uint32_t e = 0; e < t.num_edges(); ++e) detail[e] = Wave(3 * e + 1);
  const std::vector<Vec3f> smooth = wavelet.Subdivide(coarse);
  const std::vector<Vec3f> rough = wavelet.Synthesize({std::vector<Vec3f>(t.num_vertices), detail}).value();
  Vec3d product{}, size{};
  for (size_t i = 0; i < smooth.size(); ++i) {
    for (int c = 0; c < 3; ++c) {
      product[c] += double{smooth[i][c]} * rough[i][c];
      size[c] += std::fabs(double{smooth[i][c]} * rough[i][c]);
    }
  }
  for (int c = 0; c < 3; ++c) EXPECT_LT(std::fabs(product[c]), 1e-6 * size[c]);
}

// Both transforms give back what they took apart, with frames and all levels.
TEST(Transform, SynthesisUndoesAnalysisOverLevels) {
  const TriangleMesh base = shapes::Icosphere(0);
  constexpr int kLevels = 3;
  std::vector<Vec3f> positions = base.positions;
  Topology t = TopologyOf(base);
  for (int level = 0; level < kLevels; ++level, t = Refine(t)) {
    for (uint32_t e = 0; e < t.num_edges(); ++e) {
      positions.push_back(Normalized(positions[t.edges[e][0]] + positions[t.edges[e][1]]) + Wave(e) * 0.02f);
    }
  }
  for (const bool loop : {false, true}) {
    const auto transform =
        (loop ? MakeLoopTransform(12, base.triangles, kLevels) : MakeButterflyTransform(12, base.triangles, kLevels))
            .value();
    const Decomposition parts = transform->Analyze(positions).value();
    ASSERT_EQ(parts.levels.size(), size_t{kLevels});
    ASSERT_EQ(parts.base.size(), 12u);
    EXPECT_LT(LargestDistance(transform->Synthesize(parts).value(), positions), 1e-5) << loop;
    // Energies grow with the vertices that a coefficient moves; the finest Loop wavelets have a large part at old
    // vertices.
    ASSERT_EQ(transform->energies().size(), size_t{kLevels} + 1);
    for (int level = 1; level < kLevels; ++level) {
      const double growth = transform->energies()[level] / transform->energies()[level + 1];
      EXPECT_GT(growth, loop ? 0.5 : 2.5);
      EXPECT_LT(growth, 6.0);
    }
  }
}

}  // namespace
}  // namespace lacerta::baselines
