#include "pack/rounded_attributes.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "geometry/value_difference.h"

namespace lacerta {
namespace {

bool BeginsWith(const std::string& text, const char* prefix) { return text.rfind(prefix, 0) == 0; }

// Target, scale, and what kind it is; empty where it has to stay exact.
std::optional<RoundedAttribute> ToleranceOf(const Attribute& attribute, size_t member, const AttributeTargets& targets,
                                            const TexelScale& texels_per_unit, const std::map<std::string, double>& by_name) {
  const std::string& name = attribute.name;
  if (attribute.data.type != ComponentType::kFloat) return std::nullopt;
  RoundedAttribute result;
  result.name = SoupName(attribute, member, texels_per_unit);
  if ((name == "NORMAL" && attribute.data.components == 3) || (name == "TANGENT" && attribute.data.components == 4)) {
    result.target = targets.normal_degrees;
    result.direction = true;
    result.octahedral = name == "NORMAL";
    result.unit = "degrees";
  } else if (BeginsWith(name, "TEXCOORD_")) {
    result.target = targets.uv_texels;
    result.scale = texels_per_unit(member, SetOfTexCoord(name));
    result.unit = "texels";
  } else if (BeginsWith(name, "WEIGHTS_")) {
    result.target = targets.weight * std::sqrt(attribute.data.components);
    result.is_shown = false;
  } else if (const auto found = by_name.find(name); found != by_name.end()) {
    result.target = found->second;
  } else {
    return std::nullopt;
  }
  return result;
}

bool IsFinite(const AccessorData& data) {
  for (uint64_t i = 0; i < data.count; ++i) {
    for (uint32_t c = 0; c < data.components; ++c) {
      if (!std::isfinite(data.Float(i, c))) return false;
    }
  }
  return true;
}

int BitsAtOrAbove(int level) { return (level + kLevelsPerBit - 1) / kLevelsPerBit; }

}  // namespace

int LevelOfSteps(double steps) {
  if (!(steps > 1.0)) return 0;
  return std::isfinite(steps) ? std::min(static_cast<int>(kLevelsPerBit * std::log2(steps)), kMostLevel) : kMostLevel;
}

int RoundedAttribute::FirstLevel() const {
  constexpr int kLeastOctahedralBits = 3;
  return kLevelsPerBit * (octahedral ? kLeastOctahedralBits : 1);
}

int RoundedAttribute::StartLevel() const {
  constexpr double kHalfTurn = 180.0;  // what an octahedral number goes over
  const double extent = octahedral ? kHalfTurn : range * (direction ? kDegreesPerRadian : scale);
  return LevelOfSteps(extent / (target * std::sqrt(12.0)));
}

int RoundedAttribute::AtOrAbove(int level) const {
  const int least = std::max(level, FirstLevel());
  return octahedral ? kLevelsPerBit * BitsAtOrAbove(least) : least;
}

Lattice RoundedAttribute::LatticeAt(const Part& part, int level) const {
  const float step = range * std::exp2(-static_cast<float>(level) / kLevelsPerBit);
  if (is_shown) return LatticeOfStep(part.box, step);
  Lattice from_zero = part.box;
  from_zero.range += std::max(0.0f, *std::max_element(from_zero.origin.begin(), from_zero.origin.end()));
  from_zero.origin = {};
  return LatticeOfStep(from_zero, 1.0f / std::max(1.0f, std::round(1.0f / step)));  // 1 is a lattice point
}

AccessorData RoundedAttribute::RoundedAt(const AccessorData& data, const Part& part, int level) const {
  if (level > kMostLevel) return data;
  if (octahedral) return RoundOctahedral(data, BitsAtOrAbove(level));
  return is_shown ? RoundToLattice(data, LatticeAt(part, level)) : RoundKeepingSums(data, LatticeAt(part, level));
}

std::vector<RoundedAttribute> RoundedAttributesOf(const std::vector<const Primitive*>& primitives,
                                                  const AttributeTargets& targets, const TexelScale& scale,
                                                  const std::map<std::string, double>& by_name) {
  std::vector<RoundedAttribute> result;
  for (size_t m = 0; m < primitives.size(); ++m) {
    for (size_t i = 0; i < primitives[m]->attributes.size(); ++i) {
      const Attribute& attribute = primitives[m]->attributes[i];
      std::optional<RoundedAttribute> own = ToleranceOf(attribute, m, targets, scale, by_name);
      if (!own.has_value() || !IsFinite(attribute.data)) continue;
      auto known = std::find_if(result.begin(), result.end(), [&](const RoundedAttribute& other) {
        return other.name == own->name && other.octahedral == own->octahedral && other.direction == own->direction;
      });
      if (known == result.end()) known = result.insert(result.end(), std::move(*own));
      const Lattice box = FitLattice(attribute.data, 1);
      known->parts.push_back({m, i, box});
      known->range = std::max(known->range, box.range);
      const uint32_t coded = known->octahedral ? 2 : attribute.data.components;
      known->num_numbers += static_cast<double>(attribute.data.count) * coded;
    }
  }
  return result;
}

}  // namespace lacerta
