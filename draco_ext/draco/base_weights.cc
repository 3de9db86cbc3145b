#include "draco/base_weights.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

namespace lacerta {

float WeightStep(double error) {
  constexpr int kFewestBits = 3, kMostBits = 14;
  const auto bits = static_cast<int>(std::clamp(std::ceil(-std::log2(error)), double{kFewestBits}, double{kMostBits}));
  return std::ldexp(1.0f, -bits);
}

void AppendRoundedWeights(const float* row, uint32_t num_joints, float step, std::vector<int32_t>* points) {
  JointTable components(num_joints);
  std::iota(components.begin(), components.end(), uint16_t{0});
  const FourWeights four = LargestFour(row, components);
  std::array<int32_t, 4> rounded;
  auto left = static_cast<int32_t>(std::lround(1 / step));
  for (size_t i = 0; i < rounded.size(); ++i) left -= rounded[i] = static_cast<int32_t>(four.weights[i] / step);
  const auto lost = [&](size_t i) { return four.weights[i] / step - static_cast<float>(rounded[i]); };
  for (; left > 0; --left) {
    size_t most = 0;
    for (size_t i = 1; i < rounded.size(); ++i) most = lost(i) > lost(most) ? i : most;
    ++rounded[most];
  }
  const size_t first = points->size();
  points->resize(first + num_joints, 0);
  for (size_t i = 0; i < rounded.size(); ++i) (*points)[first + four.joints[i]] += rounded[i];
}

PlacedWeights PlaceWeights(const int32_t* points, uint32_t num_vertices, float step, const JointTable& joints) {
  constexpr size_t kPlaces = 4;
  PlacedWeights result{std::vector<int32_t>(kPlaces * num_vertices, 0),
                       std::vector<uint16_t>(kPlaces * num_vertices, 0)};
  for (size_t v = 0; v < num_vertices; ++v) {
    const std::vector<float> row(points + v * joints.size(), points + (v + 1) * joints.size());
    const FourWeights four = LargestFour(row.data(), joints);
    for (size_t i = 0; i < kPlaces; ++i) {
      const auto point = static_cast<int32_t>(std::lround(four.weights[i] / step));
      if (point == 0) continue;
      size_t place = four.joints[i] % kPlaces;
      while (result.points[kPlaces * v + place] > 0) place = (place + 1) % kPlaces;
      result.points[kPlaces * v + place] = point;
      result.joints[kPlaces * v + place] = four.joints[i];
    }
  }
  return result;
}

}  // namespace lacerta
