// Coding of the lattice points of a base mesh whose connectivity both sides know: one piece of code for encoder and decoder.
// Specified in docs/format.md, "Positions of the compact base".
//
// A point is coded as its difference from where it is expected (common/position_prediction.h). Differences are taken as normally
// distributed with one spread along the surface and another across it, both told by the vertices around; each coordinate is coded
// given those before it, so that the last one, across which the surface lies flattest, mostly follows from the others.
#ifndef LACERTA_COMMON_POSITION_CODING_H_
#define LACERTA_COMMON_POSITION_CODING_H_

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "common/integer_math.h"
#include "common/position_prediction.h"
#include "common/symbol_coding.h"
#include "common/stream_layout.h"
#include "lacerta/status.h"

namespace lacerta {

// Mean magnitudes of a difference, in 1/16 of the lattice: of one coordinate along the surface, and across it.
struct Spread {
  int64_t along = 0, across = 0;
};

// How the three coordinates of a difference depend on each other: the order in which they are coded, and for each the share of
// those before it that is expected in it, and its mean magnitude.
struct CoordinateOrder {
  std::array<size_t, 3> order{0, 1, 2};
  std::array<int64_t, 3> scale{};                    // 1/16 of the lattice
  std::array<std::array<int64_t, 2>, 3> share{};     // times 2^12, of the first and second one coded
};
CoordinateOrder OrderCoordinates(const LatticeVector& normal, const Spread& spread);

// Mean magnitudes seen so far, for each vertex and altogether.
class SpreadMemory {
 public:
  SpreadMemory(const PositionPredictor& predictor, uint32_t num_vertices, int extent_bits);
  Spread Expect(uint32_t vertex, const Expectation& expectation) const;
  void Add(uint32_t vertex, const Expectation& expectation, const LatticeVector& difference);

 private:
  struct Mean {
    int64_t along = 0, across = 0, count = 0;
  };
  const PositionPredictor& predictor_;
  std::array<Mean, 3> overall_;  // by foresight
  std::vector<Spread> seen_;     // by vertex, times the root of the weight; zero for those without flaps
  std::vector<uint8_t> has_seen_;
};

class DifferenceModels {
 public:
  DifferenceModels() {
    for (auto& set : farther_) {
      for (size_t shape = 0; shape < kShapes; ++shape) {
        for (size_t bin = 0; bin < kUnary; ++bin) {
          set[shape][bin] = BitModel(bin == 0 ? kFirst[shape] : bin < 6 ? kOther[shape] : std::max(kOther[shape], 40000u), kSeen);
        }
      }
    }
  }

  // value: |value| < 2^27. scale: its mean magnitude in 1/16. set: 0..2, kinds of values that share models.
  template <typename Coder>
  int64_t Code(size_t set, int64_t scale, int64_t value, Coder* coder) {
    // Bins of half the mean magnitude; narrow ones differ in shape.
    const int64_t width = std::max<int64_t>(1, (scale + 16) >> 5);
    const size_t shape = width > 1 ? 5 : scale < 6 ? 0 : scale < 12 ? 1 : scale < 20 ? 2 : scale < 32 ? 3 : 4;
    const int64_t magnitude = value < 0 ? -value : value;
    const auto wanted = static_cast<uint32_t>(magnitude / width);
    uint32_t bin = 0;
    while (bin < kUnary && coder->Code(farther_[set][shape][bin], wanted > bin)) ++bin;
    if (bin == kUnary) bin += CodeByLength(far_[set], wanted - bin, coder);
    if (bin == 0) return static_cast<int64_t>(CodeUniform(static_cast<uint32_t>(2 * width - 1), static_cast<uint32_t>(value + width - 1), coder)) - width + 1;
    const bool negative = coder->CodeEven(value < 0);
    const int64_t start = bin * width;
    const int64_t result = start + CodeUniform(static_cast<uint32_t>(width), static_cast<uint32_t>(magnitude - start), coder);
    return negative ? -result : result;
  }

 private:
  static constexpr uint32_t kUnary = 14;
  static constexpr size_t kShapes = 6;
  // To begin with: chances of leaving the first bin and the others, as bases of many meshes have them, and what they are worth.
  static constexpr std::array<uint32_t, kShapes> kFirst = {25000, 35000, 45000, 51500, 55500, 45000};
  static constexpr std::array<uint32_t, kShapes> kOther = {8000, 14000, 25500, 35500, 44000, 39000};
  static constexpr uint32_t kSeen = 24;
  std::array<std::array<std::array<BitModel, kUnary>, kShapes>, 3> farther_;
  std::array<IntegerModels, 3> far_;
};

// Codes the points of all vertices. t: of a mesh in which every vertex has a triangle. origin: the point of the
// first vertex. extent_bits: 0..25, of the largest
// difference of a coordinate. Returns the points, which an encoding coder is given. Fails with kInvalidData where a point is off the
// lattice.
template <typename Coder>
StatusOr<std::vector<LatticePoint>> CodePositions(const Topology& t, const LatticePoint& origin, int extent_bits, const std::vector<LatticePoint>& points, Coder* coder) {
  PositionPredictor predictor(t);
  SpreadMemory memory(predictor, t.num_vertices, extent_bits);
  DifferenceModels models;
  predictor.SetPoint(predictor.Next(), origin);
  for (uint32_t i = 1; i < t.num_vertices; ++i) {
    const uint32_t v = predictor.Next();
    const Expectation expected = predictor.Expect(v);
    const CoordinateOrder plan = OrderCoordinates(expected.normal, memory.Expect(v, expected));
    LatticeVector difference{};
    std::array<int64_t, 2> before{};
    LatticePoint point = points.empty() ? LatticePoint{} : points[v];
    for (size_t k = 0; k < 3; ++k) {
      const size_t c = plan.order[k];
      constexpr int64_t kFarthest = int64_t{1} << 26;
      const int64_t forecast = std::clamp(DivideRounded(plan.share[k][0] * before[0] + plan.share[k][1] * before[1], 4096), -kFarthest, kFarthest);
      const int64_t wanted = int64_t{point[c]} - expected.point[c] - forecast;
      difference[c] = forecast + models.Code(expected.foresight != Foresight::kFlaps ? 2 : k == 2, plan.scale[k], wanted, coder);
      if (k < 2) before[k] = difference[c];
      const int64_t value = expected.point[c] + difference[c];
      if (value < -kMaxLatticeValue || value > kMaxLatticeValue) return InvalidData("a vertex of the base is off the lattice");
      point[c] = static_cast<int32_t>(value);
    }
    memory.Add(v, expected, difference);

    predictor.SetPoint(v, point);
  }
  return predictor.TakePoints();
}

}  // namespace lacerta

#endif  // LACERTA_COMMON_POSITION_CODING_H_
