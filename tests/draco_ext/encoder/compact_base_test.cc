#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <utility>

#include "common/growing_front.h"
#include "common/integer_math.h"
#include "common/symbol_coding.h"
#include "decoder/range_decoder.h"
#include "draco_ext/encoder/test_streams.h"
#include "encoder/byte_writer.h"
#include "encoder/compact_base_encoder.h"
#include "encoder/quantizer.h"
#include "encoder/range_encoder.h"
#include "lacerta/decoder.h"
#include "shapes/shapes.h"

namespace lacerta {
namespace {

using ::lacerta::testing::Octahedron;
using ::lacerta::testing::Square;
using ::lacerta::testing::Torus;

Triangle StartingWithSmallest(Triangle t) {
  std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  return t;
}

// Codes, decodes, and checks that what comes back is the base but for its order, and codes to the same bytes again.
CompactBaseBytes ExpectRoundTrip(const BaseMesh& base, const std::string& name) {
  const StatusOr<CompactBaseBytes> coded = EncodeCompactBaseSmallest(base);
  EXPECT_TRUE(coded.ok()) << name << ": " << coded.status().message();
  if (!coded.ok()) return {};
  const CompactBaseBytes& c = coded.value();
  const StatusOr<CompactBase> decoded = DecodeCompactBase(c.bytes, {});
  EXPECT_TRUE(decoded.ok()) << name << ": " << decoded.status().message();
  if (!decoded.ok()) return {};
  const BaseMesh& mesh = decoded.value().mesh;
  EXPECT_EQ(mesh.step, base.step);
  EXPECT_EQ(mesh.lattice, c.mesh.lattice) << name;
  EXPECT_EQ(mesh.triangles, c.mesh.triangles) << name;
  EXPECT_EQ(c.vertex_map.size(), base.lattice.size()) << name;
  std::vector<Triangle> before, after;
  for (const Triangle& t : base.triangles) before.push_back(StartingWithSmallest(t));
  for (const Triangle& t : mesh.triangles) after.push_back(StartingWithSmallest({c.vertex_map[t[0]], c.vertex_map[t[1]], c.vertex_map[t[2]]}));
  std::sort(before.begin(), before.end());
  std::sort(after.begin(), after.end());
  EXPECT_EQ(before, after) << name;
  for (size_t v = 0; v < c.vertex_map.size(); ++v) EXPECT_EQ(mesh.lattice[v], base.lattice[c.vertex_map[v]]) << name;
  const StatusOr<CompactBaseBytes> again = EncodeCompactBase(mesh);
  EXPECT_TRUE(again.ok() && again.value().bytes == c.bytes && again.value().mesh.triangles == mesh.triangles) << name;
  return c;
}

BaseMesh OnLattice(const TriangleMesh& mesh, float step) { return RoundToLattice(mesh, step); }

// `mesh` without some of its triangles and the vertices that are in no other: holes, and parts that fall apart.
TriangleMesh WithHoles(const TriangleMesh& mesh, double share, std::mt19937* random) {
  for (int attempt = 0; attempt < 50; ++attempt) {
    std::vector<Triangle> kept;
    for (const Triangle& t : mesh.triangles) {
      if (static_cast<double>((*random)()) > share * 4294967296.0) kept.push_back(t);
    }
    // Where two holes touch in a vertex, all around it goes, until the rest is manifold or nothing.
    while (!kept.empty()) {
      std::vector<uint32_t> index(mesh.positions.size(), kNone);
      TriangleMesh result;
      for (const Triangle& t : kept) {
        for (const uint32_t v : t) {
          if (index[v] != kNone) continue;
          index[v] = static_cast<uint32_t>(result.positions.size());
          result.positions.push_back(mesh.positions[v]);
        }
        result.triangles.push_back({index[t[0]], index[t[1]], index[t[2]]});
      }
      const StatusOr<Topology> topology = BuildTopology(static_cast<uint32_t>(result.positions.size()), result.triangles);
      if (topology.ok()) return result;
      const std::string message = topology.status().message();  // "vertex N joins several fans of faces"
      const auto pinched = static_cast<uint32_t>(std::stoul(message.substr(message.find(' ') + 1)));
      std::vector<Triangle> rest;
      for (size_t f = 0; f < kept.size(); ++f) {
        const Triangle& t = result.triangles[f];
        if (std::find(t.begin(), t.end(), pinched) == t.end()) rest.push_back(kept[f]);
      }
      kept = std::move(rest);
    }
  }
  return mesh;
}

TEST(CompactBaseTest, CodesTheSmallestMeshes) {
  const BaseMesh triangle = {0.25f, {{{0, 0, 0}}, {{5, 0, 0}}, {{0, -7, 3}}}, {{{0, 1, 2}}}};
  const BaseMesh tetrahedron = {1, {{{0, 0, 0}}, {{5, 0, 0}}, {{0, 7, 3}}, {{1, 1, 9}}}, {{{0, 2, 1}}, {{0, 1, 3}}, {{1, 2, 3}}, {{2, 0, 3}}}};
  EXPECT_LT(ExpectRoundTrip(triangle, "triangle").bytes.size(), 20u);
  EXPECT_LT(ExpectRoundTrip(tetrahedron, "tetrahedron").bytes.size(), 22u);
  ExpectRoundTrip(Octahedron(), "octahedron");
  ExpectRoundTrip(Square(), "square");
}

TEST(CompactBaseTest, CodesEveryManifoldShape) {
  int coded = 0;
  for (const shapes::NamedShape& shape : shapes::AllShapes()) {
    if (!shape.manifold || !shape.oriented) continue;
    const BaseMesh base = OnLattice(shape.mesh, 1.0f / 256);
    if (!EncodeCompactBase(base).ok()) continue;  // vertices without triangles
    ExpectRoundTrip(base, shape.name);
    ++coded;
  }
  EXPECT_GE(coded, 8);
}

TEST(CompactBaseTest, CodesHandles) {
  for (const auto& [a, b] : {std::pair<uint32_t, uint32_t>{3, 3}, {4, 7}, {30, 11}}) {
    ExpectRoundTrip(Torus(a, b), "torus");
  }
  ExpectRoundTrip(OnLattice(shapes::TwoHoledPlate(1), 1.0f / 64), "genus 2, coarse");
  ExpectRoundTrip(OnLattice(shapes::TwoHoledPlate(6), 1.0f / 64), "genus 2");
}

BaseMesh FiveComponents() {
  BaseMesh many = Octahedron();
  for (const BaseMesh& other : {Square(), Torus(5, 4), Square(), Octahedron()}) {
    const auto offset = static_cast<uint32_t>(many.lattice.size());
    many.lattice.insert(many.lattice.end(), other.lattice.begin(), other.lattice.end());
    for (const Triangle& t : other.triangles) many.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  }
  return many;
}

TEST(CompactBaseTest, CodesSeveralComponents) { ExpectRoundTrip(FiveComponents(), "five components"); }

// Known bytes: tests/golden/v<version>/*.cbase, with the meshes that they hold beside them for tests/format/reference_decoder.py.
// LACERTA_REGENERATE_GOLDEN=1 writes them anew; do that only before the version is released.
TEST(CompactBaseTest, HasTheGoldenBytes) {
  BaseMesh odd = FiveComponents();
  odd.step = 0.1f;
  const std::vector<std::pair<std::string, CompactBaseBytes>> cases = {
      {"compact_five_components", EncodeCompactBase(odd, {1.5f, -0.25f, 3}).value()},
      {"compact_torus", EncodeCompactBase(Torus(14, 9)).value()}};
  for (const auto& [name, coded] : cases) {
    const std::string path = std::string(LACERTA_GOLDEN_DIR) + "/v1/" + name;
    if (std::getenv("LACERTA_REGENERATE_GOLDEN") != nullptr) {
      const CompactBase base = DecodeCompactBase(coded.bytes, {}).value();
      std::ofstream(path + ".cbase", std::ios::binary).write(reinterpret_cast<const char*>(coded.bytes.data()), static_cast<std::streamsize>(coded.bytes.size()));
      std::ofstream json(path + ".json");
      json.precision(17);
      json << "{\"step\": " << base.mesh.step << ", \"offset\": [" << base.offset.x << ", " << base.offset.y << ", " << base.offset.z << "]";
      const auto list = [&](const char* key, const auto& rows) {
        json << ",\n\"" << key << "\": [";
        for (size_t i = 0; i < rows.size(); ++i) json << (i > 0 ? ", [" : "[") << rows[i][0] << ", " << rows[i][1] << ", " << rows[i][2] << "]";
        json << "]";
      };
      list("lattice", base.mesh.lattice);
      list("triangles", base.mesh.triangles);
      json << "}\n";
    }
    std::ifstream in(path + ".cbase", std::ios::binary);
    ASSERT_TRUE(in.good()) << path;
    EXPECT_EQ(Bytes(std::istreambuf_iterator<char>(in), {}), coded.bytes) << name;
  }
}

TEST(CompactBaseTest, CodesRandomHoles) {
  std::mt19937 random(3);
  const TriangleMesh torus = shapes::Torus(24, 12), sphere = shapes::BumpySphere(3, 0.2f, 0.05f);
  size_t with_borders = 0;
  for (int i = 0; i < 40; ++i) {
    const TriangleMesh mesh = WithHoles(i % 2 == 0 ? torus : sphere, 0.01 * (1 + i % 12), &random);
    const Topology t = BuildTopology(static_cast<uint32_t>(mesh.positions.size()), mesh.triangles).value();
    for (uint32_t e = 0; e < t.num_edges(); ++e) with_borders += t.is_border(e);
    ExpectRoundTrip(OnLattice(mesh, 1.0f / 512), "holes " + std::to_string(i));
  }
  EXPECT_GT(with_borders, 1000u);
}

TEST(CompactBaseTest, CodesWildPositions) {
  std::mt19937 random(5);
  for (const int bits : {1, 8, 24}) {
    BaseMesh base = Torus(9, 8);
    for (auto& p : base.lattice) {
      for (int32_t& x : p) x = static_cast<int32_t>(random() >> (32 - bits)) - (1 << (bits - 1));
    }
    const size_t size = ExpectRoundTrip(base, "random positions").bytes.size();
    const size_t raw = 72 * 3 * static_cast<size_t>(bits) / 8;
    EXPECT_GE(size, raw);
    EXPECT_LE(size, raw + raw / 3 + 60);
  }
}

TEST(CompactBaseTest, IsSmall) {
  // A regular torus: hardly any connectivity, positions that are easy to tell.
  const CompactBaseBytes regular = ExpectRoundTrip(Torus(40, 20), "torus");
  EXPECT_LE(regular.connectivity_bytes, 50u);
  EXPECT_GE(regular.connectivity_bytes, 15u);
  EXPECT_LE(8.0 * static_cast<double>(regular.bytes.size()) / 800, 14.5);
  EXPECT_GE(8.0 * static_cast<double>(regular.bytes.size()) / 800, 8.0);
}

TEST(CompactBaseTest, KeepsStepAndOffset) {
  BaseMesh base = Octahedron();
  base.step = 0.1f;  // not short
  const CompactBaseBytes coded = EncodeCompactBase(base, {1.5f, -3.25f, 1e-3f}).value();
  const CompactBase decoded = DecodeCompactBase(coded.bytes, {}).value();
  EXPECT_EQ(decoded.mesh.step, 0.1f);
  EXPECT_EQ(decoded.offset, (Vec3f{1.5f, -3.25f, 1e-3f}));
  EXPECT_EQ(decoded.ToMesh().positions[0], decoded.offset + decoded.mesh.ToMesh().positions[0]);
}

TEST(CompactBaseTest, RefusesWhatItCannotCode) {
  const auto code_of = [](const BaseMesh& base) { return EncodeCompactBase(base).status().code(); };
  EXPECT_EQ(code_of(BaseMesh{}), StatusCode::kInvalidData);
  BaseMesh base = Octahedron();
  base.lattice.push_back({1, 2, 3});
  EXPECT_EQ(code_of(base), StatusCode::kInvalidData);
  base = Octahedron();
  base.lattice[2][1] = 1 << 24;
  EXPECT_EQ(code_of(base), StatusCode::kInvalidData);
  base = Octahedron();
  std::swap(base.triangles[3][0], base.triangles[3][1]);
  EXPECT_EQ(code_of(base), StatusCode::kInvalidData);
  base = Octahedron();
  base.step = 0;
  EXPECT_EQ(code_of(base), StatusCode::kInvalidData);
}

TEST(CompactBaseTest, KeepsToTheLimits) {
  const CompactBaseBytes coded = EncodeCompactBase(Torus(10, 10)).value();
  DecodeLimits limits;
  limits.max_vertices = 99;
  EXPECT_EQ(DecodeCompactBase(coded.bytes, limits).status().code(), StatusCode::kLimitExceeded);
  limits = {100, 199};
  EXPECT_EQ(DecodeCompactBase(coded.bytes, limits).status().code(), StatusCode::kLimitExceeded);
  limits = {100, 200};
  EXPECT_TRUE(DecodeCompactBase(coded.bytes, limits).ok());
}

// Found by fuzzing.
TEST(CompactBaseTest, RefusesAFirstPointOffTheLattice) {
  const Bytes good = EncodeCompactBase(Octahedron()).value().bytes;
  constexpr ptrdiff_t kFirstPoint = 5;  // after two varints of one byte, the step and the extent
  for (const int32_t value : {(1 << 24) - 1, 1 << 24, 1 - (1 << 24), -(1 << 24)}) {
    Bytes bytes(good.begin(), good.begin() + kFirstPoint);
    for (int c = 0; c < 3; ++c) PutSignedVarint(c == 1 ? value : 0, &bytes);
    bytes.resize(bytes.size() + 100);
    const std::string message = DecodeCompactBase(bytes, {}).status().message();
    EXPECT_EQ(message.find("first vertex of the compact base is off the lattice") != std::string::npos, std::abs(value) == 1 << 24) << value << message;
  }
}

TEST(CompactBaseTest, SurvivesTruncationAndEveryChangedByte) {
  for (const BaseMesh& base : {Torus(4, 4), Square(), OnLattice(shapes::PuncturedSphere(1), 1.0f / 128)}) {
    const Bytes good = EncodeCompactBase(base).value().bytes;
    const DecodeLimits limits = {2000, 4000};
    const auto decode = [&](const Bytes& bytes) {
      const StatusOr<CompactBase> decoded = DecodeCompactBase(bytes, limits);
      if (!decoded.ok()) return;
      const BaseMesh& mesh = decoded.value().mesh;
      EXPECT_TRUE(BuildTopology(static_cast<uint32_t>(mesh.lattice.size()), mesh.triangles).ok());
      for (const auto& p : mesh.lattice) {
        for (const int32_t x : p) EXPECT_LT(std::abs(x), 1 << 24);
      }
    };
    for (size_t size = 0; size < good.size(); ++size) decode(Bytes(good.begin(), good.begin() + static_cast<std::ptrdiff_t>(size)));
    EXPECT_EQ(DecodeCompactBase(Bytes(good.begin(), good.begin() + 6), limits).status().code(), StatusCode::kInvalidData);
    for (size_t i = 0; i < good.size(); ++i) {
      for (int value = 0; value < 256; ++value) {
        Bytes bytes = good;
        bytes[i] = static_cast<uint8_t>(value);
        decode(bytes);
      }
    }
  }
}

TEST(SymbolCodingTest, CodesIntegers) {
  const std::vector<uint32_t> values = {0, 1, 2, 3, 7, 8, 100, 65535, 1u << 20, (1u << 31) - 3};
  RangeEncoder encoder;
  IntegerModels models;
  for (const uint32_t value : values) {
    CodeByLength(models, value, &encoder);
    CodeUniform(value + 1, value / 2, &encoder);
  }
  const Bytes bytes = encoder.Finish();
  RangeDecoder decoder(bytes);
  IntegerModels again;
  for (const uint32_t value : values) {
    EXPECT_EQ(CodeByLength(again, 0, &decoder), value);
    EXPECT_EQ(CodeUniform(value + 1, 0, &decoder), value / 2);
  }
}

// Takes down the probabilities that it is given, and says one.
struct ProbabilityListener {
  std::vector<uint32_t> heard;
  bool Code(const BitModel& model, bool) {
    heard.push_back(model.ProbabilityOfOne());
    return true;
  }
};

TEST(SymbolCodingTest, UniformHalvesByTheShareOfTheUpperPart) {
  for (const uint32_t count : {2u, 3u, 5u, 7u, 100u, 255u, 257u, 32767u, 32769u, 65537u, (1u << 29) - 1, (1u << 31) + 1}) {
    ProbabilityListener listener;
    CodeUniform(count, 0, &listener);
    const uint64_t upper = count / 2;
    EXPECT_EQ(listener.heard.front(), std::max<uint64_t>((upper << 16) / count, kMinProbability)) << count;
  }
}

TEST(IntegerMathTest, RoundsAsTold) {
  EXPECT_EQ(DivideDown(-7, 2), -4);
  EXPECT_EQ(DivideRounded(-7, 2), -3);
  EXPECT_EQ(DivideRounded(7, 2), 4);
  EXPECT_EQ(DivideRounded(-8, 3), -3);
  for (const uint64_t x : {uint64_t{0}, uint64_t{1}, uint64_t{3}, uint64_t{4}, uint64_t{1} << 62, ~uint64_t{0}}) {
    const uint64_t root = SquareRoot(x);
    EXPECT_LE(root * root, x);
    EXPECT_TRUE(root == 0xffffffffu || (root + 1) * (root + 1) > x);
  }
  for (uint64_t root = 1; root < uint64_t{1} << 32; root += 1 + root / 97) {  // where floats round the other way, too
    EXPECT_EQ(SquareRoot(root * root), root);
    EXPECT_EQ(SquareRoot(root * root - 1), root - 1);
    EXPECT_EQ(SquareRoot(root * root + 2 * root), root);
  }
  EXPECT_EQ(ScaledTo({3, 0, -4}, 10), (std::array<int64_t, 3>{614, 0, -820}));
  EXPECT_EQ(ScaledTo({0, 0, 0}, 12), (std::array<int64_t, 3>{0, 0, 0}));
}

}  // namespace
}  // namespace lacerta
