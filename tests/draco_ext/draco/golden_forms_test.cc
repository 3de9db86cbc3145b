// Whole streams of every released version decode for ever: tests/golden/v<version>/*.drc. What a libdraco writes may
// change from version to version, so the bytes are not compared, only what they decode to. LACERTA_REGENERATE_GOLDEN=1
// writes the files of the current version anew; do that only before the version is released.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <string>

#include "draco_ext/draco/test_progressive_streams.h"
#include "lacerta/codec.h"

namespace lacerta {
namespace {

using ::lacerta::testing::MakeProgressiveStream;
using ::lacerta::testing::ProgressiveStream;
using ::lacerta::testing::Refined;
using ::lacerta::testing::SameBits;
using ::lacerta::testing::Torus;

constexpr int kNumLevels = 2;

class GoldenFormsTest : public ::testing::TestWithParam<const char*> {};

TEST_P(GoldenFormsTest, Decodes) {
  const std::string name = GetParam();
  const std::string path = std::string(LACERTA_GOLDEN_DIR) + "/v1/" + name + ".drc";
  if (std::getenv("LACERTA_REGENERATE_GOLDEN") != nullptr) {
    const BaseCoding coding = name == "custom_form_compact" ? BaseCoding::kCompact : BaseCoding::kStock;
    const ProgressiveStream stream = MakeProgressiveStream(Torus(6, 5), kNumLevels, /*joined=*/false, coding);
    const Bytes bytes = name == "draco_form" ? stream.DracoForm() : stream.CustomForm();
    std::ofstream out(path, std::ios::binary);
    out.write(reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    ASSERT_TRUE(out.good()) << "cannot write " << path;
  }
  std::ifstream in(path, std::ios::binary);
  ASSERT_TRUE(in.good()) << "cannot read " << path;
  const Bytes stored{std::istreambuf_iterator<char>(in), {}};
  const StatusOr<DecodedMesh> decoded = DecodeMesh(stored, {});
  ASSERT_TRUE(decoded.ok()) << decoded.status().message();
  EXPECT_TRUE(decoded.value().refinement.ok()) << decoded.value().refinement.message();
  ASSERT_EQ(decoded.value().level, kNumLevels);

  DecodeOptions base_only;
  base_only.max_level = 0;
  const TriangleMesh base = DecodeMesh(stored, base_only).value().mesh;
  const TriangleMesh expected = Refined(BaseMeshFromPositions(base, Torus(6, 5).step).value(), kNumLevels);
  EXPECT_TRUE(SameBits(decoded.value().mesh.positions, expected.positions));
  EXPECT_EQ(decoded.value().mesh.triangles, expected.triangles);
}

INSTANTIATE_TEST_SUITE_P(Version1, GoldenFormsTest, ::testing::Values("draco_form", "custom_form", "custom_form_compact"),
                         [](const auto& form) { return std::string(form.param); });

}  // namespace
}  // namespace lacerta
