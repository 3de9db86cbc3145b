#include "pack/round_targets.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <optional>

namespace lacerta {
namespace {

// As integers of a type; empty where one is out of reach, or the error larger than is allowed.
template <typename Integer>
std::optional<AccessorData> Rounded(const AccessorData& floats, ComponentType type, double allowed) {
  constexpr float kOne = std::numeric_limits<Integer>::max();
  AccessorData result{type, floats.components, true, floats.count, Bytes(static_cast<size_t>(floats.count * floats.components) * sizeof(Integer))};
  double sum = 0.0;
  uint64_t moved = 0;
  for (uint64_t i = 0; i < floats.count; ++i) {
    double squared = 0.0;
    bool is_moved = false;
    for (uint32_t c = 0; c < floats.components; ++c) {
      const float value = floats.Float(i, c);
      if (!(std::fabs(value) <= 1.0f)) return std::nullopt;
      const auto integer = static_cast<Integer>(std::lround(value * kOne));
      std::memcpy(result.bytes.data() + static_cast<size_t>(i * floats.components + c) * sizeof(Integer), &integer, sizeof(Integer));
      const double off = double{static_cast<float>(integer) / kOne} - double{value};
      squared += off * off;
      is_moved = is_moved || value != 0.0f;
    }
    sum += squared;
    moved += is_moved ? 1 : 0;
  }
  if (sum > allowed * allowed * static_cast<double>(moved)) return std::nullopt;
  return result;
}

}  // namespace

double RoomBeside(double taken, double allowed) { return std::sqrt(std::max(allowed * allowed - taken * taken, 0.0)); }

std::vector<MorphTarget> RoundTargets(std::vector<MorphTarget> targets, const TargetTolerance& tolerance) {
  for (MorphTarget& target : targets) {
    for (Attribute& offsets : target) {
      const double allowed = offsets.name == "POSITION" ? tolerance.positions : tolerance.directions;
      if (offsets.data.type != ComponentType::kFloat || allowed <= 0.0) continue;
      std::optional<AccessorData> rounded = Rounded<int8_t>(offsets.data, ComponentType::kInt8, allowed);
      if (!rounded) rounded = Rounded<int16_t>(offsets.data, ComponentType::kInt16, allowed);
      if (rounded) offsets.data = *std::move(rounded);
    }
  }
  return targets;
}

bool AreQuantized(const std::vector<MorphTarget>& targets) {
  return std::any_of(targets.begin(), targets.end(), [](const MorphTarget& target) {
    return std::any_of(target.begin(), target.end(), [](const Attribute& a) { return a.data.type != ComponentType::kFloat; });
  });
}

}  // namespace lacerta
