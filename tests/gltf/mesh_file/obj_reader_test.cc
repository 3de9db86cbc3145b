#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "gltf/test_bytes.h"
#include "lacerta/mesh_file.h"

namespace lacerta {
namespace {

using ::testing::ElementsAre;
using testing::FromText;
using ::testing::HasSubstr;

StatusOr<TriangleMesh> Parse(Span<const uint8_t> bytes) { return ParseMesh(bytes, MeshFormat::kObj); }
std::string MessageOf(const std::string& text) { return Parse(FromText(text)).status().message(); }

const char kFile[] =
    "# a square with a roof\nmtllib a.mtl\nv 0 0 0\nv +1 0 0 1.0\nv 1 1 0 0.5 0.5 0.5\nv 0 1 0\nvt 0 0\nvn 0 0 1\no "
    "part\n"
    "usemtl red\ns 1\nf 1 2 3 4\nf 1/1 2/1 3/1\nf 1//1 2//1 3//1\nf 1/1/1 \\\n2/1/1 3/1/1\nv 0.5 2 0\nf -1 -3 -2\n";

TEST(ObjReader, ReadsEveryFormOfFace) {
  const StatusOr<TriangleMesh> mesh = Parse(FromText(kFile));
  ASSERT_TRUE(mesh.ok()) << mesh.status().message();
  EXPECT_EQ(mesh.value().positions.size(), 5u);
  EXPECT_THAT(mesh.value().triangles, ElementsAre(Triangle{0, 1, 2}, Triangle{0, 2, 3}, Triangle{0, 1, 2},
                                                  Triangle{0, 1, 2}, Triangle{0, 1, 2}, Triangle{4, 2, 3}));
}

TEST(ObjReader, FacesMayComeFirst) {
  EXPECT_TRUE(Parse(FromText("f 1 2 3\nv 0 0 0\nv 1 0 0\nv 0 1 0\n")).ok());
  EXPECT_TRUE(Parse(FromText("v 0 0 0\r\nv 1 0 0\r\nv 0 1 0\r\nf 1 2 3 # here\r\n")).ok());
}

TEST(ObjReader, EveryTruncationIsReadOrRefusedByName) {
  testing::ForEveryPrefix(FromText(kFile), [](Span<const uint8_t> prefix) {
    const StatusOr<TriangleMesh> mesh = Parse(prefix);
    if (!mesh.ok()) {
      EXPECT_FALSE(mesh.status().message().empty());
      return;
    }
    for (const Triangle& triangle : mesh.value().triangles) {
      for (const uint32_t index : triangle) ASSERT_LT(index, mesh.value().positions.size());
    }
  });
}

TEST(ObjReader, NamesWhatIsWrong) {
  const std::string vertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  EXPECT_THAT(MessageOf(vertices + "f 1 2 99\nf 1 2 3\n"), AllOf(HasSubstr("line 4"), HasSubstr("index 99")));
  EXPECT_THAT(MessageOf(vertices + "f 0 1 2\n"), AllOf(HasSubstr("line 4"), HasSubstr("index 0")));
  EXPECT_THAT(MessageOf(vertices + "f -4 1 2\n"), HasSubstr("index -4"));
  EXPECT_THAT(MessageOf(vertices + "f 1 2 9223372036854775807\n"), HasSubstr("out of range"));
  EXPECT_THAT(MessageOf(vertices + "f 1 2 4294967298\n"), HasSubstr("out of range"));
  EXPECT_THAT(MessageOf(vertices + "f 1 2\n"), HasSubstr("2 corners"));
  EXPECT_THAT(MessageOf(vertices + "f 1 b 2\n"), HasSubstr("\"b\""));
  EXPECT_THAT(MessageOf("v 0 0 0\nv inf 0 0\nv 0 1 0\nf 1 2 3\n"), AllOf(HasSubstr("line 2"), HasSubstr("vertex 1")));
  EXPECT_THAT(MessageOf("v 0 0\nf 1 1 1\n"), HasSubstr("fewer than three"));
  EXPECT_THAT(MessageOf("v 0 0 z\n"), HasSubstr("\"z\""));
  EXPECT_THAT(MessageOf(vertices), HasSubstr("no faces"));
}

}  // namespace
}  // namespace lacerta
