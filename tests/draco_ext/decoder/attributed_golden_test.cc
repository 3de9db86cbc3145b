// As golden_test.cc, of streams with attributes.
#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include "draco_ext/encoder/attributed_test_streams.h"
#include "lacerta/decoder.h"

namespace lacerta {
namespace {

using ::lacerta::testing::AttributedTestStream;
using ::lacerta::testing::MakeAttributedTestStream;
using ::lacerta::testing::OctahedronWithAttributes;

constexpr int kNumLevels = 3;

struct Case {
  const char* name;
  bool is_chained;
};

class AttributedGoldenTest : public ::testing::TestWithParam<Case> {
 protected:
  static std::string PathOf(const char* extension) { return std::string(LACERTA_GOLDEN_DIR) + "/v1/" + GetParam().name + extension; }
};

template <typename Value>
std::string List(const std::vector<Value>& values) {
  std::ostringstream out;
  out.precision(9);
  out << "[";
  for (size_t i = 0; i < values.size(); ++i) out << (i == 0 ? "" : ",") << +values[i];
  return out.str() + "]";
}

template <typename Row>
std::string Rows(const std::vector<Row>& rows) {
  std::ostringstream out;
  out.precision(9);
  for (size_t i = 0; i < rows.size(); ++i) out << (i == 0 ? "[[" : ",[") << rows[i][0] << ',' << rows[i][1] << ',' << rows[i][2] << ']';
  return out.str() + "]";
}

std::string Describe(const AttributedTestStream& stream, const ProgressiveDecoder& decoder) {
  const AttributedBase& base = stream.base;
  std::ostringstream out;
  out.precision(9);
  out << "{\"base\": {\"step\": " << base.mesh.step << ",\n\"lattice\": " << Rows(base.mesh.lattice) << ",\n\"triangles\": " << Rows(base.mesh.triangles)
      << ",\n\"group_sizes\": " << List(base.group_sizes) << ",\n\"attributes\": [";
  for (size_t a = 0; a < base.attributes.size(); ++a) {
    out << (a == 0 ? "" : ",") << "\n{\"in_group\": " << List(base.attributes[a].in_group) << ", \"values\": " << List(base.attributes[a].values) << "}";
  }
  out << "]},\n\"levels\": [";
  for (size_t i = 0; i < stream.positions.levels.size(); ++i) {
    out << (i == 0 ? "" : ",") << "\n{\"normal\": " << List(stream.positions.levels[i].normal) << ",\n\"tangential\": " << List(stream.positions.levels[i].tangential) << "}";
  }
  out << "],\n\"positions\": " << Rows(decoder.mesh().positions) << ",\n\"attributes\": [";
  for (size_t a = 0; a < base.attributes.size(); ++a) {
    out << (a == 0 ? "" : ",") << "\n{\"residuals\": [";
    for (int i = 0; i < kNumLevels; ++i) out << (i == 0 ? "" : ",") << List(stream.attributes.coded[a].residuals[static_cast<size_t>(i)]);
    out << "],\n\"values\": " << List(decoder.attributes()[a].values) << "}";
  }
  out << "]}\n";
  return out.str();
}

std::string ReadFile(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  EXPECT_TRUE(in.good()) << "cannot read " << path;
  return {std::istreambuf_iterator<char>(in), {}};
}

TEST_P(AttributedGoldenTest, DecodesAndIsWrittenAgain) {
  const AttributedTestStream stream = MakeAttributedTestStream(OctahedronWithAttributes(), kNumLevels, 41, 3.0, GetParam().is_chained);
  const Bytes& written = stream.refinement.bytes;
  const auto decode = [&](const Bytes& bytes) {
    ProgressiveDecoder decoder = ProgressiveDecoder::Create(stream.base, {}).value();
    const Status status = decoder.Append(bytes);
    EXPECT_TRUE(status.ok()) << status.message();
    EXPECT_EQ(decoder.level(), kNumLevels);
    EXPECT_EQ(decoder.bytes_used(), bytes.size());
    return Describe(stream, decoder);
  };
  if (std::getenv("LACERTA_REGENERATE_GOLDEN") != nullptr) {
    std::ofstream(PathOf(".lac"), std::ios::binary).write(reinterpret_cast<const char*>(written.data()), static_cast<std::streamsize>(written.size()));
    std::ofstream(PathOf(".json"), std::ios::binary) << decode(written);
  }
  const std::string file = ReadFile(PathOf(".lac"));
  const Bytes stored(file.begin(), file.end());
  EXPECT_EQ(stored, written) << "the writer of version 1 changed: streams in the field would not decode";
  EXPECT_EQ(decode(stored), ReadFile(PathOf(".json")));
}

INSTANTIATE_TEST_SUITE_P(Version1, AttributedGoldenTest,
                         ::testing::Values(Case{"octahedron_attributes", false}, Case{"octahedron_attributes_chained", true}),
                         [](const auto& at) { return std::string(at.param.name); });

}  // namespace
}  // namespace lacerta
