#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

#include "extension/progressive.h"
#include "gltf/two_streams.h"
#include "lacerta/gltf.h"

namespace lacerta {
namespace {

using ::testing::HasSubstr;
using testing::TwoStreams;

// The errors of an asset once `edit` has changed its document.
std::string ErrorsAfter(const std::function<void(GltfDocument*)>& edit) {
  GltfDocument document = ParseGltf(TwoStreams().glb, "").value();
  edit(&document);
  std::string errors;
  for (const ValidationIssue& issue : ValidateGltf(FormatGlb(document), {}).issues) {
    if (issue.is_error) errors += issue.where + ": " + issue.message + "\n";
  }
  return errors;
}

std::string ErrorsWith(const std::function<void(Json*)>& edit) {
  return ErrorsAfter([&](GltfDocument* document) { edit(&document->json["extensions"][kProgressiveName]); });
}

TEST(Validate, WhatPackWritesIsValidAndItsErrorsAreTrue) {
  const Bytes original = testing::TwoBalls();
  ValidateOptions options;
  options.original = original;
  const ValidationReport report = ValidateGltf(TwoStreams().glb, options);
  EXPECT_TRUE(report.IsValid());
  EXPECT_TRUE(report.issues.empty());
  ASSERT_GE(report.measured.size(), 6u);
  for (const MeasuredError& error : report.measured) {
    ASSERT_TRUE(error.announced.has_value());
    EXPECT_NEAR(error.measured, *error.announced, 0.05 * *error.announced);
  }
}

TEST(Validate, FindsWhatIsWrong) {
  EXPECT_EQ(ErrorsWith([](Json*) {}), "");
  EXPECT_THAT(ErrorsWith([](Json* json) { (*json)["version"] = 9; }), HasSubstr("version 9"));
  EXPECT_THAT(ErrorsWith([](Json* json) { (*json)["data"] = 99; }), HasSubstr("bufferView 99"));
  EXPECT_THAT(ErrorsWith([](Json* json) { (*json)["streams"][0]["triangleCounts"][1] = 7; }), HasSubstr("coarser"));
  EXPECT_THAT(ErrorsWith([](Json* json) { (*json)["streams"][1]["min"][0] = -50; }), HasSubstr("bounds"));
  EXPECT_THAT(ErrorsWith([](Json* json) { (*json)["streams"][0]["errors"][0] = -1; }), HasSubstr("negative"));
  EXPECT_THAT(ErrorsWith([](Json* json) { (*json)["segments"]["stream"][1] = 0; }), HasSubstr("segments for"));
  EXPECT_THAT(ErrorsAfter([](GltfDocument* d) { d->json["extensionsUsed"] = Json::array(); }), HasSubstr("extensionsUsed"));
  EXPECT_THAT(ErrorsAfter([](GltfDocument* d) { d->json["accessors"][0]["bufferView"] = 77; }), HasSubstr("accessor 0"));
  EXPECT_THAT(ErrorsAfter([](GltfDocument* d) { d->json["nodes"][0]["mesh"] = 55; }), HasSubstr("/nodes/0/mesh refers to /meshes/55"));
  EXPECT_THAT(ErrorsAfter([](GltfDocument* d) { d->json["nodes"][0]["children"] = {0}; }), HasSubstr("its own ancestor"));
  // One bit of the last segment: only its checksum tells.
  EXPECT_THAT(ErrorsAfter([](GltfDocument* d) { d->buffers[0][d->buffers[0].size() - 8] ^= 1; }), HasSubstr("level"));
  EXPECT_FALSE(ValidateGltf(Bytes{1, 2, 3}, {}).IsValid());
}

TEST(Validate, ErrorsTooGoodToBeTrueAreTold) {
  GltfDocument document = ParseGltf(TwoStreams().glb, "").value();
  Json& errors = document.json["extensions"][kProgressiveName]["streams"][0]["errors"];
  errors.back() = errors.back().get<double>() / 2;
  const Bytes original = testing::TwoBalls();
  ValidateOptions options;
  options.original = original;
  const ValidationReport report = ValidateGltf(FormatGlb(document), options);
  ASSERT_FALSE(report.IsValid());
  EXPECT_THAT(report.issues[0].message, HasSubstr("more than the announced"));
}

}  // namespace
}  // namespace lacerta
