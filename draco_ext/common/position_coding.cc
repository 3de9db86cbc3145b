#include "common/position_coding.h"

namespace lacerta {
namespace {

constexpr int64_t kOne = 4096;  // of shares and normals
// What normalizes a spread for the confidence of its expectation: the root of the weight of a parallelogram.
constexpr int64_t kUsualRoot = 2896;
constexpr int64_t kLargestSpread = int64_t{1} << 31;

int64_t Root(const Expectation& e) { return e.foresight == Foresight::kFlaps ? SquareRoot(static_cast<uint64_t>(e.weight)) : kUsualRoot; }

}  // namespace

CoordinateOrder OrderCoordinates(const LatticeVector& normal, const Spread& spread) {
  CoordinateOrder plan;
  const auto length = [&](size_t c) { return normal[c] < 0 ? -normal[c] : normal[c]; };
  for (const size_t k : {size_t{0}, size_t{1}, size_t{0}}) {  // three exchanges sort them; equal ones keep their order
    if (length(plan.order[k + 1]) < length(plan.order[k])) std::swap(plan.order[k], plan.order[k + 1]);
  }
  const auto n = [&](size_t k) { return normal[plan.order[k]]; };
  const int64_t along = std::max<int64_t>(spread.along, 1);
  // Covariance along^2 (1 + m n n^T); the shares and variances of the normal distribution given the coordinates before.
  const int64_t ratio = std::min(kOne * 4, (spread.across << 6) / along);  // times 2^6
  const int64_t m = std::clamp<int64_t>(std::min<int64_t>(ratio, 128) * std::min<int64_t>(ratio, 128), 64, 4 * kOne) - kOne;
  int64_t known = kOne;  // 1 + m (n0^2 + n1^2 so far)
  for (size_t k = 0; k < 3; ++k) {
    for (size_t j = 0; j < k; ++j) plan.share[k][j] = DivideDown(DivideDown(m * n(k), kOne) * n(j), known);
    const int64_t square = DivideDown(n(k) * n(k), kOne);
    const int64_t variance = std::max<int64_t>(16, kOne + DivideDown(m * square, known));
    plan.scale[k] = along * SquareRoot(static_cast<uint64_t>(variance)) / 64;
    known = std::max<int64_t>(16, known + DivideDown(m * square, kOne));
  }
  return plan;
}

SpreadMemory::SpreadMemory(const PositionPredictor& predictor, uint32_t num_vertices, int extent_bits)
    : predictor_(predictor), seen_(num_vertices), has_seen_(num_vertices, 0) {
  const int64_t extent = int64_t{16} << extent_bits;
  const int64_t edge = extent / (1 + SquareRoot(num_vertices));
  overall_[static_cast<size_t>(Foresight::kFlaps)] = {edge / 2, edge / 4, 1};
  overall_[static_cast<size_t>(Foresight::kNeighbors)] = {edge, edge, 1};
  overall_[static_cast<size_t>(Foresight::kNothing)] = {extent / 2, extent / 2, 1};
}

Spread SpreadMemory::Expect(uint32_t vertex, const Expectation& expectation) const {
  const Mean& mean = overall_[static_cast<size_t>(expectation.foresight)];
  Spread result{mean.along / mean.count, mean.across / mean.count};
  if (expectation.foresight == Foresight::kFlaps) {
    constexpr int64_t kOverallWeight = 10;
    int64_t count = kOverallWeight;
    result.along *= kOverallWeight;
    result.across *= kOverallWeight;
    for (const uint32_t u : predictor_.neighbors(vertex)) {
      if (!has_seen_[u]) continue;
      result.along += seen_[u].along;
      result.across += seen_[u].across;
      ++count;
    }
    const int64_t root = Root(expectation);
    result.along = result.along * kUsualRoot / (root * count);
    result.across = result.across * kUsualRoot / (root * count);
  }
  return {std::min(result.along, kLargestSpread), std::min(result.across, kLargestSpread)};
}

void SpreadMemory::Add(uint32_t vertex, const Expectation& expectation, const LatticeVector& difference) {
  int64_t across = 0;
  uint64_t square = 0;
  bool has_normal = false;
  for (size_t c = 0; c < 3; ++c) {
    across += expectation.normal[c] * difference[c];
    square += static_cast<uint64_t>(difference[c] * difference[c]);
    has_normal |= expectation.normal[c] != 0;
  }
  // Times 16; of a length in the plane, 163/256 is the mean magnitude of a coordinate, of one in space 148/256.
  across = (across < 0 ? -across : across) / (kOne / 16);
  const int64_t whole = int64_t{16} * SquareRoot(square);
  const int64_t rest = SquareRoot(static_cast<uint64_t>(std::max<int64_t>(0, whole * whole - across * across)));
  Spread spread = has_normal ? Spread{rest * 163 / 256, across} : Spread{whole * 148 / 256, whole * 148 / 256};
  const int64_t root = Root(expectation);
  spread.along = std::min(spread.along * root / kUsualRoot, kLargestSpread);
  spread.across = std::min(spread.across * root / kUsualRoot, kLargestSpread);
  Mean& mean = overall_[static_cast<size_t>(expectation.foresight)];
  mean.along += spread.along;
  mean.across += spread.across;
  ++mean.count;
  if (expectation.foresight == Foresight::kFlaps) {
    seen_[vertex] = spread;
    has_seen_[vertex] = 1;
  }
}

}  // namespace lacerta
