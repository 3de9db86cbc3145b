#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "gltf/test_bytes.h"
#include "lacerta/mesh_file.h"

namespace lacerta {
namespace {

using testing::Append;
using testing::AppendBigEndian;
using ::testing::ElementsAre;
using testing::FromText;
using ::testing::HasSubstr;

std::string Header(const std::string& encoding, const std::string& vertices, const std::string& faces,
                   const std::string& real = "float") {
  return "ply\nformat " + encoding + " 1.0\ncomment made by hand\nelement vertex " + vertices + "\nproperty " + real +
         " x\nproperty " + real + " y\nproperty " + real + " z\nproperty uchar red\nelement face " + faces +
         "\nproperty list uchar int vertex_indices\nproperty uchar flag\nend_header\n";
}

const char kBody[] = "0 0 0 255\n1 0 0 255\n1 1 0 255\n0 1.5 0 255\n4 0 1 2 3 7\n3 0 2 3 7\n";

StatusOr<TriangleMesh> Parse(Span<const uint8_t> bytes) { return ParseMesh(bytes, MeshFormat::kPly); }
std::string MessageOf(const std::string& text) { return Parse(FromText(text)).status().message(); }

template <typename Real, typename AppendNumber>
Bytes BinaryFile(const std::string& header, const AppendNumber& append) {
  Bytes bytes = FromText(header);
  const Real positions[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, Real(1.5), 0}};
  for (const auto& position : positions) {
    for (const Real value : position) append(value, &bytes);
    bytes.push_back(255);
  }
  bytes.push_back(4);
  for (const int32_t index : {0, 1, 2, 3}) append(index, &bytes);
  bytes.push_back(7);
  bytes.push_back(3);
  for (const int32_t index : {0, 2, 3}) append(index, &bytes);
  bytes.push_back(7);
  return bytes;
}

void ExpectTheMesh(const StatusOr<TriangleMesh>& mesh) {
  ASSERT_TRUE(mesh.ok()) << mesh.status().message();
  EXPECT_THAT(mesh.value().positions, ElementsAre(Vec3f{0, 0, 0}, Vec3f{1, 0, 0}, Vec3f{1, 1, 0}, Vec3f{0, 1.5f, 0}));
  EXPECT_THAT(mesh.value().triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}, Triangle{0, 2, 3}));
}

const auto kLittle = [](auto value, Bytes* bytes) { Append(value, bytes); };
const auto kBig = [](auto value, Bytes* bytes) { AppendBigEndian(value, bytes); };

TEST(PlyReader, ReadsEveryEncoding) {
  ExpectTheMesh(Parse(FromText(Header("ascii", "4", "2") + kBody)));
  ExpectTheMesh(Parse(FromText(Header("ascii", "4", "2", "double") + kBody)));
  ExpectTheMesh(Parse(BinaryFile<float>(Header("binary_little_endian", "4", "2"), kLittle)));
  ExpectTheMesh(Parse(BinaryFile<double>(Header("binary_little_endian", "4", "2", "double"), kLittle)));
  ExpectTheMesh(Parse(BinaryFile<float>(Header("binary_big_endian", "4", "2"), kBig)));
  ExpectTheMesh(Parse(BinaryFile<double>(Header("binary_big_endian", "4", "2", "float64"), kBig)));
}

TEST(PlyReader, AcceptsCarriageReturnsAndOtherElements) {
  const StatusOr<TriangleMesh> mesh = Parse(FromText(
      "ply\r\nformat ascii 1.0\r\nelement camera 1\r\nproperty list uchar float view\r\nelement vertex 3\r\nproperty "
      "int x\r\n"
      "property int y\r\nproperty int z\r\nelement face 1\r\nproperty list uint8 uint32 vertex_index\r\nend_header\r\n"
      "2 0.5 0.5\r\n0 0 0\r\n2 0 0\r\n0 2 0\r\n3 0 1 2\r\n"));
  ASSERT_TRUE(mesh.ok()) << mesh.status().message();
  EXPECT_THAT(mesh.value().triangles, ElementsAre(Triangle{0, 1, 2}));
  EXPECT_EQ(mesh.value().positions[1], (Vec3f{2, 0, 0}));
}

std::string Strips(const std::string& rows) {
  return "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\nelement tristrips " + rows +
         "\n";
}

// MeshLab writes nine numbers for colors of corners, of which its header names four.
TEST(PlyReader, ValuesThatTheHeaderDoesNotNameAreLeftAside) {
  ExpectTheMesh(Parse(FromText(Header("ascii", "4", "2") + "0 0 0 255 1 1\n1 0 0 255\r\n1 1 0 255 0.5\n0\n1.5 0 255\n4 0 1 2 3 9 1 1 1\n3 0 2 3 9 1 1 1")));
}

TEST(PlyReader, ReadsTriangleStrips) {
  const std::string list = "\nproperty list int int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n";
  const StatusOr<TriangleMesh> one = Parse(FromText(Strips("1" + list + "12  0 1 2 3 4 -1 -1 4 3 1 -1 2")));
  ASSERT_TRUE(one.ok()) << one.status().message();
  EXPECT_THAT(one.value().triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{2, 1, 3}, Triangle{2, 3, 4}, Triangle{4, 3, 1}));
  const StatusOr<TriangleMesh> two = Parse(FromText(Strips("2" + list + "4  0 1 2 3\n3  2 3 4\n")));
  ASSERT_TRUE(two.ok()) << two.status().message();
  EXPECT_THAT(two.value().triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{2, 1, 3}, Triangle{2, 3, 4}));
  EXPECT_THAT(MessageOf(Strips("2" + list + "3  0 1 2\n4  1 2 3 5")), AllOf(HasSubstr("line 16"), HasSubstr("index 5"), HasSubstr("5 vertices")));
  EXPECT_THAT(MessageOf(Strips("1" + list + "4  0 -2 2 3")), HasSubstr("index -2"));
  EXPECT_THAT(MessageOf(Strips("1" + list + "3  0 -1 2")), HasSubstr("no faces"));
  EXPECT_FALSE(Parse(FromText(Strips("1" + list + "9  0 1 2"))).ok());
}

TEST(PlyReader, RefusesEveryTruncation) {
  for (const Bytes& bytes : {FromText(Header("ascii", "4", "2") + kBody),
                             BinaryFile<float>(Header("binary_little_endian", "4", "2"), kLittle),
                             BinaryFile<double>(Header("binary_big_endian", "4", "2", "double"), kBig)}) {
    size_t num_read = 0;
    testing::ForEveryPrefix(bytes, [&](Span<const uint8_t> prefix) {
      const StatusOr<TriangleMesh> mesh = Parse(prefix);
      if (mesh.ok()) {
        ++num_read;
        EXPECT_GE(prefix.size() + 1, bytes.size());  // the last line end may be missing
      } else {
        EXPECT_FALSE(mesh.status().message().empty());
      }
    });
    EXPECT_GE(num_read, 1u);
    EXPECT_LE(num_read, 2u);
  }
}

TEST(PlyReader, SurvivesEveryMutation) {
  size_t num_refused = 0;
  const auto parse = [&](Span<const uint8_t> bytes) {
    const StatusOr<TriangleMesh> mesh = Parse(bytes);
    if (!mesh.ok()) {
      ++num_refused;
      return;
    }
    for (const Triangle& triangle : mesh.value().triangles) {
      for (const uint32_t index : triangle) ASSERT_LT(index, mesh.value().positions.size());
    }
  };
  testing::ForEveryMutant(FromText(Header("ascii", "4", "2") + kBody), parse);
  testing::ForEveryMutant(BinaryFile<float>(Header("binary_little_endian", "4", "2"), kLittle), parse);
  EXPECT_GT(num_refused, 100u);
}

TEST(PlyReader, HoldsCountsAgainstTheFile) {
  for (const char* encoding : {"ascii", "binary_little_endian", "binary_big_endian"}) {
    EXPECT_THAT(MessageOf(Header(encoding, "4000000000", "2") + kBody), HasSubstr("4000000000 rows of element vertex"));
    EXPECT_THAT(MessageOf(Header(encoding, "9223372036854775807", "2") + kBody), HasSubstr("element vertex"));
    EXPECT_THAT(MessageOf(Header(encoding, "99999999999999999999", "2") + kBody), HasSubstr("line 4"));
    EXPECT_THAT(MessageOf(Header(encoding, "-1", "2") + kBody), HasSubstr("\"-1\""));
  }
  // Rows without values take no bytes, however many are announced.
  EXPECT_TRUE(
      Parse(FromText("ply\nformat ascii 1.0\nelement nothing 4000000000\nelement vertex 3\nproperty float x\n"
                     "property float y\nproperty float z\nelement face 1\nproperty list uchar int vertex_index\n"
                     "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2"))
          .ok());
}

// As grids of depth cameras have them where nothing was seen.
TEST(PlyReader, VerticesWithoutAPositionMayBeThereWhileNoTriangleUsesThem) {
  const std::string body = "nan nan nan 255\n0 0 0 255\n1 0 0 255\n1 1 0 255\n0 inf 0 255\n3 1 2 3 7\n";
  const auto mesh = Parse(FromText(Header("ascii", "5", "1") + body));
  ASSERT_TRUE(mesh.ok()) << mesh.status().message();
  EXPECT_THAT(mesh.value().triangles, ElementsAre(Triangle{1, 2, 3}));
  ASSERT_EQ(mesh.value().positions.size(), 5u);
  EXPECT_EQ(mesh.value().positions[0], (Vec3f{0, 0, 0}));
  EXPECT_EQ(mesh.value().positions[4], (Vec3f{0, 0, 0}));
  EXPECT_THAT(MessageOf(Header("ascii", "5", "2") + body + "3 2 3 4 7\n"), AllOf(HasSubstr("line 17"), HasSubstr("vertex 4"), HasSubstr("finite")));
}

TEST(PlyReader, NamesWhatIsWrong) {
  const std::string header = Header("ascii", "4", "2");
  EXPECT_THAT(MessageOf(header + "0 0 0 255\nnan 0 0 255\n1 1 0 255\n0 1 0 255\n4 0 1 2 3 7\n3 0 2 3 7\n"),
              AllOf(HasSubstr("line 14"), HasSubstr("vertex 1"), HasSubstr("finite")));
  EXPECT_THAT(MessageOf(header + "0 0 0 255\n1e39 0 0 255\n1 1 0 255\n0 1 0 255\n4 0 1 2 3 7\n3 0 2 3 7\n"),
              HasSubstr("vertex 1"));
  EXPECT_THAT(MessageOf(header + "0 0 0 255\n1 0 0 255\n1 1 0 255\n0 1 0 255\n4 0 1 2 3 7\n3 0 2 4 7\n"),
              AllOf(HasSubstr("face 1"), HasSubstr("index 4"), HasSubstr("4 vertices")));
  EXPECT_THAT(MessageOf(header + "0 0 0 255\n1 0 0 255\n1 1 0 255\n0 1 0 255\n4 0 -1 2 3 7\n3 0 2 3 7\n"),
              HasSubstr("index -1"));
  EXPECT_THAT(MessageOf(header + "0 0 0 255\n1 0 0 255\n1 1 0 255\n0 1 0 255\n2 0 1 7\n3 0 2 3 7\n"),
              HasSubstr("2 corners"));
  EXPECT_THAT(MessageOf(header + "0 0 0 255\nx 0 0 255\n1 1 0 255\n0 1 0 255\n4 0 1 2 3 7\n3 0 2 3 7\n"),
              HasSubstr("line 14: \"x\""));
  EXPECT_THAT(MessageOf(Header("ascii", "4", "0") + kBody), HasSubstr("no faces"));
  EXPECT_THAT(MessageOf("ply\nformat ascii 2.0\nend_header\n"), HasSubstr("2.0"));
  EXPECT_THAT(MessageOf("ply\nformat morse 1.0\nend_header\n"), HasSubstr("morse"));
  EXPECT_THAT(MessageOf("ply\nformat ascii 1.0\nCreated by hand\nelement vertex 3\nproprety float x\nend_header\n"), AllOf(HasSubstr("line 5"), HasSubstr("\"proprety\"")));
  EXPECT_THAT(MessageOf("plyx\n"), HasSubstr("no PLY file"));
  EXPECT_THAT(MessageOf(Header("ascii", "4", "2", "quad") + kBody), HasSubstr("quad"));
}

}  // namespace
}  // namespace lacerta
