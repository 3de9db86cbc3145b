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
  EXPECT_THAT(MessageOf("OFF BINARY\n"), HasSubstr("binary OFF"));
  EXPECT_THAT(MessageOf("OFF\n4 2 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1\n3 2 1 0 0 0\n"), HasSubstr("ends too early"));
  EXPECT_THAT(MessageOf("4OFF\n1 1 0\n"), HasSubstr("4OFF"));
  EXPECT_THAT(MessageOf("FOO\n"), HasSubstr("no OFF file"));
}

}  // namespace
}  // namespace lacerta
