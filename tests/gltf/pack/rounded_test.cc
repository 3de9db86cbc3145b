#include "pack/rounded.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <string>
#include <vector>

#include "gltf/pack/textured_ball.h"
#include "lacerta/surface_distance.h"

namespace lacerta {
namespace {

using testing::TexturedBall;

double Texels(uint64_t) { return 1024.0; }

// What a viewer sees of the decoded primitive, by a meter of our own.
SurfaceErrors Seen(const Primitive& original, const Primitive& decoded, const TexelScale& scale) {
  const AttributedMesh before = ToAttributedMesh({&original}, scale).value();
  const AttributedMesh after = ToAttributedMesh({&decoded}, scale).value();
  return SurfaceErrorMeter::Create(before, 1024.0).value().Measure(after, 50'000).value();
}

// Of positions.
double StepOf(const RoundedFamily& family) {
  const Lattice& lattice = family.precisions[0].positions;
  return static_cast<double>(lattice.range) / static_cast<double>((int64_t{1} << lattice.bits) - 1);
}

TEST(Rounded, IsGivenUpWhereItTakesFarMore) {
  Primitive primitive = TexturedBall(1.0f);
  primitive.attributes.resize(1);  // values of others descend to far less than what is compared
  const FamilyMeter meter({&primitive}, DistanceOfPsnr(50.0, BoundingBoxDiagonal(Surface(primitive))), {}, 1024, [](size_t, uint64_t set) { return Texels(set); });
  const auto within = [&](uint64_t most_bytes) { return RoundFamily(meter.primitives(), meter, nullptr, {}, nullptr, most_bytes); };
  const auto free = RoundFamily(meter.primitives(), meter);
  ASSERT_TRUE(free.ok()) << free.status().message();
  const uint64_t bytes = free.value().members[0].bytes.size();
  const auto enough = within(bytes);
  ASSERT_TRUE(enough.ok()) << enough.status().message();
  EXPECT_EQ(enough.value().members[0].bytes, free.value().members[0].bytes);
  for (const uint64_t share : {2, 20}) {  // by what precisions take, and by positions alone that are far too coarse
    const Status refused = within(bytes / share).status();
    EXPECT_EQ(refused.code(), StatusCode::kUnsupported) << share;
    EXPECT_NE(refused.message().find("it would be larger (about "), std::string::npos) << refused.message();
    const uint64_t told = std::stoull(refused.message().substr(refused.message().find("about ") + 6));
    EXPECT_GT(told, bytes / share) << share;
    EXPECT_LT(told, 1.1 * static_cast<double>(bytes)) << share;
  }
}

TEST(Rounded, IsGivenUpByAllThatHasATarget) {
  const Primitive primitive = TexturedBall(1.0f);
  const FamilyMeter meter({&primitive}, DistanceOfPsnr(50.0, BoundingBoxDiagonal(Surface(primitive))), {}, 1024, [](size_t, uint64_t set) { return Texels(set); });
  const auto free = RoundFamily(meter.primitives(), meter);
  ASSERT_TRUE(free.ok()) << free.status().message();
  const uint64_t bytes = free.value().members[0].bytes.size();
  const auto told = [&](uint64_t most_bytes) {
    const std::string text = RoundFamily(meter.primitives(), meter, nullptr, {}, nullptr, most_bytes).status().message();
    return std::stoull(text.substr(text.find("about ") + 6));
  };
  Primitive bare = primitive;
  bare.attributes.resize(1);
  const FamilyMeter positions({&bare}, meter.error(), {}, 1024, meter.texels_per_unit());
  const std::string text = RoundFamily(positions.primitives(), positions, nullptr, {}, nullptr, 1).status().message();
  EXPECT_GT(told(1), 1.2 * static_cast<double>(std::stoull(text.substr(text.find("about ") + 6))));
  EXPECT_LT(told(1), bytes);
}

TEST(Rounded, PositionsThatSlideUnderTheTextureGetMoreBits) {
  const TexelScale scale = [](size_t, uint64_t set) { return Texels(set); };
  const double diagonal = BoundingBoxDiagonal(Surface(TexturedBall(1.0f)));
  const double error = DistanceOfPsnr(50.0, diagonal);
  int bits_before = 0;
  for (const float repeats : {0.05f, 4.0f}) {
    const Primitive primitive = TexturedBall(repeats);
    const FamilyMeter meter({&primitive}, error, {}, 1024, scale);
    const auto rounded = RoundFamily(meter.primitives(), meter);
    ASSERT_TRUE(rounded.ok()) << rounded.status().message();
    const RoundedFamily& family = rounded.value();
    ASSERT_EQ(family.members.size(), 1u);
    EXPECT_EQ(family.everywhere.size(), 2u);  // however often it was measured
    const SurfaceErrors seen = Seen(primitive, family.members[0].decoded, scale);
    EXPECT_LE(seen.distance, 1.02 * error);
    EXPECT_LE(seen.attributes[0].rms_99, 1.02 * AttributeTargets().normal_degrees);
    EXPECT_LE(seen.attributes[1].rms_99, 1.02 * AttributeTargets().uv_texels);
    EXPECT_LE(seen.turned, 6e-4);
    EXPECT_GE(family.reports[0][1].error, 0.9 * seen.attributes[1].rms_99);  // the report owns up to it
    const int bits = family.precisions[0].positions.bits;
    if (bits_before == 0) {
      EXPECT_GE(family.reports[0][0].error, 0.5 * AttributeTargets().normal_degrees);  // a bit fewer would be too much
    } else {
      EXPECT_GT(bits, bits_before + 1);  // the distance alone would be happy with fewer
      EXPECT_GT(seen.attributes[1].rms, 0.1 * AttributeTargets().uv_texels);  // not just any bits
    }
    bits_before = bits;
  }
}

// A knob of six sides whose rings have narrow grooves, with hard edges along all rings and normals that are smooth around it.
Primitive GroovedKnob(float width, uint32_t num_grooves) {
  constexpr uint32_t kSides = 6;
  std::vector<std::array<float, 2>> rings = {{0.02f, 0}};  // radius, height
  for (uint32_t g = 0; g <= num_grooves; ++g) {
    const float radius = 1 + std::sin(3.0f * static_cast<float>(g) / static_cast<float>(num_grooves)), height = 10.0f * static_cast<float>(g) / static_cast<float>(num_grooves);
    rings.insert(rings.end(), {{radius, height}, {radius - width, height + width / 2}, {radius, height + width}});
  }
  rings.push_back({0.02f, 11});
  Primitive primitive;
  std::vector<Vec3f> positions, normals;
  for (size_t r = 0; r + 1 < rings.size(); ++r) {
    const float out = rings[r + 1][0] - rings[r][0], up = rings[r + 1][1] - rings[r][1], length = std::hypot(out, up);
    const auto first = static_cast<uint32_t>(positions.size());
    for (const auto& [radius, height] : {rings[r], rings[r + 1]}) {
      for (uint32_t k = 0; k < kSides; ++k) {
        const float angle = 6.2831853f * static_cast<float>(k) / kSides;
        positions.push_back({radius * std::cos(angle), radius * std::sin(angle), height});
        normals.push_back({up / length * std::cos(angle), up / length * std::sin(angle), -out / length});
      }
    }
    for (uint32_t k = 0; k < kSides; ++k) {
      const uint32_t a = first + k, b = first + (k + 1) % kSides;
      primitive.triangles.insert(primitive.triangles.end(), {{a, b, a + kSides}, {b, b + kSides, a + kSides}});
    }
  }
  primitive.num_vertices = positions.size();
  primitive.attributes = {{"POSITION", MakeFloatAccessor(positions)}, {"NORMAL", MakeFloatAccessor(normals)}};
  return primitive;
}

// Where positions may be far off, as those of small parts of large scenes, normals on the wrong sides of grooves want fine positions all the same, and not
// finer normals. What is enough for a small distance is for a large one.
TEST(Rounded, LargeDistancesTakeNoMoreBytes) {
  const TexelScale scale = [](size_t, uint64_t set) { return Texels(set); };
  size_t bytes_before = 0;
  for (const double share : {0.001, 0.01, 0.05, 0.2}) {
    size_t bytes = 0;  // of all knobs: on which side of its groove a normal lies is a matter of chance
    for (const float width : {0.2f, 0.06f, 0.04f, 0.01f, 0.003f}) {
      const Primitive primitive = GroovedKnob(width, 12);
      const double diagonal = BoundingBoxDiagonal(Surface(primitive));
      const FamilyMeter meter({&primitive}, share * diagonal, {}, 1024, scale);
      const auto rounded = RoundFamily(meter.primitives(), meter);
      ASSERT_TRUE(rounded.ok()) << rounded.status().message();
      const RoundedFamily& family = rounded.value();
      const SurfaceErrors seen = Seen(primitive, family.members[0].decoded, scale);
      EXPECT_LE(seen.distance, 1.02 * share * diagonal);
      EXPECT_LE(seen.attributes[0].rms_99, 1.02 * AttributeTargets().normal_degrees);
      EXPECT_LE(seen.turned, 6e-4);
      const size_t own = family.members[0].bytes.size();
      EXPECT_LE(own, 1300u) << width << ' ' << share;
      if (width < 0.004f && share > 0.1) {
        EXPECT_LE(own, 500u);  // grooves so narrow may be closed
      }
      bytes += own;
    }
    if (bytes_before != 0) {
      EXPECT_LE(static_cast<double>(bytes), 1.05 * static_cast<double>(bytes_before)) << share;
    }
    bytes_before = bytes;
  }
}

// A flat square of 1,600 cells, each with a color of the texture of its own; all but `num_textured` have the same one.
Primitive FlatSquare(uint32_t num_textured) {
  constexpr uint32_t kCells = 40;
  Primitive primitive;
  std::vector<Vec3f> positions;
  std::vector<float> texture;
  for (uint32_t cell = 0; cell < kCells * kCells; ++cell) {
    const auto column = cell % kCells, row = cell / kCells;
    const auto x = static_cast<float>(column), y = static_cast<float>(row);
    const auto v = static_cast<uint32_t>(positions.size());
    positions.insert(positions.end(), {{x, y, 0}, {x + 1, y, 0}, {x + 1, y + 1, 0}, {x, y + 1, 0}});
    const bool is_textured = cell < num_textured;
    for (int k = 0; k < 4; ++k) texture.insert(texture.end(), {is_textured ? 7.3f + 0.1f * static_cast<float>(k) : 0.0f, is_textured ? 0.3f * x : 0.0f});
    primitive.triangles.insert(primitive.triangles.end(), {{v, v + 1, v + 2}, {v, v + 2, v + 3}});
  }
  primitive.num_vertices = positions.size();
  primitive.attributes = {{"POSITION", MakeFloatAccessor(positions)}, {"TEXCOORD_0", MakeFloatAccessor(texture, 2)}};
  return primitive;
}

// Forecasts know of no error: positions move within the plane, and texture coordinates err on a hundredth of the area, which is left out.
TEST(Rounded, ErrorsThatNoForecastTellsAreMeasured) {
  const TexelScale scale = [](size_t, uint64_t set) { return Texels(set); };
  constexpr double kError = 0.01;
  for (const uint32_t num_textured : {0u, 16u, 17u}) {
    const Primitive primitive = FlatSquare(num_textured);
    const FamilyMeter meter({&primitive}, kError, {}, 1024, scale);
    const auto rounded = RoundFamily(meter.primitives(), meter);
    ASSERT_TRUE(rounded.ok()) << rounded.status().message();
    const SurfaceErrors seen = Seen(primitive, rounded.value().members[0].decoded, scale);
    EXPECT_LE(seen.distance, 1.02 * kError);
    EXPECT_LE(seen.attributes[0].rms_99, 1.02 * AttributeTargets().uv_texels);
    EXPECT_LE(rounded.value().precisions[0].positions.bits, 12);
    EXPECT_LE(rounded.value().reports[0][0].bits, 14);
  }
}

// Colors of bytes stay as they are, but slide along with the positions below them, of which the forecast knows nothing.
TEST(Rounded, PositionsGetMoreBitsForColorsThatStayExact) {
  Primitive primitive = TexturedBall(1.0f);
  AccessorData colors;
  colors.type = ComponentType::kUint8;
  colors.normalized = true;
  colors.components = 4;
  colors.count = primitive.num_vertices;
  for (uint64_t v = 0; v < colors.count; ++v) {
    const auto noise = static_cast<uint8_t>(100 + v * 7919 % 60);
    colors.bytes.insert(colors.bytes.end(), {noise, noise, noise, 255});
  }
  primitive.attributes.resize(1);
  const TexelScale scale = [](size_t, uint64_t set) { return Texels(set); };
  const double error = DistanceOfPsnr(50.0, BoundingBoxDiagonal(Surface(primitive)));
  const FamilyMeter plain({&primitive}, error, {}, 1024, scale);
  const double step = StepOf(RoundFamily(plain.primitives(), plain).value());
  primitive.attributes.push_back({"COLOR_0", colors});
  const FamilyMeter meter({&primitive}, error, {}, 1024, scale);
  const auto rounded = RoundFamily(meter.primitives(), meter);
  ASSERT_TRUE(rounded.ok()) << rounded.status().message();
  const SurfaceErrors seen = Seen(primitive, rounded.value().members[0].decoded, scale);
  const double allowed = FamilyTargets(meter.original(), error, {}, 1024).attributes[0];
  EXPECT_LE(seen.attributes[0].rms_99, 1.02 * allowed);
  EXPECT_GE(seen.attributes[0].rms_99, 0.2 * allowed);  // not just any bits
  EXPECT_LT(StepOf(rounded.value()), 0.9 * step);
}

TEST(Rounded, SurfacesWithoutAreaAreHeldToTheirVertices) {
  Primitive primitive = TexturedBall(1.0f);
  primitive.triangles = {{0, 0, 1}};
  const FamilyMeter meter({&primitive}, 0.01, {}, 1024, [](size_t, uint64_t set) { return Texels(set); });
  EXPECT_FALSE(meter.status().ok());
  const auto rounded = RoundFamily(meter.primitives(), meter);
  // Draco drops what has no area, so there may be nothing to encode; never a crash or a search without end.
  if (rounded.ok()) {
    EXPECT_TRUE(rounded.value().everywhere.empty());
  }
}

}  // namespace
}  // namespace lacerta
