#include "pack/value_descent.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "document/draco_encode.h"
#include "gltf/test_assets.h"
#include "pack/descents_within.h"
#include "pack/rounding_forecast.h"

namespace lacerta {
namespace {

constexpr int kPositionLevel = 11 * kLevelsPerBit;

double Texels(size_t, uint64_t) { return 1024.0; }

// Gentle hills with normals that are not quite those of their triangles, a texture, tangents and colors.
Primitive Hills() {
  constexpr uint32_t kSide = 40;
  Primitive primitive;
  std::vector<Vec3f> positions, normals;
  std::vector<float> texture, tangents, colors;
  for (uint32_t j = 0; j <= kSide; ++j) {
    for (uint32_t i = 0; i <= kSide; ++i) {
      const double shift = 0.3 * std::sin(5.0 * i + 3.0 * j), x = (i + shift) / kSide, y = (j - shift) / kSide;
      positions.push_back(Vec3Cast<float>(Vec3d{x, y, 0.1 * std::sin(5 * x) * std::cos(4 * y)}));
      const Vec3d normal = Normalized(Vec3d{-0.5 * std::cos(5 * x) * std::cos(4 * y) + 0.03 * std::sin(90 * y), 0.4 * std::sin(5 * x) * std::sin(4 * y) + 0.03 * std::sin(70 * x), 1.0});
      const Vec3d tangent = Normalized(Cross(Vec3d{0.1 * std::sin(9 * x), 1.0, 0.1}, normal));
      normals.push_back(Vec3Cast<float>(normal));
      tangents.insert(tangents.end(), {static_cast<float>(tangent.x), static_cast<float>(tangent.y), static_cast<float>(tangent.z), x < 0.5 ? -1.0f : 1.0f});
      texture.insert(texture.end(), {static_cast<float>(0.1 + 0.8 * x + 0.004 * std::sin(31 * y)), static_cast<float>(0.1 + 0.8 * y + 0.004 * std::sin(37 * x))});
      colors.insert(colors.end(), {static_cast<float>(0.5 + 0.3 * std::sin(6 * x)), static_cast<float>(0.5 + 0.02 * std::sin(60 * x + 50 * y)), 0.5f, 1.0f});
    }
  }
  for (uint32_t j = 0; j < kSide; ++j) {
    for (uint32_t i = 0; i < kSide; ++i) {
      const uint32_t a = j * (kSide + 1) + i, b = a + kSide + 1;
      primitive.triangles.insert(primitive.triangles.end(), {{a, a + 1, b + 1}, {a, b + 1, b}});
    }
  }
  primitive.num_vertices = positions.size();
  primitive.attributes = {{"POSITION", MakeFloatAccessor(positions)}, {"NORMAL", MakeFloatAccessor(normals)}, {"TANGENT", MakeFloatAccessor(tangents, 4)},
                          {"TEXCOORD_0", MakeFloatAccessor(texture, 2)}, {"COLOR_0", MakeFloatAccessor(colors, 4)}};
  return primitive;
}

struct Setting {
  explicit Setting(std::vector<const Primitive*> of) : primitives(std::move(of)), attributes(RoundedAttributesOf(primitives, {}, Texels, {{"COLOR_0", 0.005}})), forecast(primitives, attributes) {}

  std::vector<AccessorData> Values(size_t a) const {
    std::vector<AccessorData> values;
    for (const RoundedAttribute::Part& part : attributes[a].parts) values.push_back(primitives[part.member]->attributes[part.index].data);
    return values;
  }

  // Of the attribute in the first primitive.
  size_t Bytes(size_t a, int level, const AccessorData& values) {
    const RoundedAttribute::Part& part = attributes[a].parts[0];
    const Attribute& attribute = primitives[0]->attributes[part.index];
    Primitive primitive = *primitives[0];
    primitive.attributes = {primitive.attributes[0], attribute};
    DracoPrecision precision{forecast.Positions(kPositionLevel).lattice, {}, level / kLevelsPerBit};
    if (!attributes[a].octahedral) precision.lattices[attribute.name] = attributes[a].LatticeAt(part, level);
    precision.values["POSITION"] = MakeFloatAccessor(forecast.Positions(kPositionLevel).moved[0]);
    precision.values[attribute.name] = values;
    const size_t all = EncodeDracoPrimitive(primitive, precision).value().bytes.size();
    primitive.attributes.pop_back();
    return all - EncodeDracoPrimitive(primitive, precision).value().bytes.size();
  }

  const std::vector<const Primitive*> primitives;
  const std::vector<RoundedAttribute> attributes;
  RoundingForecast forecast;
};

int LevelFor(const RoundedAttribute& attribute) { return attribute.octahedral ? 6 * kLevelsPerBit : attribute.direction ? 5 * kLevelsPerBit : 8 * kLevelsPerBit; }

// The steeper the slope the fewer bytes and the larger the error; no single value beyond what is allowed; all values on the lattice.
TEST(ValueDescent, SlopesTradeErrorForBytes) {
  const Primitive hills = Hills();
  Setting setting({&hills});
  ASSERT_EQ(setting.attributes.size(), 4u);
  for (size_t a = 0; a < setting.attributes.size(); ++a) {
    const RoundedAttribute& attribute = setting.attributes[a];
    SCOPED_TRACE(attribute.name);
    const int level = LevelFor(attribute);
    const std::vector<AccessorData> wanted = setting.Values(a);
    const AccessorData nearest = attribute.RoundedAt(wanted[0], attribute.parts[0], level);
    const double most = 4.0 * attribute.target;
    const ValueDescent descent(setting.primitives, setting.forecast.Positions(kPositionLevel).moved, attribute, wanted, level, most);
    const double flat = attribute.target * attribute.target / static_cast<double>(descent.num_values());
    std::vector<double> errors = {setting.forecast.Rounded(a, wanted, {nearest})};
    std::vector<size_t> bytes = {setting.Bytes(a, level, nearest)};
    for (const double slope : {0.0, 0.3 * flat, 3.0 * flat}) {
      const std::vector<AccessorData> values = descent.At(slope);
      ASSERT_EQ(values.size(), 1u);
      errors.push_back(setting.forecast.Rounded(a, wanted, values));
      bytes.push_back(setting.Bytes(a, level, values[0]));
      const AccessorData again = attribute.RoundedAt(values[0], attribute.parts[0], level);
      EXPECT_TRUE(again.bytes == values[0].bytes) << "not on the lattice";
      for (uint64_t v = 0; v < values[0].count; ++v) {
        double square = 0.0, nearest_square = 0.0;
        const uint32_t components = attribute.direction ? 3 : values[0].components;
        Vec3d directions[3];
        for (uint32_t c = 0; c < components; ++c) {
          square += std::pow(values[0].Float(v, c) - wanted[0].Float(v, c), 2.0);
          nearest_square += std::pow(nearest.Float(v, c) - wanted[0].Float(v, c), 2.0);
          if (c < 3) directions[0][static_cast<int>(c)] = values[0].Float(v, c), directions[1][static_cast<int>(c)] = wanted[0].Float(v, c), directions[2][static_cast<int>(c)] = nearest.Float(v, c);
        }
        double error = std::sqrt(square) * attribute.scale, other = std::sqrt(nearest_square) * attribute.scale;
        if (attribute.direction) {
          error = 57.2958 * Norm(Normalized(directions[0]) - directions[1]);
          other = 57.2958 * Norm(Normalized(directions[2]) - directions[1]);
        }
        ASSERT_LE(error, 1.001 * std::max(most, other)) << v;
      }
    }
    EXPECT_LT(errors[1], 0.99 * errors[0]) << "neighbors' errors cancel out";
    EXPECT_GT(errors[1], 0.5 * errors[0]);
    EXPECT_LT(errors[1], errors[2]);
    EXPECT_LT(errors[2], errors[3]);
    EXPECT_LT(bytes[3], bytes[2]);
    EXPECT_LT(static_cast<double>(bytes[3]), 0.97 * static_cast<double>(bytes[0]));
  }
}

// Where two primitives touch, both have the same normals and colors, at the points next to them.
TEST(ValueDescent, WhatPrimitivesHaveInCommonStaysSo) {
  const Primitive whole = Hills();
  Primitive front = whole, back = whole;
  front.triangles.clear();
  back.triangles.clear();
  for (const Triangle& t : whole.triangles) {
    const bool is_front = whole.attributes[0].data.Float(t[0], 0) > 0.5f;
    (is_front ? front : back).triangles.push_back(t);
  }
  std::vector<char> in_front(whole.num_vertices), in_back(whole.num_vertices);
  for (const Triangle& t : front.triangles) in_front[t[0]] = in_front[t[1]] = in_front[t[2]] = 1;
  for (const Triangle& t : back.triangles) in_back[t[0]] = in_back[t[1]] = in_back[t[2]] = 1;
  const auto only = [](const Primitive& primitive, const std::vector<char>& used) {
    Primitive result;
    std::vector<uint32_t> numbers(used.size());
    std::vector<Vec3f> positions, normals;
    for (uint32_t v = 0; v < used.size(); ++v) {
      if (used[v] == 0) continue;
      numbers[v] = static_cast<uint32_t>(positions.size());
      positions.push_back(VectorAt(primitive.attributes[0].data, v));
      normals.push_back(VectorAt(primitive.attributes[1].data, v));
    }
    for (const Triangle& t : primitive.triangles) result.triangles.push_back({numbers[t[0]], numbers[t[1]], numbers[t[2]]});
    result.num_vertices = positions.size();
    result.attributes = {{"POSITION", MakeFloatAccessor(positions)}, {"NORMAL", MakeFloatAccessor(normals)}};
    return result;
  };
  const Primitive a = only(front, in_front), b = only(back, in_back);
  Setting setting({&a, &b});
  const RoundedAttribute& attribute = setting.attributes[0];
  const int level = 6 * kLevelsPerBit;
  const std::vector<AccessorData> wanted = setting.Values(0);
  const ValueDescent descent(setting.primitives, setting.forecast.Positions(kPositionLevel).moved, attribute, wanted, level, 8.0);
  const std::vector<AccessorData> values = descent.At(1.0);
  size_t num_common = 0, num_moved = 0, in_a = 0, in_b = 0;
  const AccessorData nearest = attribute.RoundedAt(wanted[0], attribute.parts[0], level);
  for (uint32_t v = 0; v < whole.num_vertices; ++v) {
    if (in_front[v] != 0 && in_back[v] != 0) {
      ++num_common;
      EXPECT_EQ(VectorAt(values[0], in_a), VectorAt(values[1], in_b));
      EXPECT_EQ(VectorAt(values[0], in_a), VectorAt(nearest, in_a));
    } else if (in_front[v] != 0) {
      num_moved += VectorAt(values[0], in_a) == VectorAt(nearest, in_a) ? 0 : 1;
    }
    in_a += in_front[v] != 0 ? 1 : 0;
    in_b += in_back[v] != 0 ? 1 : 0;
  }
  EXPECT_GT(num_common, 40u);
  EXPECT_GT(num_moved, 200u);
}

// Normals that lie nearly in the plane of a triangle do not turn from it, although that would take fewer bits.
TEST(ValueDescent, NormalsDoNotTurnFromTriangles) {
  Primitive strip = Hills();
  std::vector<Vec3f> normals;
  for (uint64_t v = 0; v < strip.num_vertices; ++v) {  // 88 degrees from where the triangles look
    const Vec3d out = Normalized(Vec3Cast<double>(VectorAt(strip.attributes[0].data, v)));
    normals.push_back(Vec3Cast<float>(Normalized(Normalized(Cross(out, Vec3d{0.1, 0.2, 1.0})) + out * 0.035)));
  }
  strip.attributes = {strip.attributes[0], {"NORMAL", MakeFloatAccessor(normals)}};
  Setting setting({&strip});
  const int level = 5 * kLevelsPerBit;
  const std::vector<std::vector<Vec3f>>& positions = setting.forecast.Positions(kPositionLevel).moved;
  const auto num_turned = [&](const AccessorData& values) {
    size_t sum = 0;
    for (const Triangle& t : strip.triangles) {
      const Vec3f area = Cross(positions[0][t[1]] - positions[0][t[0]], positions[0][t[2]] - positions[0][t[0]]);
      sum += Dot(area, VectorAt(values, t[0]) + VectorAt(values, t[1]) + VectorAt(values, t[2])) < 0.0f ? 1 : 0;
    }
    return sum;
  };
  const std::vector<AccessorData> wanted = setting.Values(0);
  const ValueDescent descent(setting.primitives, positions, setting.attributes[0], wanted, level, 8.0);
  const size_t before = num_turned(setting.attributes[0].RoundedAt(wanted[0], setting.attributes[0].parts[0], level));
  EXPECT_GT(before, 50u);
  EXPECT_LE(num_turned(descent.At(10.0)[0]), before);
}

TEST(DescentsWithin, StayWithinTheErrorAndUseIt) {
  const Primitive hills = Hills();
  Setting setting({&hills});
  for (size_t a = 0; a < setting.attributes.size(); ++a) {
    const RoundedAttribute& attribute = setting.attributes[a];
    SCOPED_TRACE(attribute.name);
    const int level = LevelFor(attribute);
    const std::vector<AccessorData> wanted = setting.Values(a);
    const auto error_of = [&](const std::vector<AccessorData>& values) { return setting.forecast.Rounded(a, wanted, values); };
    const double allowed = setting.forecast.Rounded(a, level);
    const auto descents = DescentsWithin(setting.primitives, setting.forecast.Positions(kPositionLevel).moved, attribute, wanted, level, allowed, error_of);
    ASSERT_FALSE(descents.empty());
    size_t least = setting.Bytes(a, level, attribute.RoundedAt(wanted[0], attribute.parts[0], level));
    const size_t before = least;
    for (const DescendedValues& descent : descents) {
      EXPECT_EQ(descent.error, error_of(descent.values));
      EXPECT_LE(descent.error, allowed);
      EXPECT_GT(descent.error, 0.7 * allowed);
      least = std::min(least, setting.Bytes(a, descent.level, descent.values[0]));
    }
    EXPECT_LT(static_cast<double>(least), 0.995 * static_cast<double>(before));
    EXPECT_TRUE(DescentsWithin(setting.primitives, setting.forecast.Positions(kPositionLevel).moved, attribute, wanted, level, 0.01 * allowed, error_of).empty());
  }
}

}  // namespace
}  // namespace lacerta
