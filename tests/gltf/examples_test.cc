// The assets that the extension's specification shows: every one is valid and decodes to its last level. With
// LACERTA_WRITE_EXAMPLES set they are made anew, for a change of the format.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "gltf/torus_asset.h"
#include "gltf/two_streams.h"
#include "lacerta/file_io.h"
#include "lacerta/gltf.h"

namespace lacerta {
namespace {

TEST(Examples, AreValidToTheLastLevel) {
  const std::filesystem::path folder = LACERTA_EXAMPLES_DIR;
  if (std::getenv("LACERTA_WRITE_EXAMPLES") != nullptr) {
    std::filesystem::create_directories(folder);
    ASSERT_TRUE(WriteFileAtomically((folder / "two_balls.glb").string(), testing::TwoStreams().glb).ok());
    ASSERT_TRUE(WriteFileAtomically((folder / "torus_with_attributes.glb").string(), testing::PackedTorus().glb).ok());
    TrimOptions trim;
    trim.level = 1;
    ASSERT_TRUE(WriteFileAtomically((folder / "torus_trimmed.glb").string(), TrimGltf(testing::PackedTorus().glb, trim).value().glb).ok());
  }
  int count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".glb") continue;
    ++count;
    const Bytes glb = ReadFile(entry.path().string()).value();
    EXPECT_LT(glb.size(), 20'000u);
    const ValidationReport report = ValidateGltf(glb, {});
    EXPECT_TRUE(report.IsValid()) << entry.path() << (report.issues.empty() ? "" : ": " + report.issues[0].message);
    const auto surfaces = ReadProgressive(glb, {});
    ASSERT_TRUE(surfaces.ok()) << surfaces.status().message();
    const bool is_trimmed = entry.path().stem() == "torus_trimmed";
    for (const ProgressiveSurface& surface : surfaces.value()) {
      EXPECT_FALSE(surface.from_fallback);
      EXPECT_EQ(surface.level, is_trimmed ? 1 : surface.num_levels);
    }
  }
  EXPECT_EQ(count, 3);
}

}  // namespace
}  // namespace lacerta
