#include "draco/merge_values.h"

#include <draco/attributes/point_attribute.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <ctime>
#include <random>
#include <vector>

namespace lacerta {
namespace {

template <typename T>
void AddAttribute(draco::DataType type, int components, const std::vector<T>& values, draco::Mesh* mesh) {
  draco::GeometryAttribute description;
  const auto size = static_cast<int64_t>(sizeof(T)) * components;
  description.Init(draco::GeometryAttribute::GENERIC, nullptr, static_cast<int8_t>(components), type, false, size, 0);
  const int id = mesh->AddAttribute(description, /*identity_mapping=*/true, mesh->num_points());
  mesh->attribute(id)->buffer()->Write(0, values.data(), values.size() * sizeof(T));
}

// So few values that many are equal, of three types, and one attribute without any two equal.
void FillWithEqualValues(draco::Mesh* mesh) {
  constexpr uint32_t kPoints = 500;
  std::mt19937 random(5);
  mesh->set_num_points(kPoints);
  std::vector<float> positions(3 * kPoints), numbers;
  std::vector<uint8_t> colors(3 * kPoints);
  std::vector<uint16_t> joints(4 * kPoints);
  for (float& p : positions) p = random() % 2 == 0 ? -0.0f : static_cast<float>(random() % 4);
  for (uint8_t& c : colors) c = static_cast<uint8_t>(random() % 5);
  for (uint16_t& j : joints) j = static_cast<uint16_t>(random() % 3 * 1000);
  for (uint32_t i = 0; i < kPoints; ++i) numbers.push_back(static_cast<float>(i));
  AddAttribute(draco::DT_FLOAT32, 3, positions, mesh);
  AddAttribute(draco::DT_UINT8, 3, colors, mesh);
  AddAttribute(draco::DT_UINT16, 4, joints, mesh);
  AddAttribute(draco::DT_FLOAT32, 1, numbers, mesh);
}

TEST(MergeValuesTest, DoesWhatDracoDoes) {
  draco::Mesh merged, expected;
  FillWithEqualValues(&merged);
  FillWithEqualValues(&expected);
  MergeEqualValues(&merged);
  ASSERT_TRUE(expected.DeduplicateAttributeValues());
  for (int id = 0; id < expected.num_attributes(); ++id) {
    const draco::PointAttribute &a = *merged.attribute(id), &b = *expected.attribute(id);
    ASSERT_EQ(a.size(), b.size()) << id;
    EXPECT_EQ(a.size() == merged.num_points(), id == 3);
    EXPECT_EQ(a.is_mapping_identity(), b.is_mapping_identity());
    for (draco::PointIndex p(0); p < merged.num_points(); ++p) ASSERT_EQ(a.mapped_index(p), b.mapped_index(p)) << id;
    for (draco::AttributeValueIndex i(0); i < static_cast<uint32_t>(a.size()); ++i) {
      const auto size = static_cast<size_t>(a.byte_stride());
      ASSERT_EQ(std::vector<uint8_t>(a.GetAddress(i), a.GetAddress(i) + size), std::vector<uint8_t>(b.GetAddress(i), b.GetAddress(i) + size)) << id;
    }
  }
}

// Points of a lattice as floats of one exponent, whose bits have the same exclusive or: one bucket of Draco's table, 10^11 comparisons.
TEST(MergeValuesTest, TakesNoLongerForPointsOfALattice) {
  constexpr uint32_t kSide = 700;
  draco::Mesh mesh;
  mesh.set_num_points(kSide * kSide);
  std::vector<float> positions;
  for (uint32_t y = 0; y < kSide; ++y) {
    for (uint32_t x = 0; x < kSide; ++x) {
      for (const uint32_t number : {x, y, x ^ y}) positions.push_back(static_cast<float>(1024 + number));
    }
  }
  AddAttribute(draco::DT_FLOAT32, 3, positions, &mesh);
  const std::clock_t begin = std::clock();
  MergeEqualValues(&mesh);
  EXPECT_LT(static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC, 5.0);
  EXPECT_EQ(mesh.attribute(0)->size(), kSide * kSide);
}

}  // namespace
}  // namespace lacerta
