// Stock Draco, as a library and as a program, opens the Draco form and gets the base mesh; it refuses the custom form.
#include <draco/compression/decode.h>
#include <draco/core/decoder_buffer.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <string>

#include "draco/mesh_conversion.h"
#include "draco/zero_level.h"
#include "draco_ext/draco/test_progressive_streams.h"

namespace lacerta {
namespace {

using ::lacerta::testing::MakeProgressiveStream;
using ::lacerta::testing::Octahedron;
using ::lacerta::testing::OnLattice;
using ::lacerta::testing::ProgressiveStream;
using ::lacerta::testing::ReadBinaryPly;
using ::lacerta::testing::RealMesh;
using ::lacerta::testing::SameBits;
using ::lacerta::testing::Torus;
using ::testing::HasSubstr;

StatusOr<TriangleMesh> StockDecode(Span<const uint8_t> stream) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(stream.data()), stream.size());
  auto mesh = draco::Decoder().DecodeMeshFromBuffer(&buffer);
  if (!mesh.ok()) return FromDracoStatus(mesh.status());
  return FromDracoMesh(*mesh.value());
}

void ExpectStockGetsBase(const ProgressiveStream& stream) {
  const StatusOr<TriangleMesh> whole = StockDecode(stream.DracoForm());
  ASSERT_TRUE(whole.ok()) << whole.status().message();
  const TriangleMesh base = stream.base.mesh.ToMesh();
  EXPECT_TRUE(SameBits(whole.value().positions, base.positions));
  EXPECT_EQ(whole.value().triangles, base.triangles);
}

TEST(StockReaderTest, DecoderGetsBaseOfDracoForm) {
  ExpectStockGetsBase(MakeProgressiveStream(Octahedron(), 3));
  ExpectStockGetsBase(MakeProgressiveStream(Torus(9, 7), 2));
}

TEST(StockReaderTest, DecoderGetsBaseOfEveryPrefix) {
  const ProgressiveStream stream = MakeProgressiveStream(Octahedron(), 2);
  const Bytes bytes = stream.DracoForm();
  const TriangleMesh base = stream.base.mesh.ToMesh();
  for (size_t size = stream.base.stream.size(); size <= bytes.size(); ++size) {
    const StatusOr<TriangleMesh> mesh = StockDecode(Span<const uint8_t>(bytes).First(size));
    ASSERT_TRUE(mesh.ok()) << size;
    EXPECT_TRUE(SameBits(mesh.value().positions, base.positions)) << size;
  }
}

TEST(StockReaderTest, DecoderGetsBaseOfRealMesh) {
  const auto mesh = RealMesh("fertility.ply");
  if (!mesh.has_value()) GTEST_SKIP() << "no fertility.ply in " LACERTA_TEST_DATA_DIR;
  ExpectStockGetsBase(MakeProgressiveStream(OnLattice(*mesh, 12, &ShortStep), 1));
}

TEST(StockReaderTest, DecoderRefusesCustomForm) {
  const Status status = StockDecode(MakeProgressiveStream(Octahedron(), 2).CustomForm()).status();
  EXPECT_THAT(status.message(), HasSubstr("Unsupported encoding method"));
}

// Runs the program on `stream` and reads what it wrote; `exit_code` is that of the shell.
std::optional<TriangleMesh> RunDracoDecoder(const Bytes& stream, const std::string& name, int* exit_code) {
  const std::string input = ::testing::TempDir() + name + ".drc";
  const std::string output = ::testing::TempDir() + name + ".ply";
  std::ofstream(input, std::ios::binary)
      .write(reinterpret_cast<const char*>(stream.data()), static_cast<std::streamsize>(stream.size()));
  std::remove(output.c_str());
  *exit_code = std::system(("draco_decoder -i '" + input + "' -o '" + output + "' > '" + input + ".log' 2>&1").c_str());
  return ReadBinaryPly(output);
}

bool HasDracoDecoder() { return std::system("command -v draco_decoder > /dev/null 2>&1") == 0; }

TEST(StockReaderTest, ProgramGetsBaseOfDracoForm) {
  if (!HasDracoDecoder()) GTEST_SKIP() << "no draco_decoder program (Debian package draco)";
  const ProgressiveStream stream = MakeProgressiveStream(Torus(9, 7), 2);
  int exit_code = -1;
  const auto mesh = RunDracoDecoder(stream.DracoForm(), "lacerta_draco_form", &exit_code);
  EXPECT_EQ(exit_code, 0);
  ASSERT_TRUE(mesh.has_value());
  const TriangleMesh base = stream.base.mesh.ToMesh();
  EXPECT_TRUE(SameBits(mesh->positions, base.positions));
  EXPECT_EQ(mesh->triangles, base.triangles);
}

TEST(StockReaderTest, ProgramDecodesZeroLevelStream) {
  if (!HasDracoDecoder()) GTEST_SKIP() << "no draco_decoder program (Debian package draco)";
  const CodedZeroLevel coded = EncodeZeroLevel(Torus(9, 7).ToMesh(), 11).value();
  int exit_code = -1;
  const auto mesh = RunDracoDecoder(coded.stream, "lacerta_zero_level", &exit_code);
  EXPECT_EQ(exit_code, 0);
  ASSERT_TRUE(mesh.has_value());
  EXPECT_TRUE(SameBits(mesh->positions, coded.mesh.positions));
  EXPECT_EQ(mesh->triangles, coded.mesh.triangles);
}

TEST(StockReaderTest, ProgramRefusesCustomForm) {
  if (!HasDracoDecoder()) GTEST_SKIP() << "no draco_decoder program (Debian package draco)";
  int exit_code = 0;
  const auto mesh =
      RunDracoDecoder(MakeProgressiveStream(Octahedron(), 2).CustomForm(), "lacerta_custom_form", &exit_code);
  EXPECT_NE(exit_code, 0);
  EXPECT_FALSE(mesh.has_value());
  std::ifstream log(::testing::TempDir() + "lacerta_custom_form.drc.log");
  const std::string said((std::istreambuf_iterator<char>(log)), std::istreambuf_iterator<char>());
  EXPECT_THAT(said, HasSubstr("Unsupported encoding method"));
}

}  // namespace
}  // namespace lacerta
