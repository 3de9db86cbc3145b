// Bases that are made finer where the normal mesh over them is reversed.
#include "draco/normal_mesh_candidate.h"

#include <gtest/gtest.h>

#include "draco_ext/remesh/remeshing.h"
#include "remesh/reversal.h"
#include "shapes/shapes.h"

namespace lacerta {
namespace {

struct Made {
  uint32_t num_base_vertices;
  double reversed;
};

Made Create(const TriangleMesh& input, uint32_t num_base_vertices) {
  const CollapseHistory history = testing::Decimated(input, {8, 12, 0.2});
  const InputSurface surface(input, testing::TopologyOf(input));
  const NormalMeshCandidate candidate = NormalMeshCandidate::Create({surface, history, {}}, num_base_vertices, 3).value();
  return {candidate.num_base_vertices(), FindReversed(surface, candidate.normal_mesh()).share};
}

TEST(NormalMeshCandidate, HasTheBaseThatIsAskedForOnASmoothSurface) {
  for (const uint32_t size : {40u, 100u}) {
    const Made made = Create(shapes::BumpySphere(4, 0.1f), size);
    EXPECT_EQ(made.num_base_vertices, size);
    EXPECT_LE(made.reversed, kMostReversed);
  }
}

TEST(NormalMeshCandidate, SplitsBaseFacesThatFoldOverWhatTheyStandFor) {
  for (const TriangleMesh& input : {shapes::SpikySphere(4, 12, 1.0f), shapes::TwoHoledPlate(8), shapes::BumpySphere(4, 0.4f, 0.03f)}) {
    const uint32_t asked = 16;
    const Made made = Create(input, asked);
    EXPECT_LT(made.reversed, 5e-4);
    EXPECT_GT(made.num_base_vertices, asked) << "nothing was reversed";
    EXPECT_LE(made.num_base_vertices, asked + 8);
  }
}

}  // namespace
}  // namespace lacerta
