#include <gmock/gmock.h>

#include <algorithm>
#include <filesystem>

#include "document/gltf_document.h"
#include "extension/progressive.h"
#include "gltf/test_bytes.h"
#include "gltf/test_images.h"
#include "gltf/two_streams.h"
#include "lacerta/file_io.h"
#include "lacerta/gltf.h"

namespace lacerta {
namespace {

using testing::TwoStreams;

TrimResult Trim(std::optional<int> level, std::optional<uint64_t> bytes) {
  TrimOptions options;
  options.level = level;
  options.bytes = bytes;
  return TrimGltf(TwoStreams().glb, options).value();
}

// The level that a stream shows with the bytes of `level`: those above that have no coefficients come with it.
int ShownLevel(size_t stream, int level) {
  const std::vector<LevelReport>& levels = TwoStreams().report.primitives[stream].encode.levels;
  auto shown = static_cast<size_t>(level);
  while (shown + 1 < levels.size() && levels[shown + 1].bytes == levels[shown].bytes) ++shown;
  return static_cast<int>(std::min(shown, levels.size() - 1));
}

// Whether any stream has bytes of its own for that level.
bool HasBytes(int level) {
  const auto i = static_cast<size_t>(level);
  const auto& streams = TwoStreams().report.primitives;
  return level == 0 || std::any_of(streams.begin(), streams.end(), [&](const PrimitiveReport& stream) {
    const std::vector<LevelReport>& levels = stream.encode.levels;
    return i < levels.size() && levels[i].bytes > levels[i - 1].bytes;
  });
}

TEST(Trim, ToALevelGivesThatLevelOfEveryStream) {
  const auto whole = ReadProgressive(TwoStreams().glb, {}).value();
  ASSERT_EQ(whole.size(), 2u);
  ASSERT_TRUE(HasBytes(1) && HasBytes(2));
  size_t last = 0;
  for (int level = 0; level <= std::max(whole[0].num_levels, whole[1].num_levels); ++level) {
    const Bytes glb = Trim(level, std::nullopt).glb;
    EXPECT_GE(glb.size(), last);
    EXPECT_EQ(glb.size() > last, HasBytes(level));
    last = glb.size();
    const auto trimmed = ReadProgressive(glb, {}).value();
    for (size_t s = 0; s < trimmed.size(); ++s) {
      EXPECT_FALSE(trimmed[s].from_fallback) << trimmed[s].note;
      EXPECT_EQ(trimmed[s].level, ShownLevel(s, level));
      UnpackOptions at_level;
      at_level.level = trimmed[s].level;
      EXPECT_EQ(trimmed[s].surface.positions, ReadProgressive(TwoStreams().glb, at_level).value()[s].surface.positions);
    }
    EXPECT_TRUE(ValidateGltf(glb, {}).IsValid());
  }
  EXPECT_EQ(last, TwoStreams().glb.size());
}

TEST(Trim, ToBytesKeepsAsMuchAsFits) {
  const size_t least = Trim(0, std::nullopt).glb.size();
  const size_t most = TwoStreams().glb.size();
  size_t last = 0;
  for (int i = 0; i <= 8; ++i) {
    const uint64_t budget = least + (most - least) * static_cast<size_t>(i) / 8;
    const TrimResult result = Trim(std::nullopt, budget);
    EXPECT_TRUE(result.meets_bytes);
    EXPECT_LE(result.glb.size(), budget);
    EXPECT_GE(result.glb.size(), last);
    last = result.glb.size();
    EXPECT_TRUE(ValidateGltf(result.glb, {}).IsValid());
  }
  EXPECT_EQ(last, most);
  const TrimResult too_small = Trim(std::nullopt, 100);
  EXPECT_FALSE(too_small.meets_bytes);
  EXPECT_LE(too_small.glb.size(), least);
}

TEST(Trim, OfATrimmedAssetIsTheSame) {
  TrimOptions options;
  options.level = 1;
  const Bytes once = TrimGltf(TwoStreams().glb, options).value().glb;
  EXPECT_EQ(TrimGltf(once, options).value().glb, once);
  options.level = 0;
  // Segments of level 1 may have come before finer ones.
  EXPECT_EQ(TrimGltf(once, options).value().glb.size(), TrimGltf(TwoStreams().glb, options).value().glb.size());
}

TEST(Trim, TakesImagesInFilesAlongWhereAsked) {
  const std::filesystem::path folder = std::filesystem::path(::testing::TempDir()) / "lacerta_trim_images";
  std::filesystem::create_directories(folder);
  const Bytes png = testing::Png(8, 8);
  ASSERT_TRUE(WriteFileAtomically((folder / "a.png").string(), png).ok());
  GltfDocument document = ParseGltf(TwoStreams().glb, "").value();
  document.json["images"] = {{{"uri", "a.png"}}, {{"uri", "lost.png"}}};
  const Bytes asset = FormatGlb(document);
  TrimOptions options;
  options.level = 0;
  options.folder = folder.string();
  const TrimResult apart = TrimGltf(asset, options).value();
  options.embed_images = true;
  const TrimResult whole = TrimGltf(asset, options).value();
  std::filesystem::remove_all(folder);
  EXPECT_TRUE(apart.notes.empty());
  EXPECT_EQ(ParseGltf(apart.glb, "").value().json["images"], document.json["images"]);
  ASSERT_EQ(whole.notes.size(), 1u);
  EXPECT_THAT(whole.notes[0], ::testing::HasSubstr("lost.png"));
  const GltfDocument trimmed = ParseGltf(whole.glb, "").value();
  const auto view = BufferViewBytes(trimmed, trimmed.json["images"][0].at("bufferView").get<uint64_t>());
  EXPECT_EQ(Bytes(view.value().begin(), view.value().end()), png);
}

TEST(Trim, RefusesWhatMakesNoSense) {
  EXPECT_EQ(TrimGltf(TwoStreams().glb, {}).status().code(), StatusCode::kInvalidArgument);
  TrimOptions options;
  options.level = 0;
  EXPECT_EQ(TrimGltf(testing::FromText(R"({"asset": {"version": "2.0"}})"), options).status().code(), StatusCode::kUnsupported);
}

TEST(Trim, KeepsWhatHasNoLevelsWholeAndTakesItsImagesAlong) {
  TrimOptions options;
  options.bytes = 10;
  const TrimResult same = TrimGltf(testing::TwoBalls(), options).value();
  EXPECT_EQ(same.glb, testing::TwoBalls());
  EXPECT_FALSE(same.has_levels);
  EXPECT_FALSE(same.meets_bytes);
  GltfDocument document = ParseGltf(testing::TwoBalls(), "").value();
  document.json["images"] = {{{"uri", "a.png"}}};
  const std::filesystem::path folder = std::filesystem::path(::testing::TempDir()) / "lacerta_trim_whole";
  std::filesystem::create_directories(folder);
  const Bytes png = testing::Png(8, 8);
  ASSERT_TRUE(WriteFileAtomically((folder / "a.png").string(), png).ok());
  options.folder = folder.string();
  options.bytes = 1'000'000;
  const Bytes asset = FormatGlb(document);
  EXPECT_EQ(TrimGltf(asset, options).value().glb, asset);
  options.embed_images = true;
  const TrimResult whole = TrimGltf(asset, options).value();
  std::filesystem::remove_all(folder);
  EXPECT_TRUE(whole.meets_bytes);
  const GltfDocument kept = ParseGltf(whole.glb, "").value();
  EXPECT_EQ(kept.json["meshes"], document.json["meshes"]);
  const auto view = BufferViewBytes(kept, kept.json["images"][0].at("bufferView").get<uint64_t>());
  EXPECT_EQ(Bytes(view.value().begin(), view.value().end()), png);
}

TEST(External, RefinementsAreInAFileOfTheirOwn) {
  const PackResult split = testing::PackTwoStreams("rest.bin");
  ASSERT_FALSE(split.external.empty());
  EXPECT_LT(split.glb.size(), TwoStreams().glb.size());
  const std::filesystem::path folder = std::filesystem::path(::testing::TempDir()) / "lacerta_external";
  std::filesystem::create_directories(folder);
  UnpackOptions options;
  options.folder = folder.string();
  const auto levels = [&] {
    const auto surfaces = ReadProgressive(split.glb, options).value();
    EXPECT_FALSE(surfaces[0].from_fallback) << surfaces[0].note;
    return surfaces[0].level;
  };
  const int finest = ReadProgressive(TwoStreams().glb, {}).value()[0].level;
  EXPECT_EQ(levels(), 0);  // not fetched yet
  ASSERT_TRUE(WriteFileAtomically((folder / "rest.bin").string(), split.external).ok());
  EXPECT_EQ(levels(), finest);
  const Span<const uint8_t> part = Span<const uint8_t>(split.external).First(split.external.size() / 8);
  ASSERT_TRUE(WriteFileAtomically((folder / "rest.bin").string(), part).ok());
  EXPECT_LT(levels(), finest);
  ASSERT_TRUE(WriteFileAtomically((folder / "rest.bin").string(), split.external).ok());
  TrimOptions trim;
  trim.level = finest;
  trim.folder = options.folder;
  EXPECT_EQ(ReadProgressive(TrimGltf(split.glb, trim).value().glb, {}).value()[0].level, finest);
  EXPECT_EQ(UnpackGltf(split.glb, options).value().glb, UnpackGltf(TwoStreams().glb, {}).value().glb);
  std::filesystem::remove_all(folder);
}

}  // namespace
}  // namespace lacerta
