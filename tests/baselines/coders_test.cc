#include "baselines/coders.h"

#include <gmock/gmock.h>

#include <cmath>

#include "baselines/remeshes.h"
#include "draco/normal_mesh_candidate.h"
#include "shapes/shapes.h"

namespace lacerta::baselines {
namespace {

constexpr int kLevels = 3;

struct CodersTest : testing::Test {
  Remeshes remeshes = MakeRemeshes(shapes::BumpySphere(4), 30, kLevels).value();
  const std::vector<Vec3f>& normal = remeshes.normal.mesh.positions;
  std::unique_ptr<Transform> butterfly = MakeButterflyTransform(30, remeshes.base.mesh.triangles, kLevels).value();
  std::unique_ptr<Transform> loop = MakeLoopTransform(30, remeshes.base.mesh.triangles, kLevels).value();
};

double Rms(const std::vector<Vec3f>& a, const std::vector<Vec3f>& b) {
  double sum = 0;
  for (size_t i = 0; i < a.size(); ++i) sum += SquaredNorm(Vec3Cast<double>(a[i] - b[i]));
  return std::sqrt(sum / static_cast<double>(a.size()));
}

TEST_F(CodersTest, ModelOnButterflyIsPaperMode) {
  const NormalMeshCandidate product(remeshes.base, remeshes.normal);
  const Decomposition parts = butterfly->Analyze(normal).value();
  for (const double lambda : {1e-8, 1e-6}) {
    const CodedMesh coded = CodeWithModel(remeshes.base, *butterfly, parts, lambda).value();
    const CodedStream stream = product.Code(lambda, EncodeMode::kPaper).value();
    EXPECT_EQ(coded.bytes, stream.size());
    EXPECT_LT(Rms(coded.positions, stream.decoded.positions), 1e-6);
  }
}

TEST_F(CodersTest, ErrorsFollowThresholdsAndBytesRise) {
  for (const Transform* transform : {butterfly.get(), loop.get()}) {
    const Decomposition parts = transform->Analyze(normal).value();
    size_t last_bytes = 0;
    for (const double threshold : {0.1, 0.01, 0.001, 0.0001}) {
      const CodedMesh coded = CodeWithZerotrees(remeshes.base, *transform, parts, {threshold, 1.0}).value();
      EXPECT_GT(coded.bytes, last_bytes);
      last_bytes = coded.bytes;
      // A coefficient is off by up to a threshold where it is cut to zero and by half of one elsewhere.
      EXPECT_LT(Rms(coded.positions, normal), 2 * threshold);
      EXPECT_GT(Rms(coded.positions, normal), 0.02 * threshold);
    }
  }
}

TEST_F(CodersTest, SmallerTangentialScalesSaveBytes) {
  const Decomposition parts = butterfly->Analyze(remeshes.maps.positions).value();
  const CodedMesh even = CodeWithZerotrees(remeshes.base, *butterfly, parts, {0.001, 1.0}).value();
  const CodedMesh coarse = CodeWithZerotrees(remeshes.base, *butterfly, parts, {0.001, 0.25}).value();
  EXPECT_LT(coarse.bytes, 0.9 * static_cast<double>(even.bytes));
  EXPECT_GT(Rms(coarse.positions, remeshes.maps.positions), Rms(even.positions, remeshes.maps.positions));
}

TEST_F(CodersTest, BadOptionsAreRefused) {
  const Decomposition parts = butterfly->Analyze(normal).value();
  EXPECT_EQ(CodeWithZerotrees(remeshes.base, *butterfly, parts, {0.0, 1.0}).status().code(),
            StatusCode::kInvalidArgument);
  EXPECT_EQ(CodeWithZerotrees(remeshes.base, *butterfly, parts, {0.1, -1.0}).status().code(),
            StatusCode::kInvalidArgument);
}

}  // namespace
}  // namespace lacerta::baselines
