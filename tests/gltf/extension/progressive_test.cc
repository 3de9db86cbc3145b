#include "extension/progressive.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace lacerta {
namespace {

using ::testing::HasSubstr;

// Two streams of two levels in 10 bytes, one byte per value.
GltfDocument Sample() {
  GltfDocument document;
  document.json = {{"buffers", {{{"byteLength", 10}}}},
                   {"bufferViews", Json::array({{{"buffer", 0}, {"byteOffset", 0}, {"byteLength", 10}}})}};
  document.buffers.push_back({0, 1, 2, 3, 4, 5, 6, 7, 8, 9});
  Progressive progressive;
  progressive.segments = {{0, 3}, {1, 2}, {1, 1}, {0, 4}};
  progressive.streams.resize(2);
  for (ProgressiveStream& stream : progressive.streams) {
    stream.vertex_counts = {4, 10};
    stream.triangle_counts = {4, 16};
    stream.errors = {0.5, 0.125};
    stream.max = {1, 2, 3};
  }
  progressive.streams[1].smooth_normals = true;
  document.json["extensions"][kProgressiveName] = FormatProgressive(progressive);
  return document;
}

// The message after the member at `pointer` (in the extension) was replaced.
std::string MessageAfter(const std::string& pointer, const Json& value) {
  GltfDocument document = Sample();
  document.json["extensions"][kProgressiveName][Json::json_pointer(pointer)] = value;
  return ParseProgressive(document).status().message();
}

TEST(Progressive, SurvivesTheRoundTrip) {
  const GltfDocument document = Sample();
  const auto progressive = ParseProgressive(document);
  ASSERT_TRUE(progressive.ok()) << progressive.status().message();
  EXPECT_EQ(FormatProgressive(progressive.value()), document.json["extensions"][kProgressiveName]);
  EXPECT_TRUE(progressive.value().streams[1].smooth_normals);
  EXPECT_EQ(ParseProgressive(GltfDocument()).status().code(), StatusCode::kNotFound);
}

TEST(Progressive, GathersTheSegmentsOfAStream) {
  GltfDocument document = Sample();
  const Progressive progressive = ParseProgressive(document).value();
  const GatheredStream first = GatherStream(document, progressive, 0).value();
  EXPECT_THAT(first.bytes, ::testing::ElementsAre(0, 1, 2, 6, 7, 8, 9));
  EXPECT_TRUE(first.complete);
  EXPECT_EQ(first.base_length, 3u);
  const GatheredStream second = GatherStream(document, progressive, 1).value();
  EXPECT_THAT(second.bytes, ::testing::ElementsAre(3, 4, 5));
  EXPECT_EQ(second.base_offset, 3u);
  document.buffers[0].resize(7);  // a file cut short
  EXPECT_THAT(GatherStream(document, progressive, 0).value().bytes, ::testing::ElementsAre(0, 1, 2, 6));
  EXPECT_FALSE(GatherStream(document, progressive, 0).value().complete);
  EXPECT_TRUE(GatherStream(document, progressive, 1).value().complete);
}

TEST(Progressive, LevelsWithoutCoefficientsHaveEmptySegments) {
  GltfDocument document = Sample();
  document.json["extensions"][kProgressiveName]["segments"]["byteLength"] = {3, 2, 0, 5};
  const auto progressive = ParseProgressive(document);
  ASSERT_TRUE(progressive.ok()) << progressive.status().message();
  const GatheredStream second = GatherStream(document, progressive.value(), 1).value();
  EXPECT_THAT(second.bytes, ::testing::ElementsAre(3, 4));
  EXPECT_TRUE(second.complete);
  EXPECT_THAT(GatherStream(document, progressive.value(), 0).value().bytes, ::testing::ElementsAre(0, 1, 2, 5, 6, 7, 8, 9));
  document.buffers[0].resize(5);  // cut just there
  EXPECT_TRUE(GatherStream(document, progressive.value(), 1).value().complete);
}

TEST(Progressive, NamesWhatIsWrong) {
  EXPECT_THAT(MessageAfter("/version", 2), AllOf(HasSubstr("version 2"), HasSubstr(kProgressiveName)));
  EXPECT_THAT(MessageAfter("/data", "x"), HasSubstr("data"));
  EXPECT_THAT(MessageAfter("/segments/stream/0", 2), HasSubstr("stream 2 does not exist"));
  EXPECT_THAT(MessageAfter("/segments/stream/0", 1), HasSubstr("segments"));
  EXPECT_THAT(MessageAfter("/segments/byteLength/0", -1), HasSubstr("byteLength"));
  EXPECT_THAT(MessageAfter("/segments/byteLength/0", 18446744073709551615u), HasSubstr("overflow"));
  EXPECT_THAT(MessageAfter("/segments/byteLength", {1}), HasSubstr("differ in length"));
  EXPECT_THAT(MessageAfter("/streams/1/errors/0", nullptr), AllOf(HasSubstr("stream 1"), HasSubstr("errors")));
  EXPECT_THAT(MessageAfter("/streams/1/vertexCounts", Json::array()), HasSubstr("length"));
  EXPECT_THAT(MessageAfter("/streams/0/min", {1, 2}), HasSubstr("min"));
  EXPECT_THAT(MessageAfter("/streams/0/max/0", 1e300), HasSubstr("too large"));
  EXPECT_THAT(MessageAfter("/streams", Json::array()), HasSubstr("does not exist"));
}

TEST(Progressive, OrdersBasesFirstThenByErrorPerByte) {
  const auto order = OrderSegments({{10, 100, 100}, {20, 10, 1000}}, {{1.0, 0.5, 0.4}, {1.0, 0.9, 0.1}});
  std::vector<uint64_t> streams;
  std::vector<uint64_t> lengths;
  for (const Segment& segment : order) {
    streams.push_back(segment.stream);
    lengths.push_back(segment.length);
  }
  // Gains per byte: stream 0: 0.005, then 0.001; stream 1: 0.01, then 0.0008.
  EXPECT_THAT(streams, ::testing::ElementsAre(0, 1, 1, 0, 0, 1));
  EXPECT_THAT(lengths, ::testing::ElementsAre(10, 20, 10, 100, 100, 1000));
}

TEST(Progressive, OrdersBySeveralPartsWhereTheFirstOneGainsLittle) {
  // The second stream's first part gains nothing, both together 0.8 for 20 bytes; the first stream's parts 0.1 for 10, then the rest.
  const auto order = OrderSegments({{10, 10, 10}, {10, 10, 10}}, {{1.0, 0.9, 0.85}, {1.0, 1.0, 0.2}});
  std::vector<uint64_t> streams;
  for (const Segment& segment : order) streams.push_back(segment.stream);
  EXPECT_THAT(streams, ::testing::ElementsAre(0, 1, 1, 1, 0, 0));
  EXPECT_EQ(OrderSegments({{7}}, {{0.5}}).size(), 1u);
}

}  // namespace
}  // namespace lacerta
