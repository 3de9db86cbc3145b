#include "draco/attributed_stream.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <utility>

#include "draco/attributed_base_codec.h"
#include "draco/stock_stream.h"
#include "shapes/attributed_levels.h"
#include "shapes/attributed_shapes.h"

namespace lacerta {
namespace {

using ::testing::HasSubstr;

// A wavy cylinder whose texture is stretched here and there, with a seam.
AttributedNormalMesh WavyCylinder(int num_levels) {
  const auto place = [](Vec3f p) {
    const float radius = (1 + 0.1f * std::sin(3 * p.z) * std::cos(2 * std::atan2(p.y, p.x))) / std::max(1e-6f, std::hypot(p.x, p.y));
    return Vec3f{p.x * radius, p.y * radius, p.z};
  };
  const auto change = [](const LevelAttribute& a, float* row) {
    if (a.kind == AttributeKind::kNormal) {
      const Vec3f n = Normalized(Vec3f{row[0], row[1], row[2] + 0.2f * std::sin(5 * row[0])});
      for (int c = 0; c < 3; ++c) row[c] = n[c];
    } else {
      const float u = row[0], v = row[1];
      row[0] = u + 0.02f * std::sin(9 * v);
      row[1] = v + 0.03f * std::sin(7 * u);
    }
  };
  AttributedSemiRegularMesh mesh = shapes::SubdividedSoups({shapes::Cylinder(8, 8)}, num_levels, place, change);
  return {AsNormalMesh(std::move(mesh.surface)).value(), std::move(mesh.base_groups), std::move(mesh.attributes)};
}

// A box of two groups: one side, which has a color, and the others. All edges are seams of both attributes that all sides have.
AttributedNormalMesh BoxOfTwoGroups(int num_levels) {
  AttributedSemiRegularMesh mesh = shapes::SubdividedSoups(shapes::BoxOfTwoGroups(2), num_levels, [](Vec3f p) { return p; }, [](const LevelAttribute& a, float* row) {
    if (a.kind == AttributeKind::kColor) row[0] *= row[0];
  });
  return {AsNormalMesh(std::move(mesh.surface)).value(), std::move(mesh.base_groups), std::move(mesh.attributes)};
}

AttributedStreamOptions Options(double lambda, std::vector<double> errors) {
  AttributedStreamOptions options;
  options.lambda = lambda;
  options.errors = std::move(errors);
  return options;
}

// What a host does that has the base as floats of a stock Draco decoder.
AttributedBase BaseOfHost(const AttributedStream& stream) {
  const RefinementInfo info = ReadRefinementInfo(stream.refinement).value();
  std::vector<VertexSoup> soups;
  for (const Bytes& base : stream.bases) soups.push_back(DecodeAttributedGroup(base, info.attributes, {}).value());
  return AttributedBaseFromSoups(soups, info.base_step, info.attributes).value();
}

TEST(AttributedStreamTest, DecodesToWhatTheEncoderSaw) {
  for (const AttributedNormalMesh& mesh : {WavyCylinder(3), BoxOfTwoGroups(2)}) {
    const std::vector<double> errors(mesh.attributes.size(), 1e-3);
    const AttributedStream stream = EncodeAttributedStream(mesh, Options(1e-7, errors)).value();
    ProgressiveDecoder decoder = ProgressiveDecoder::Create(BaseOfHost(stream), {}).value();
    const Status status = decoder.Append(stream.refinement);
    ASSERT_TRUE(status.ok()) << status.message();
    EXPECT_TRUE(decoder.is_complete());
    EXPECT_EQ(decoder.bytes_used(), stream.refinement.size());
    ASSERT_EQ(decoder.attributes().size(), mesh.attributes.size());
    EXPECT_EQ(decoder.mesh().positions, stream.decoded.surface.positions);
    for (size_t a = 0; a < mesh.attributes.size(); ++a) {
      EXPECT_EQ(decoder.attributes()[a].values, stream.decoded.attributes[a].values);
      EXPECT_EQ(decoder.attributes()[a].values.size(), mesh.attributes[a].values.size());
      EXPECT_EQ(decoder.Corners(a), AttributedMeshAtLevel(stream.decoded, decoder.level()).value().attributes[a].corners);
    }
    EXPECT_EQ(decoder.Groups(), AttributedMeshAtLevel(stream.decoded, decoder.level()).value().groups);
  }
}

// The errors asked for are met, and not by giving more than that.
TEST(AttributedStreamTest, ErrorsAreMetAndLittleIsLeftOfThem) {
  const AttributedNormalMesh mesh = WavyCylinder(4);
  const AttributedStream stream = EncodeAttributedStream(mesh, Options(1e-7, {1e-3, 1.0})).value();
  for (size_t a = 0; a < 2; ++a) {
    const double asked = a == 0 ? 1e-3 : 1.0;
    EXPECT_LE(stream.errors[a], asked);
    EXPECT_GE(stream.errors[a], 0.5 * asked);
  }
  const AttributedStream finer = EncodeAttributedStream(mesh, Options(1e-7, {1e-4, 0.25})).value();
  EXPECT_LE(finer.errors[0], 1e-4);
  EXPECT_LE(finer.errors[1], 0.25);
  EXPECT_GT(finer.size(), stream.size());
}

// Values count by their factors: where these are a tenth, ten times the error is as good.
TEST(AttributedStreamTest, WhatCountsLessTakesFewerBytes) {
  const AttributedNormalMesh mesh = WavyCylinder(4);
  AttributedStreamOptions options = Options(1e-7, {1e-4, 1.0});
  const AttributedStream all = EncodeAttributedStream(mesh, options).value();
  options.factors = [](const AttributedSemiRegularMesh& wanted, size_t attribute) {
    return std::vector<float>(attribute == 0 ? wanted.attributes[0].values.size() : 0, 0.1f);
  };
  const AttributedStream less = EncodeAttributedStream(mesh, options).value();
  const AttributedStream coarse = EncodeAttributedStream(mesh, Options(1e-7, {1e-3, 1.0})).value();
  EXPECT_LT(2 * less.residual_bytes[0], all.residual_bytes[0]);
  EXPECT_LE(less.residual_bytes[0], 2 * coarse.residual_bytes[0] + 16);
  EXPECT_LE(less.errors[0], 1e-4);
  EXPECT_EQ(less.residual_bytes[1], all.residual_bytes[1]);
}

// Gray noise takes what one component takes, and little more; colors that have nothing to do with one another take thrice as much, and no more.
TEST(AttributedStreamTest, ColorsThatChangeAlikeAreToldOnce) {
  const auto bytes_of = [](AttributeKind kind, uint32_t components, bool is_gray) {
    AttributedNormalMesh mesh = WavyCylinder(4);
    LevelAttribute noise = mesh.attributes[0];
    const size_t num_values = noise.num_values();
    noise.name = "NOISE";
    noise.kind = kind;
    noise.components = components;
    noise.values.clear();
    std::mt19937 random(5);
    for (size_t row = 0; row < num_values; ++row) {
      float value = 0;
      for (uint32_t c = 0; c < components; ++c) {
        if (c == 0 || !is_gray) value = static_cast<float>(random() % 256) / 255;
        noise.values.push_back(value);
      }
    }
    mesh.attributes = {noise};
    return EncodeAttributedStream(mesh, Options(1e-7, {0.02 * std::sqrt(components)})).value().residual_bytes[0];
  };
  const size_t one = bytes_of(AttributeKind::kGeneric, 1, true), gray = bytes_of(AttributeKind::kColor, 3, true), colorful = bytes_of(AttributeKind::kColor, 3, false);
  EXPECT_GT(gray, one - one / 10);
  EXPECT_LT(gray, one + one / 10);
  EXPECT_LT(2 * gray, bytes_of(AttributeKind::kGeneric, 3, true));
  EXPECT_GT(colorful, 3 * one - one / 3);
  EXPECT_LT(colorful, 3 * one + one / 3);
}

TEST(AttributedStreamTest, SidesOfABoxStayAsTheyAre) {
  const AttributedNormalMesh mesh = BoxOfTwoGroups(2);
  const AttributedStream stream = EncodeAttributedStream(mesh, Options(1e-9, {1e-3, 1.0, 1e-3})).value();
  ASSERT_EQ(stream.bases.size(), 2u);
  const AttributedMesh level = AttributedMeshAtLevel(stream.decoded, 2).value();
  ASSERT_TRUE(CheckAttributedMesh(level).ok());
  EXPECT_EQ(std::count(level.groups.begin(), level.groups.end(), 0u), 8 * 16);
  EXPECT_EQ(std::count(level.groups.begin(), level.groups.end(), 1u), 40 * 16);
  // Both groups share the vertices along their border: the surface is closed, with as many vertices as Euler tells.
  EXPECT_EQ(level.surface.positions.size(), level.surface.triangles.size() / 2 + 2);
  for (size_t f = 0; f < level.surface.triangles.size(); ++f) {
    const Triangle& t = level.surface.triangles[f];
    const auto& p = level.surface.positions;
    const Vec3f flat = Normalized(Cross(p[t[1]] - p[t[0]], p[t[2]] - p[t[0]]));
    EXPECT_EQ(level.attributes[2].corners[f][0] == MeshAttribute::kNoValue, level.groups[f] == 1u);
    for (size_t k = 0; k < 3; ++k) {
      const float* const normal = &level.attributes[1].values[3 * level.attributes[1].corners[f][k]];
      // Sides stay flat up to the error that positions may have; their normals along an axis stay exactly there.
      EXPECT_GT(Dot(flat, Vec3f{normal[0], normal[1], normal[2]}), 0.95f);
      EXPECT_GT(std::max({std::fabs(normal[0]), std::fabs(normal[1]), std::fabs(normal[2])}), 0.9999f);
    }
  }
}

TEST(AttributedStreamTest, StockDecodersShowEveryGroupOfTheBaseWithItsAttributes) {
  const AttributedStream stream = EncodeAttributedStream(BoxOfTwoGroups(1), Options(1e-7, {1e-3, 1.0, 1e-3})).value();
  const StockMesh one = DecodeStockStream(stream.bases[0], {}).value(), rest = DecodeStockStream(stream.bases[1], {}).value();
  EXPECT_EQ(one.bytes_used, stream.bases[0].size());
  EXPECT_EQ(one.mesh->num_attributes(), 4);
  EXPECT_EQ(rest.mesh->num_attributes(), 3);
  EXPECT_EQ(one.mesh->num_faces(), 8u);
  EXPECT_EQ(rest.mesh->num_faces(), 40u);
}

TEST(AttributedStreamTest, EveryPrefixDecodesToItsLastCompleteLevel) {
  const AttributedStream stream = EncodeAttributedStream(WavyCylinder(3), Options(1e-6, {1e-3, 1.0})).value();
  const AttributedBase base = BaseOfHost(stream);
  for (size_t size = 0; size <= stream.refinement.size(); ++size) {
    int level = 0;
    size_t end = 0;
    for (const size_t part : stream.part_sizes) level += size >= (end += part);
    const std::unique_ptr<uint8_t[]> exact(new uint8_t[size]);
    std::copy_n(stream.refinement.begin(), size, exact.get());
    ProgressiveDecoder decoder = ProgressiveDecoder::Create(base, {}).value();
    ASSERT_TRUE(decoder.Append({exact.get(), size}).ok());
    ASSERT_EQ(decoder.level(), level);
    const AttributedMesh mesh = AttributedMeshAtLevel(stream.decoded, level).value();
    for (size_t a = 0; a < 2; ++a) {
      const std::vector<float>& whole = stream.decoded.attributes[a].values;
      const std::vector<float>& part = decoder.attributes()[a].values;
      ASSERT_TRUE(std::equal(part.begin(), part.end(), whole.begin()));
      ASSERT_EQ(decoder.Corners(a), mesh.attributes[a].corners);
    }
  }
}

TEST(AttributedStreamTest, DamageEndsTheRefinementAndKeepsWhatCameBefore) {
  const AttributedStream stream = EncodeAttributedStream(WavyCylinder(2), Options(1e-6, {1e-3, 1.0})).value();
  const AttributedBase base = BaseOfHost(stream);
  size_t num_failures = 0;
  for (size_t i = 0; i < stream.refinement.size(); ++i) {
    Bytes damaged = stream.refinement;
    damaged[i] ^= 0x10;
    ProgressiveDecoder decoder = ProgressiveDecoder::Create(base, {}).value();
    num_failures += !decoder.Append(damaged).ok();
    ASSERT_LT(decoder.level(), 2) << i;
    for (size_t a = 0; a < 2; ++a) {
      const auto corners = decoder.Corners(a);
      for (const Triangle& t : corners) ASSERT_LT(*std::max_element(t.begin(), t.end()), decoder.attributes()[a].num_values());
    }
  }
  EXPECT_GE(num_failures, stream.refinement.size() * 9 / 10);  // the others make a length too long
}

TEST(AttributedStreamTest, RefusesAnotherBase) {
  const AttributedStream stream = EncodeAttributedStream(WavyCylinder(1), Options(1e-6, {1e-3, 1.0})).value();
  const auto message = [&](const AttributedBase& base) {
    ProgressiveDecoder decoder = ProgressiveDecoder::Create(base, {}).value();
    return decoder.Append(stream.refinement).message();
  };
  EXPECT_EQ(message(stream.base), "");
  AttributedBase moved = stream.base;
  moved.attributes[0].values[7] += 1;
  EXPECT_THAT(message(moved), HasSubstr("another base"));
  AttributedBase swapped = stream.base;
  swapped.attributes[0].precision.step *= 2;
  EXPECT_THAT(message(swapped), HasSubstr("attributes of the base"));
  ProgressiveDecoder plain = ProgressiveDecoder::Create(stream.base.mesh, {}).value();
  EXPECT_THAT(plain.Append(stream.refinement).message(), HasSubstr("wants a base with them"));
}

TEST(AttributedStreamTest, LimitsHoldForRowsOfAttributesToo) {
  const AttributedStream stream = EncodeAttributedStream(BoxOfTwoGroups(2), Options(1e-6, {1e-3, 1.0, 1e-3})).value();
  RefinementOptions options;
  const uint64_t vertices = stream.decoded.surface.positions.size(), rows = stream.decoded.attributes[0].num_values();
  ASSERT_LT(vertices, rows);
  for (const uint64_t most : {rows, rows - 1}) {
    options.limits.max_vertices = most;
    ProgressiveDecoder decoder = ProgressiveDecoder::Create(stream.base, options).value();
    EXPECT_EQ(decoder.Append(stream.refinement).code(), most == rows ? StatusCode::kOk : StatusCode::kLimitExceeded);
    EXPECT_EQ(decoder.level(), most == rows ? 2 : 1);
  }
}

TEST(AttributedStreamTest, WrongShapesAreRefusedByName) {
  const AttributedNormalMesh good = WavyCylinder(1);
  const auto message = [](const AttributedNormalMesh& mesh, const AttributedStreamOptions& options) {
    return EncodeAttributedStream(mesh, options).status().message();
  };
  const AttributedStreamOptions options = Options(1e-6, {1e-3, 1.0});
  EXPECT_THAT(message(good, Options(0, {1e-3, 1.0})), HasSubstr("lambda"));
  EXPECT_THAT(message(good, Options(1e-6, {1e-3})), HasSubstr("not as many"));
  EXPECT_THAT(message(good, Options(1e-6, {1e-3, 0.0})), HasSubstr("NORMAL"));
  AttributedNormalMesh bad = good;
  bad.attributes[0].base_corners[3][1] = bad.attributes[0].num_base_values;
  EXPECT_THAT(message(bad, options), HasSubstr("TEXCOORD_0"));
  bad = good;
  bad.attributes[1].values[4] = NAN;
  EXPECT_THAT(message(bad, options), HasSubstr("not finite"));
  bad = good;
  bad.attributes[0].values.resize(bad.attributes[0].values.size() - 2);
  EXPECT_THAT(message(bad, options), HasSubstr("values of all levels"));
  bad = good;
  bad.base_groups.assign(bad.surface.mesh.base_triangles.size(), 0);
  bad.base_groups[0] = 2;
  EXPECT_THAT(message(bad, options), HasSubstr("group 1"));
}

}  // namespace
}  // namespace lacerta
