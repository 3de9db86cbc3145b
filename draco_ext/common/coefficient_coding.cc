#include "common/coefficient_coding.h"

#include <algorithm>

namespace lacerta {
namespace {

// Larger magnitudes count as this one in contexts, so that sums stay far from 2^32.
constexpr uint32_t kMaxCountedMagnitude = 1u << 12;
constexpr uint32_t kMaxForecast = 16 * kMaxCountedMagnitude;

}  // namespace

void NeighborSums::Add(uint32_t edge, uint32_t magnitude) {
  const uint32_t counted = std::min(magnitude, kMaxCountedMagnitude);
  magnitude_[edge] = counted;
  for (const uint32_t v : topology_.edges[edge]) {
    vertex_sum_[v] += counted;
    ++vertex_count_[v];
  }
}

CoefficientContext NeighborSums::Context(uint32_t edge, uint32_t forecast, bool has_forecast) const {
  // Edges around both ends weigh 1, and those in the faces of `edge`, which are among them, 2.
  const auto& [a, b] = topology_.edges[edge];
  uint64_t sum = uint64_t{vertex_sum_[a]} + vertex_sum_[b];
  uint64_t weight = uint64_t{vertex_count_[a]} + vertex_count_[b];
  for (const uint32_t face : topology_.edge_faces[edge]) {
    if (face == kNone) continue;
    for (const uint32_t side : topology_.face_edges[face]) {
      if (side >= edge) continue;
      sum += magnitude_[side];
      ++weight;
    }
  }
  uint64_t expected = forecast;
  if (weight > 0) {
    const uint64_t neighbors = (16 * sum + weight / 2) / weight;
    expected = has_forecast ? (3 * neighbors + forecast + 2) / 4 : neighbors;
  }
  CoefficientContext context;
  context.activity = ActivityClass(static_cast<uint32_t>(expected));
  return context;
}

uint32_t RescaleForecast(uint32_t forecast, float from, float to) {
  const uint32_t from_bits = StepToBits(from), to_bits = StepToBits(to);
  const uint64_t scaled = uint64_t{forecast} * (0x80 + (from_bits & 0x7f)) * 256 / (0x80 + (to_bits & 0x7f));
  const int shift = 8 - (static_cast<int>(from_bits >> 7) - static_cast<int>(to_bits >> 7));
  if (scaled == 0 || shift >= 64) return 0;
  if (shift < -20) return kMaxForecast;
  return static_cast<uint32_t>(std::min<uint64_t>(shift >= 0 ? scaled >> shift : scaled << -shift, kMaxForecast));
}

std::vector<uint32_t> ForecastFiner(const Topology& t, const std::vector<uint32_t>& magnitudes) {
  std::vector<uint32_t> smoothed(t.num_edges());
  for (uint32_t e = 0; e < t.num_edges(); ++e) {
    uint32_t sum = 0, weight = 2;
    for (const uint32_t face : t.edge_faces[e]) {
      if (face == kNone) continue;
      for (const uint32_t side : t.face_edges[face]) sum += magnitudes[side];  // `e` itself once per face
      weight += 3;
    }
    sum += 2 * magnitudes[e];
    smoothed[e] = 16 * sum / weight;
  }
  std::vector<uint32_t> finer(size_t{2} * t.num_edges() + size_t{3} * t.num_faces());
  for (uint32_t e = 0; e < t.num_edges(); ++e) finer[2 * e] = finer[2 * e + 1] = smoothed[e];
  for (uint32_t f = 0; f < t.num_faces(); ++f) {
    for (uint32_t k = 0; k < 3; ++k) finer[2 * t.num_edges() + 3 * f + k] = smoothed[t.face_edges[f][k]];
  }
  return finer;
}

}  // namespace lacerta
