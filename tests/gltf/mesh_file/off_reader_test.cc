#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "gltf/test_bytes.h"
#include "lacerta/mesh_file.h"

namespace lacerta {
namespace {

using ::testing::ElementsAre;
using testing::FromText;
using ::testing::HasSubstr;

StatusOr<TriangleMesh> Parse(Span<const uint8_t> bytes) { return ParseMesh(bytes, MeshFormat::kOff); }
std::string MessageOf(const std::string& text) { return Parse(FromText(text)).status().message(); }

const char kFile[] =
    "OFF # by hand\n\n# counts\n4 2 0\n0 0 0\n1 0 0 # corner\n1 1 0\n0 1 0\n4 0 1 2 3 255 0 0\n3 0 2 3\n";

TEST(OffReader, ReadsEveryVariant) {
  for (const char* text :
       {kFile, "OFF4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n3 0 2 3", "OFF 4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 \n2\n3 \n3 0 2 3 9 9 9\n",
        "OFF 4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n3 0 2 3",
        "COFF\n4 2 0\n0 0 0 1 1 1 1\n1 0 0 1 1 1 1\n1 1 0 1 1 1 1\n0 1 0 1 1 1 1\n4 0 1 2 3\n3 0 2 3\n",
        "NOFF\r\n4 2\r\n0 0 0 0 0 1\r\n1 0 0 0 0 1\r\n1 1 0 0 0 1\r\n0 1 0 0 0 1\r\n4 0 1 2 3\r\n3 0 2 3\r\n",
        "STCNOFF\n4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n3 0 2 3\n"}) {
    const StatusOr<TriangleMesh> mesh = Parse(FromText(text));
    ASSERT_TRUE(mesh.ok()) << mesh.status().message() << "\n" << text;
    EXPECT_EQ(mesh.value().positions[2], (Vec3f{1, 1, 0}));
    EXPECT_THAT(mesh.value().triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}, Triangle{0, 2, 3}));
  }
}

TEST(OffReader, RefusesEveryTruncation) {
  const Bytes bytes = FromText(kFile);
  testing::ForEveryPrefix(bytes, [&](Span<const uint8_t> prefix) {
    const StatusOr<TriangleMesh> mesh = Parse(prefix);
    EXPECT_EQ(mesh.ok(), prefix.size() + 1 >= bytes.size()) << prefix.size() << mesh.status().message();
  });
}

// Counts, vertices of so many numbers, and faces, each with so many colors after it; none: -1.
Bytes Binary(const std::string& keyword, bool is_big_endian, int numbers_per_vertex, int colors) {
  Bytes bytes = FromText(keyword + " BINARY\n");
  const auto add = [&](uint32_t word) {
    for (int k = 0; k < 4; ++k) bytes.push_back(static_cast<uint8_t>(word >> (8 * (is_big_endian ? 3 - k : k))));
  };
  const uint32_t one = 0x3f800000;
  for (const uint32_t count : {4, 2, 0}) add(count);
  for (uint32_t v = 0; v < 4; ++v) {
    add(v == 1 || v == 2 ? one : 0);
    add(v >= 2 ? one : 0);
    for (int i = 2; i < numbers_per_vertex; ++i) add(0);
  }
  for (const std::vector<uint32_t>& face : {std::vector<uint32_t>{4, 0, 1, 2, 3}, {3, 0, 2, 3}}) {
    for (const uint32_t word : face) add(word);
    for (int i = -1; i < colors; ++i) add(i < 0 ? static_cast<uint32_t>(colors) : one);
  }
  return bytes;
}

TEST(OffReader, ReadsBinaryOfEitherByteOrder) {
  for (const bool is_big_endian : {false, true}) {
    for (const int colors : {-1, 0, 1, 3}) {
      for (const auto& [keyword, numbers] : std::vector<std::pair<std::string, int>>{{"OFF", 3}, {"COFF", 7}, {"NOFF", 6}, {"STCNOFF", 12}}) {
        const StatusOr<TriangleMesh> mesh = Parse(Binary(keyword, is_big_endian, numbers, colors));
        ASSERT_TRUE(mesh.ok()) << keyword << is_big_endian << colors << mesh.status().message();
        EXPECT_THAT(mesh.value().positions, ElementsAre(Vec3f{0, 0, 0}, Vec3f{1, 0, 0}, Vec3f{1, 1, 0}, Vec3f{0, 1, 0}));
        EXPECT_THAT(mesh.value().triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}, Triangle{0, 2, 3}));
      }
    }
  }
}

TEST(OffReader, RefusesDamagedBinary) {
  const Bytes whole = Binary("OFF", false, 3, -1);
  testing::ForEveryPrefix(whole, [&](Span<const uint8_t> prefix) { EXPECT_EQ(Parse(prefix).ok(), prefix.size() == whole.size()) << prefix.size(); });
  for (size_t i = 0; i < whole.size(); ++i) {
    for (const uint8_t value : {uint8_t{0}, uint8_t{1}, uint8_t{0x7f}, uint8_t{0xff}}) {
      Bytes changed = whole;
      changed[i] = value;
      const StatusOr<TriangleMesh> mesh = Parse(changed);
      if (mesh.ok()) {
        EXPECT_LE(mesh.value().triangles.size(), 4u);
      }
    }
  }
  Bytes beyond = whole;
  beyond[beyond.size() - 4] = 4;  // the last corner of 4 vertices
  EXPECT_THAT(Parse(beyond).status().message(), HasSubstr("index 4"));
}

TEST(OffReader, NamesWhatIsWrong) {
  EXPECT_THAT(MessageOf("OFF\n4000000000 2 0\n0 0 0\n"), HasSubstr("4000000000 vertices"));
  EXPECT_THAT(MessageOf("OFF\n3 4000000000 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"), HasSubstr("4000000000 faces"));
  EXPECT_THAT(MessageOf("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n4000000000 0 1 2\n"), HasSubstr("corners"));
  EXPECT_THAT(MessageOf("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n"),
              AllOf(HasSubstr("line 6"), HasSubstr("index 3")));
  EXPECT_THAT(MessageOf("OFF\n3 1 0\n0 0 0\nnan 0 0\n0 1 0\n3 0 1 2\n"),
              AllOf(HasSubstr("line 4"), HasSubstr("vertex 1")));
  EXPECT_THAT(MessageOf("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n1 0\n0 0 0 0\n"), HasSubstr("1 corners"));
  EXPECT_THAT(MessageOf("OFF\n-3 1 0\n"), HasSubstr("\"-3\""));
  EXPECT_THAT(MessageOf("OFF BINARY\n"), HasSubstr("0 bytes after the first line"));
  EXPECT_THAT(MessageOf("OFF\n4 2 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1\n3 2 1 0 0 0\n"), HasSubstr("ends too early"));
  EXPECT_THAT(MessageOf("4OFF\n1 1 0\n"), HasSubstr("4OFF"));
  EXPECT_THAT(MessageOf("FOO\n"), HasSubstr("no OFF file"));
}

}  // namespace
}  // namespace lacerta
