#include "draco/parallelogram_prices.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <random>
#include <utility>
#include <vector>

#include "draco/parallelogram_choice.h"
#include "draco/position_stream.h"
#include "lacerta/mesh.h"
#include "shapes/shapes.h"

namespace lacerta {
namespace {

constexpr double kAll = std::numeric_limits<double>::infinity();

struct Case {
  TriangleMesh mesh;
  PositionStream stream;
  std::vector<LatticePoint> points;
};

Case CaseOf(const TriangleMesh& mesh, int32_t scale) {
  const StockAttempt attempt = {{StockSettings::Connectivity::kEdgebreakerValence, StockSettings::Prediction::kParallelogram, 0}, 0, 0, {}};
  Case result = {mesh, PositionStream::Create(mesh.triangles, mesh.positions.size(), attempt).value(), {}};
  std::mt19937 random(3);
  for (const Vec3f& p : mesh.positions) {
    LatticePoint point;
    for (int k = 0; k < 3; ++k) point[static_cast<size_t>(k)] = static_cast<int32_t>(std::lround((p[k] + 4) * static_cast<float>(scale))) + static_cast<int32_t>(random() % 5);
    result.points.push_back(point);
  }
  return result;
}

// Of all values, each predicted by what is best with these costs.
double LeastBits(const PredictableValues& values, const ParallelogramChoice& choice, const SymbolCosts& costs) {
  const ParallelogramPredictor predictor(values);
  double sum = 0;
  for (size_t n = 0; n < values.size(); ++n) {
    const uint32_t offers = values.num_parallelograms(n);
    double least = kAll;
    for (uint32_t used = 0; used < 1u << offers; ++used) {
      if (choice.prediction == ParallelogramChoice::Prediction::kParallelogram && used != values.has_usual[n]) continue;
      std::array<uint32_t, 3> symbols;
      predictor.Symbols(n, used, symbols.data());
      least = std::min(least, costs.Of(symbols.data(), NumUsed(used), offers));
    }
    sum += least;
  }
  return sum;
}

// What moving a vertex changes is what it changes in all.
TEST(ParallelogramPrices, TellWhatAMoveChanges) {
  for (const auto& [mesh, scale] : {std::pair<TriangleMesh, int32_t>{shapes::Torus(16, 12), 100}, {shapes::Torus(16, 12), 4}, {shapes::Icosphere(1), 30}, {shapes::Pinched(), 50},
                                    {shapes::GridWithBorder(6, 5, 0.2f), 40}}) {
    const Case c = CaseOf(mesh, scale);
    const PredictableValues values = c.stream.ValuesAt(c.points);
    const ParallelogramChoice choice = CodeByParallelograms(values).choice;
    const ParallelogramPredictor predictor(values);
    const SymbolCosts costs(predictor, choice);
    ParallelogramPrices prices(c.stream, c.points.size());
    prices.Begin(c.points);
    std::vector<LatticePoint> points = c.points;
    std::mt19937 random(5);
    int num_moved = 0;
    for (int i = 0; i < 60; ++i) {
      const auto v = static_cast<uint32_t>(random() % points.size());
      LatticePoint to = points[v];
      for (int32_t& x : to) x += static_cast<int32_t>(random() % 7) - 3;
      // Corrections are modulo the range of all values, which stays.
      const auto is_inside = [&](int32_t x) { return predictor.wrap().low() < x && x < predictor.wrap().high(); };
      if (!std::all_of(to.begin(), to.end(), is_inside) || !std::all_of(points[v].begin(), points[v].end(), is_inside)) continue;
      ++num_moved;
      prices.LookAround(v);
      const double bits = prices.Bits(to, kAll), change = bits - prices.Bits(points[v], kAll);
      EXPECT_LE(prices.Bits(to, bits / 2), bits);
      EXPECT_GE(prices.Bits(to, bits / 2), bits / 2);
      const double before = LeastBits(c.stream.ValuesAt(points), choice, costs);
      points[v] = to;
      EXPECT_NEAR(LeastBits(c.stream.ValuesAt(points), choice, costs) - before, change, 1e-6);
      prices.Move(v, to);
    }
    EXPECT_GT(num_moved, 10);
  }
}

// The errors of the predictions are the corrections of the values, but for rounding.
TEST(ParallelogramPrices, PredictionsAreThoseOfTheStream) {
  const Case c = CaseOf(shapes::Torus(16, 12), 100);
  ParallelogramPrices prices(c.stream, c.points.size());
  prices.Begin(c.points);
  const LinearPredictions predictions = prices.Predictions();
  const PredictableValues values = c.stream.ValuesAt(c.points);
  const ParallelogramChoice choice = CodeByParallelograms(values).choice;
  const ParallelogramPredictor predictor(values);
  ASSERT_EQ(predictions.size(), values.size() - 1);
  for (size_t i = 0; i < predictions.size(); ++i) {
    std::array<double, 3> error{};
    for (const auto& [v, factor] : predictions[i]) {
      for (size_t k = 0; k < 3; ++k) error[k] += static_cast<double>(factor) * c.points[v][k];
    }
    std::array<uint32_t, 3> symbols;
    predictor.Symbols(i + 1, choice.used[i + 1], symbols.data());
    for (size_t k = 0; k < 3; ++k) {
      const double correction = symbols[k] % 2 == 0 ? symbols[k] / 2 : -1.0 * ((symbols[k] + 1) / 2);
      const double value = values.values[3 * (i + 1) + k], predicted = value - error[k];
      EXPECT_NEAR(value - std::clamp(predicted, 1.0 * predictor.wrap().low(), 1.0 * predictor.wrap().high()), correction, 1.0);
    }
  }
}

}  // namespace
}  // namespace lacerta
