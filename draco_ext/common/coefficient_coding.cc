#include "common/coefficient_coding.h"

#include <algorithm>

namespace lacerta {
namespace {

// Larger magnitudes count as this one in contexts, so that sums stay far from 2^32.
constexpr int32_t kMaxCountedMagnitude = 1 << 12;
constexpr uint32_t kMaxForecast = 16u << 12;
// A forecast counts as much as so many neighbors.
constexpr uint32_t kForecastWeight = 2;

int32_t SignOf(int32_t value) { return (value > 0) - (value < 0); }

}  // namespace

void CodedNeighbors::AddNonzero(uint32_t edge, int32_t value) {
  const int32_t counted = std::clamp(value, -kMaxCountedMagnitude, kMaxCountedMagnitude);
  values_[edge] = counted;
  for (const uint32_t v : topology_.edges[edge]) around_[v].sum += Magnitude(counted);
}

CoefficientContext CodedNeighbors::ContextAmongNonzero(uint32_t edge, const Forecast* forecast) const {
  // Edges around both ends weigh 1, and those in the faces of `edge`, which are among them, 2.
  const auto& [a, b] = topology_.edges[edge];
  uint32_t sum = around_[a].sum + around_[b].sum;
  uint32_t weight = around_[a].count + around_[b].count;
  int32_t signed_sum = 0;
  for (const uint32_t face : topology_.edge_faces[edge]) {
    if (face == kNone) continue;
    for (const uint32_t side : topology_.face_edges[face]) {
      if (side >= edge || (has_copies_ && topology_.is_copy(side))) continue;
      sum += Magnitude(values_[side]);
      signed_sum += values_[side];
      ++weight;
    }
  }
  uint64_t sixteenths = uint64_t{16} * sum;
  if (forecast != nullptr) {
    sixteenths += uint64_t{kForecastWeight} * forecast->magnitude;
    weight += kForecastWeight;
  }
  // Something is not zero, so the weight is not.
  const int activity = ActivityClass(static_cast<uint32_t>((sixteenths + weight / 2) / weight));
  return MakeContext(activity, 3 * std::clamp(signed_sum, -2, 2) + (forecast != nullptr ? forecast->sign : 0));
}

std::vector<Forecast> CodedNeighbors::ForecastFiner() const {
  const Topology& t = topology_;
  std::vector<Forecast> parents(t.num_edges());
  for (uint32_t e = 0; e < t.num_edges(); ++e) {
    // The mean of the edge (weight 4) and the other edges of its faces (weight 1), halved: details shrink with the
    // level.
    uint32_t sum = 4 * Magnitude(values_[e]), weight = 4;
    for (const uint32_t face : t.edge_faces[e]) {
      if (face == kNone) continue;
      for (const uint32_t side : t.face_edges[face]) sum += side == e ? 0 : Magnitude(values_[side]);
      weight += 2;
    }
    parents[e] = {8 * sum / weight, SignOf(values_[e])};
  }
  return HandDown(t, parents);
}

ForecastScale::ForecastScale(float from, float to) {
  // A step is (128 + low 7 bits) * 2^(exponent field - 134).
  const uint32_t from_bits = StepToBits(from), to_bits = StepToBits(to);
  from_significand_ = 128 + (from_bits & 127);
  to_significand_ = 128 + (to_bits & 127);
  up_ = std::clamp(static_cast<int>(from_bits >> 7) - static_cast<int>(to_bits >> 7), -40, 24);
}

Forecast ForecastScale::Scaled(const Forecast& forecast) const {
  const uint64_t ratio = uint64_t{forecast.magnitude} * from_significand_ * 256 / to_significand_;
  const uint64_t scaled = up_ >= 0 ? (ratio << up_) >> 8 : ratio >> (8 - up_);
  return {static_cast<uint32_t>(std::min<uint64_t>(scaled, kMaxForecast)), forecast.sign};
}

}  // namespace lacerta
