#include "lacerta/mesh_file.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <string>
#include <utility>

#include "gltf/test_bytes.h"
#include "lacerta/file_io.h"
#include "shapes/shapes.h"

namespace lacerta {
namespace {

using testing::FromText;
using ::testing::HasSubstr;

TriangleMesh Tetrahedron() {
  return {{{0.1f, 0, 0}, {1, 1e-20f, 0}, {0, 1, -3.4e38f}, {0, 0, 1.0f / 3}},
          {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};
}

class MeshFile : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = ::testing::TempDir() + "lacerta_mesh_file_" +
              std::to_string(::testing::UnitTest::GetInstance()->random_seed()) +
              ::testing::UnitTest::GetInstance()->current_test_info()->name();
    std::filesystem::create_directories(folder_);
  }
  void TearDown() override { std::filesystem::remove_all(folder_); }
  size_t NumFiles() const {
    return static_cast<size_t>(
        std::distance(std::filesystem::directory_iterator(folder_), std::filesystem::directory_iterator()));
  }

  std::string folder_;
};

TEST_F(MeshFile, WhatIsWrittenIsReadBackExactly) {
  const TriangleMesh mesh = Tetrahedron();
  for (const char* name : {"/a.ply", "/a.obj", "/a.glb", "/A.PLY"}) {
    const Status written = WriteMeshFile(mesh, folder_ + name);
    ASSERT_TRUE(written.ok()) << written.message();
    const StatusOr<TriangleMesh> read = ReadMeshFile(folder_ + name);
    ASSERT_TRUE(read.ok()) << read.status().message();
    EXPECT_EQ(read.value().positions, mesh.positions) << name;
    EXPECT_EQ(read.value().triangles, mesh.triangles) << name;
  }
  EXPECT_EQ(NumFiles(), 4u);  // and no temporary one
}

TEST_F(MeshFile, WritesNothingThatIsNotWhole) {
  TriangleMesh mesh = Tetrahedron();
  EXPECT_EQ(WriteMeshFile(mesh, folder_ + "/a.stl").code(), StatusCode::kUnsupported);
  EXPECT_EQ(WriteMeshFile(mesh, folder_ + "/missing/a.ply").code(), StatusCode::kIoError);
  mesh.triangles[2][1] = 4;
  const Status status = WriteMeshFile(mesh, folder_ + "/a.ply");
  EXPECT_EQ(status.code(), StatusCode::kInvalidArgument);
  EXPECT_THAT(status.message(), AllOf(HasSubstr("a.ply"), HasSubstr("triangle 2"), HasSubstr("index 4")));
  EXPECT_EQ(NumFiles(), 0u);
}

TEST_F(MeshFile, AFailedReplacementKeepsTheOldFile) {
  std::filesystem::create_directories(folder_ + "/a.ply");  // a folder stands in the way
  EXPECT_EQ(WriteMeshFile(Tetrahedron(), folder_ + "/a.ply").code(), StatusCode::kIoError);
  EXPECT_EQ(NumFiles(), 1u);
}

TEST_F(MeshFile, ReadingNamesTheFile) {
  const StatusOr<TriangleMesh> missing = ReadMeshFile(folder_ + "/none.ply");
  EXPECT_EQ(missing.status().code(), StatusCode::kNotFound);
  EXPECT_THAT(missing.status().message(), HasSubstr("none.ply"));
  EXPECT_EQ(ReadMeshFile(folder_).status().code(), StatusCode::kIoError);
  ASSERT_TRUE(WriteFileAtomically(folder_ + "/empty.obj", Bytes()).ok());
  EXPECT_THAT(ReadMeshFile(folder_ + "/empty.obj").status().message(),
              AllOf(HasSubstr("empty.obj"), HasSubstr("is empty")));
  ASSERT_TRUE(WriteFileAtomically(folder_ + "/a.xyz", FromText("0 0 0")).ok());
  EXPECT_EQ(ReadMeshFile(folder_ + "/a.xyz").status().code(), StatusCode::kUnsupported);
}

TEST_F(MeshFile, ContentGoesBeforeTheExtension) {
  ASSERT_TRUE(WriteMeshFile(Tetrahedron(), folder_ + "/a.ply").ok());
  std::filesystem::rename(folder_ + "/a.ply", folder_ + "/a.obj");
  EXPECT_TRUE(ReadMeshFile(folder_ + "/a.obj").ok());
}

Bytes ToUtf16(const std::string& text, bool is_big_endian) {
  Bytes bytes;
  for (const uint16_t unit : std::u16string(u"\xFEFF") + std::u16string(text.begin(), text.end())) {
    const auto high = static_cast<uint8_t>(unit >> 8), low = static_cast<uint8_t>(unit);
    bytes.push_back(is_big_endian ? high : low);
    bytes.push_back(is_big_endian ? low : high);
  }
  return bytes;
}

TEST_F(MeshFile, ReadsMarkedUtf8AndNamesUtf16) {
  const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", off = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  for (const auto& [text, format] : {std::pair(obj, MeshFormat::kObj), std::pair(off, MeshFormat::kOff)}) {
    const StatusOr<TriangleMesh> marked = ParseMesh(FromText("\xEF\xBB\xBF" + text), format);
    ASSERT_TRUE(marked.ok()) << marked.status().message();
    EXPECT_EQ(marked.value().positions, ParseMesh(FromText(text), format).value().positions);
    for (const bool is_big_endian : {false, true}) {
      const Status status = ParseMesh(ToUtf16(text, is_big_endian), format).status();
      EXPECT_EQ(status.code(), StatusCode::kUnsupported);
      EXPECT_THAT(status.message(), AllOf(HasSubstr("UTF-16"), HasSubstr("save it as UTF-8")));
    }
  }
}

TEST_F(MeshFile, ReadsRealMeshes) {
  const std::string path = std::string(LACERTA_TEST_DATA_DIR) + "/fandisk.ply";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "fandisk.ply is not there";
  const StatusOr<TriangleMesh> mesh = ReadMeshFile(path);
  ASSERT_TRUE(mesh.ok()) << mesh.status().message();
  EXPECT_EQ(mesh.value().positions.size(), 6475u);
  EXPECT_EQ(mesh.value().triangles.size(), 12946u);
}

// Pages that were passed come again, and a mapped file is parsed as one that was read.
TEST_F(MeshFile, MappedFilesAreReadAsOthers) {
  const TriangleMesh torus = shapes::Torus(400, 300);  // 240,000 triangles: pages are passed several times
  for (const char* name : {"/torus.ply", "/torus.obj"}) {
    const std::string path = folder_ + name;
    ASSERT_TRUE(WriteMeshFile(torus, path).ok());
    const Bytes expected = ReadFile(path).value();
    const FileBytes mapped = FileBytes::Open(path, 1).value(), read = FileBytes::Open(path, expected.size() + 1).value();
    EXPECT_FALSE(read.is_mapped());
    ASSERT_EQ(mapped.span().size(), expected.size());
    const auto is_expected = [&] { return std::equal(expected.begin(), expected.end(), mapped.span().begin()); };
    EXPECT_TRUE(is_expected());
    mapped.PassTo(mapped.span().end());
    mapped.PassTo(nullptr);
    EXPECT_TRUE(is_expected());
    for (const FileBytes* bytes : {&mapped, &read}) {
      const MeshFormat format = DetectMeshFormat(path, bytes->span()).value();
      EXPECT_EQ(ParseMesh(*bytes, format).value().triangles, torus.triangles);
      const FileMesh file = ParseFileMesh(*bytes, format, folder_).value();
      EXPECT_EQ(file.mesh.surface.positions, torus.positions);
      EXPECT_TRUE(file.mesh.attributes.empty());
    }
  }
  EXPECT_EQ(FileBytes::Open(folder_ + "/missing", 0).status().code(), StatusCode::kNotFound);
  EXPECT_EQ(FileBytes::Open(folder_, 0).status().code(), StatusCode::kIoError);
}

}  // namespace
}  // namespace lacerta
