#include "geometry/close_seams.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "shapes/attributed_shapes.h"

namespace lacerta {
namespace {

std::vector<uint32_t> NumbersOfValues(const AttributedMesh& mesh) {
  std::vector<uint32_t> numbers;
  for (const MeshAttribute& attribute : mesh.attributes) numbers.push_back(attribute.num_values());
  return numbers;
}

// The vertices and values of a cylinder, whose seam is one in the texture only.
struct Cylinder {
  VertexSoup soup = shapes::Cylinder(24, 6);
  AttributedMesh mesh = WeldSoups({soup}).value();
};

TEST(CloseSeamsTest, NoiseIsNoSeam) {
  const Cylinder cylinder;
  AttributedMesh noisy = WeldSoups({shapes::Unwelded(cylinder.soup, 1e-6f)}).value();
  const AttributedMesh before = noisy;
  ASSERT_GT(noisy.attributes[0].num_values(), 4 * cylinder.mesh.attributes[0].num_values());
  CloseSeams(std::vector<double>(noisy.attributes.size(), 1e-3), 1.0, &noisy);
  ASSERT_TRUE(CheckAttributedMesh(noisy).ok()) << CheckAttributedMesh(noisy).message();
  EXPECT_EQ(noisy.surface.triangles, before.surface.triangles);
  for (size_t a = 0; a < noisy.attributes.size(); ++a) {
    // As many as there are vertices, and once more along the seam of the texture.
    const uint32_t most = static_cast<uint32_t>(cylinder.soup.positions.size());
    EXPECT_LE(noisy.attributes[a].num_values(), most) << noisy.attributes[a].name;
    EXPECT_GE(noisy.attributes[a].num_values(), noisy.surface.positions.size()) << noisy.attributes[a].name;
    for (size_t f = 0; f < noisy.surface.triangles.size(); ++f) {
      for (size_t k = 0; k < 3; ++k) {
        for (uint32_t c = 0; c < noisy.attributes[a].components; ++c) {
          const auto at = [&](const AttributedMesh& mesh) {
            return mesh.attributes[a].values[mesh.attributes[a].corners[f][k] * mesh.attributes[a].components + c];
          };
          EXPECT_NEAR(at(noisy), at(before), 4e-6);
        }
      }
    }
  }
}

TEST(CloseSeamsTest, SeamsOverTheToleranceStay) {
  Cylinder cylinder;
  const std::vector<uint32_t> before = NumbersOfValues(cylinder.mesh);
  CloseSeams(std::vector<double>(cylinder.mesh.attributes.size(), 1e-3), 1.0, &cylinder.mesh);
  EXPECT_EQ(NumbersOfValues(cylinder.mesh), before);
}

// A fan about one vertex whose corners there hold these values.
AttributedMesh Fan(AttributeKind kind, uint32_t components, const std::vector<float>& values) {
  AttributedMesh mesh;
  const auto count = static_cast<uint32_t>(values.size()) / components;
  mesh.surface.positions = {{0, 0, 0}};
  mesh.attributes = {{"_X", kind, components, values, {}}};
  for (uint32_t i = 0; i < count; ++i) {
    const float x = std::cos(static_cast<float>(i)), y = std::sin(static_cast<float>(i));
    mesh.surface.positions.push_back({x, y, 0});
    mesh.surface.triangles.push_back({0, i + 1, (i + 1) % count + 1});
    mesh.attributes[0].corners.push_back({i, 0, 0});
  }
  return mesh;
}

std::vector<float> CenterValues(const AttributedMesh& mesh) {
  std::vector<float> result;
  for (const Triangle& t : mesh.attributes[0].corners) result.push_back(mesh.attributes[0].values[t[0] * mesh.attributes[0].components]);
  return result;
}

TEST(CloseSeamsTest, ValuesDoNotWanderAlongAChain) {
  AttributedMesh fan = Fan(AttributeKind::kGeneric, 1, {0.0f, 0.75f, 1.5f, 2.25f, 3.0f, 0.5f});
  CloseSeams({1.0}, 1.0, &fan);
  EXPECT_EQ(CenterValues(fan), (std::vector<float>{0.0f, 0.0f, 1.5f, 1.5f, 3.0f, 0.0f}));
}

TEST(CloseSeamsTest, TexelsAndDegrees) {
  AttributedMesh texture = Fan(AttributeKind::kTextureCoordinates, 2, {0.0f, 0.0f, 0.0009f, 0.0f, 0.0011f, 0.0f});
  CloseSeams({1.0}, 1000.0, &texture);
  EXPECT_EQ(CenterValues(texture), (std::vector<float>{0.0f, 0.0f, 0.0011f}));
  const float in = 0.9f * 3.14159265f / 180, out = 1.1f * 3.14159265f / 180;
  AttributedMesh normals = Fan(AttributeKind::kNormal, 3, {0, 0, 1, std::sin(in), 0, std::cos(in), std::sin(out), 0, std::cos(out)});
  CloseSeams({1.0}, 1000.0, &normals);
  EXPECT_EQ(CenterValues(normals), (std::vector<float>{0.0f, 0.0f, std::sin(out)}));
  AttributedMesh tangents = Fan(AttributeKind::kTangent, 4, {0, 0, 1, 1, 0, 0, 1, -1, 0, 0, 1, 1});
  CloseSeams({1.0}, 1000.0, &tangents);
  EXPECT_EQ(tangents.attributes[0].num_values(), 2u);  // the other hand is no noise
}

TEST(CloseSeamsTest, ToleranceZeroClosesNothing) {
  AttributedMesh fan = Fan(AttributeKind::kGeneric, 1, {0.0f, 1e-7f, 2e-7f});
  CloseSeams({0.0}, 1.0, &fan);
  EXPECT_EQ(CenterValues(fan), (std::vector<float>{0.0f, 1e-7f, 2e-7f}));
}

TEST(CloseSeamsTest, WideFansTakeNoLongerThanTheyMust) {
  std::vector<float> values(200'000);
  for (size_t i = 0; i < values.size(); ++i) values[i] = static_cast<float>(i);
  AttributedMesh fan = Fan(AttributeKind::kGeneric, 1, values);
  CloseSeams({0.25}, 1.0, &fan);  // would be quadratic
  EXPECT_EQ(CenterValues(fan), values);
}

}  // namespace
}  // namespace lacerta
