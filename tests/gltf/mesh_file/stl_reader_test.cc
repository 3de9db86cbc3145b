#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "gltf/test_bytes.h"
#include "lacerta/mesh_file.h"
#include "shapes/shapes.h"

namespace lacerta {
namespace {

using testing::Append;
using ::testing::ElementsAre;
using testing::FromText;
using ::testing::HasSubstr;

StatusOr<TriangleMesh> Parse(Span<const uint8_t> bytes) { return ParseMesh(bytes, MeshFormat::kStl); }
std::string MessageOf(const Bytes& bytes) { return Parse(bytes).status().message(); }

const char kText[] =
    "solid a vertex of words\nfacet normal 0 0 1\n outer loop\n  vertex 0 0 0\n  vertex 1 0 0\n  vertex 0 1e0 0\n "
    "endloop\n"
    "endfacet\nendsolid a\n";

// Two triangles; `comment` is what the 80 bytes begin with.
Bytes Binary(const std::string& comment, uint32_t count = 2, float corner = 1.0f) {
  Bytes bytes = FromText(comment);
  bytes.resize(80, 0);
  Append(count, &bytes);
  for (int triangle = 0; triangle < 2; ++triangle) {
    for (const float value : {0.f, 0.f, 1.f, 0.f, 0.f, 0.f, corner, 0.f, 0.f, 0.f, 1.f, static_cast<float>(triangle)}) {
      Append(value, &bytes);
    }
    Append(uint16_t{0}, &bytes);
  }
  return bytes;
}

TEST(StlReader, ReadsTextAndBinary) {
  const StatusOr<TriangleMesh> text = Parse(FromText(kText));
  ASSERT_TRUE(text.ok()) << text.status().message();
  EXPECT_THAT(text.value().positions, ElementsAre(Vec3f{0, 0, 0}, Vec3f{1, 0, 0}, Vec3f{0, 1, 0}));
  EXPECT_THAT(text.value().triangles, ElementsAre(Triangle{0, 1, 2}));
  for (const char* comment : {"", "solid but binary"}) {
    const StatusOr<TriangleMesh> binary = Parse(Binary(comment));
    ASSERT_TRUE(binary.ok()) << binary.status().message();
    EXPECT_THAT(binary.value().positions, ElementsAre(Vec3f{0, 0, 0}, Vec3f{1, 0, 0}, Vec3f{0, 1, 0}, Vec3f{0, 1, 1}));
    EXPECT_THAT(binary.value().triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{0, 1, 3}));
  }
}

// Six corners meet in every vertex of the torus, none elsewhere; -0 is 0.
TEST(StlReader, CornersAtOnePlaceAreOneVertex) {
  const TriangleMesh torus = shapes::Torus(40, 30);
  Bytes bytes(80, 0);
  Append(static_cast<uint32_t>(torus.triangles.size()), &bytes);
  for (const Triangle& t : torus.triangles) {
    for (int zero = 0; zero < 3; ++zero) Append(0.0f, &bytes);
    for (const uint32_t v : t) {
      for (int axis = 0; axis < 3; ++axis) {
        const float value = torus.positions[v][axis];
        Append(value == 0 && t[0] % 2 == 0 ? -value : value, &bytes);
      }
    }
    Append(uint16_t{0}, &bytes);
  }
  const StatusOr<TriangleMesh> read = Parse(bytes);
  ASSERT_TRUE(read.ok()) << read.status().message();
  ASSERT_EQ(read.value().positions.size(), torus.positions.size());
  ASSERT_EQ(read.value().triangles.size(), torus.triangles.size());
  for (size_t f = 0; f < torus.triangles.size(); ++f) {
    for (size_t k = 0; k < 3; ++k) {
      ASSERT_EQ(read.value().positions[read.value().triangles[f][k]], torus.positions[torus.triangles[f][k]]);
    }
  }
}

TEST(StlReader, RefusesEveryTruncation) {
  const Bytes text = FromText(kText);
  testing::ForEveryPrefix(text, [&](Span<const uint8_t> prefix) {
    // The word "endsolid" ends 3 bytes before the file.
    EXPECT_EQ(Parse(prefix).ok(), prefix.size() + 3 >= text.size()) << prefix.size();
  });
  const Bytes binary = Binary("");
  testing::ForEveryPrefix(
      binary, [&](Span<const uint8_t> prefix) { EXPECT_EQ(Parse(prefix).ok(), prefix.size() == binary.size()); });
}

TEST(StlReader, NamesWhatIsWrong) {
  EXPECT_THAT(MessageOf(Binary("", 4000000000u)), HasSubstr("4000000000 triangles"));
  EXPECT_THAT(MessageOf(Binary("", 0)), HasSubstr("no faces"));
  EXPECT_THAT(MessageOf(Binary("", 2, std::nanf(""))), AllOf(HasSubstr("byte 108"), HasSubstr("vertex 1")));
  EXPECT_THAT(MessageOf(FromText("solid\nfacet\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nendloop\nendsolid\n")),
              AllOf(HasSubstr("line 6"), HasSubstr("2 corners")));
  EXPECT_THAT(MessageOf(FromText("solid\nvertex 0 inf 0\n")), HasSubstr("vertex 0"));
  EXPECT_THAT(MessageOf(FromText("solid\nvertex 0 a 0\n")), HasSubstr("\"a\""));
  EXPECT_THAT(MessageOf(FromText("solid\nendsolid\n")), HasSubstr("no faces"));
}

}  // namespace
}  // namespace lacerta
