#include "pack/slide_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "gltf/test_assets.h"

namespace lacerta {
namespace {

double Texels(size_t, uint64_t) { return 1024.0; }

// A square of cells in the plane, whose texture coordinates are what `texture` says.
template <typename Texture>
Primitive Square(uint32_t cells, const Texture& texture) {
  Primitive primitive;
  std::vector<Vec3f> positions;
  std::vector<float> values;
  for (uint32_t y = 0; y <= cells; ++y) {
    for (uint32_t x = 0; x <= cells; ++x) {
      positions.push_back({static_cast<float>(x), static_cast<float>(y), 0.0f});
      const auto [u, v] = texture(static_cast<double>(x), static_cast<double>(y));
      values.insert(values.end(), {static_cast<float>(u), static_cast<float>(v)});
    }
  }
  for (uint32_t y = 0; y < cells; ++y) {
    for (uint32_t x = 0; x < cells; ++x) {
      const uint32_t a = y * (cells + 1) + x, b = a + cells + 1;
      primitive.triangles.insert(primitive.triangles.end(), {{a, a + 1, b}, {a + 1, b + 1, b}});
    }
  }
  primitive.num_vertices = positions.size();
  primitive.attributes = {{"POSITION", MakeFloatAccessor(positions)}, {"TEXCOORD_0", MakeFloatAccessor(values, 2)}};
  return primitive;
}

std::vector<Vec3f> Shaken(const Primitive& primitive) {
  std::vector<Vec3f> moved = VectorsOf(primitive.attributes[0].data);
  for (size_t v = 0; v < moved.size(); ++v) {
    moved[v].x += 0.3f * std::sin(3.0f * static_cast<float>(v));
    moved[v].y += 0.3f * std::sin(5.0f * static_cast<float>(v));
    moved[v].z += 0.3f;  // off the surface, which is no slide
  }
  return moved;
}

struct Fitted {
  std::vector<std::vector<Vec3f>> moved;
  SlideFit fit;
  double rms = 0.0;
};

Fitted Fit(const std::vector<const Primitive*>& primitives, std::vector<std::vector<Vec3f>> moved) {
  const std::vector<RoundedAttribute> attributes = RoundedAttributesOf(primitives, {}, Texels);
  std::vector<TriangleMesh> surfaces;
  for (const Primitive* primitive : primitives) surfaces.push_back(Surface(*primitive));
  Fitted result{std::move(moved), {}, 0.0};
  result.fit = FitToSlides(primitives, surfaces, attributes[0], result.moved);
  double squares = 0.0, areas = 0.0;
  for (const auto& [square, area] : result.fit.squares) squares += square * area, areas += area;
  result.rms = std::sqrt(squares / areas);
  return result;
}

// A texture that is linear over the surface is where it was, whatever slides.
TEST(SlideFit, LinearValuesAreExact) {
  const auto linear = [](double x, double y) { return std::array<double, 2>{0.1 + 0.03 * x - 0.01 * y, 0.2 + 0.02 * x + 0.04 * y}; };
  const Primitive square = Square(12, linear);
  const Fitted fitted = Fit({&square}, {Shaken(square)});
  EXPECT_LT(fitted.rms, 1e-4);
  for (size_t v = 0; v < square.num_vertices; ++v) {
    const Vec3f& at = fitted.moved[0][v];
    EXPECT_NEAR(fitted.fit.values[0].Float(v, 0), linear(at.x, at.y)[0], 2e-4);
    EXPECT_NEAR(fitted.fit.values[0].Float(v, 1), linear(at.x, at.y)[1], 2e-4);
  }
  // What does not slide stays bit by bit.
  const Fitted still = Fit({&square}, {VectorsOf(square.attributes[0].data)});
  EXPECT_TRUE(still.fit.values[0].bytes == square.attributes[1].data.bytes);
  EXPECT_EQ(still.rms, 0.0);
}

// Of a bent texture something is left, less than without the fit.
TEST(SlideFit, BentValuesAreLeastSquares) {
  const Primitive square = Square(12, [](double x, double y) { return std::array<double, 2>{0.5 + 0.2 * std::sin(x), 0.5 + 0.2 * std::sin(y + 0.5 * x)}; });
  const std::vector<Vec3f> moved = Shaken(square);
  const Fitted fitted = Fit({&square}, {moved});
  EXPECT_GT(fitted.rms, 0.002);
  EXPECT_LT(fitted.rms, 0.03);  // 0.3 of a cell over which it changes by up to 0.2
  // Any other values are worse: the errors are those of the fit and the change, in squares, so that halfway back is farther off.
  double back = 0.0;
  for (uint64_t v = 0; v < square.num_vertices; ++v) back = std::max(back, std::fabs(static_cast<double>(fitted.fit.values[0].Float(v, 0)) - square.attributes[1].data.Float(v, 0)));
  EXPECT_GT(back, 0.03);
  EXPECT_LT(back, 0.2);
}

// Primitives that have a vertex with its value in common have it afterwards, and a seam stays one.
TEST(SlideFit, PrimitivesThatTouchStayTogether) {
  const auto bent = [](double x, double y) { return std::array<double, 2>{0.5 + 0.2 * std::sin(x), 0.5 + 0.2 * std::sin(y + 0.5 * x)}; };
  const Primitive whole = Square(12, bent);
  Primitive left = whole, right = whole;
  left.triangles.resize(whole.triangles.size() / 2);
  right.triangles.erase(right.triangles.begin(), right.triangles.begin() + static_cast<std::ptrdiff_t>(left.triangles.size()));
  const std::vector<Vec3f> moved = Shaken(whole);
  const Fitted apart = Fit({&left, &right}, {moved, moved}), together = Fit({&whole}, {moved});
  for (uint64_t v = 0; v < whole.num_vertices; ++v) {
    EXPECT_EQ(apart.fit.values[0].Float(v, 0), apart.fit.values[1].Float(v, 0));
    EXPECT_NEAR(apart.fit.values[0].Float(v, 0), together.fit.values[0].Float(v, 0), 1e-3);
  }
  EXPECT_NEAR(apart.rms, together.rms, 1e-3 * together.rms);
}

}  // namespace
}  // namespace lacerta
