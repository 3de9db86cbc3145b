#include "pack/morphs.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "document/buffer_edit.h"
#include "document/lattice.h"
#include "lacerta/surface_distance.h"
#include "pack/vertex_match.h"
#include "remesh/base_parts.h"

namespace lacerta {
namespace {

constexpr const char* kPrefix = "TARGET_";

std::string NameOf(size_t target, const std::string& attribute) {
  return kPrefix + std::to_string(target) + "/" + attribute;
}

const Attribute* PositionOf(const MorphTarget& target) {
  const auto found =
      std::find_if(target.begin(), target.end(), [](const Attribute& a) { return a.name == "POSITION"; });
  return found == target.end() ? nullptr : &*found;
}

TriangleMesh Morphed(const std::vector<MorphedPrimitive>& primitives, const TargetMix& mix) {
  TriangleMesh all;
  for (const MorphedPrimitive& one : primitives) {
    TriangleMesh surface = Surface(*one.primitive);
    for (size_t t = 0; t < std::min(mix.size(), one.targets->size()); ++t) {
      const Attribute* offsets = mix[t] == 0.0f ? nullptr : PositionOf((*one.targets)[t]);
      for (uint32_t v = 0; offsets != nullptr && v < surface.positions.size(); ++v) {
        surface.positions[v] += VectorAt(offsets->data, v) * mix[t];
      }
    }
    all = Together(std::move(all), surface);
  }
  return all;
}

}  // namespace

bool IsTargetAttribute(const std::string& name) { return name.rfind(kPrefix, 0) == 0; }

bool IsTargetPosition(const std::string& name) {
  return IsTargetAttribute(name) && name.substr(name.find('/') + 1) == "POSITION";
}

StatusOr<Primitive> WithTargets(const Primitive& primitive, const std::vector<MorphTarget>& targets) {
  constexpr uint64_t kMostNumbers = uint64_t{1} << 26;  // quadrics take some 32 bytes for each
  Primitive result = primitive;
  uint64_t numbers = 0;
  for (size_t t = 0; t < targets.size(); ++t) {
    for (const Attribute& attribute : targets[t]) {
      const bool is_known = attribute.name == "POSITION" || attribute.name == "NORMAL" || attribute.name == "TANGENT";
      if (!is_known || attribute.data.components != 3) return Unsupported("has morph targets of " + attribute.name);
      numbers += 3 * primitive.num_vertices;
      if (numbers > kMostNumbers) return Unsupported("has too many morph targets to be simplified");
      result.attributes.push_back({NameOf(t, attribute.name), AsFloat(attribute.data)});
    }
  }
  return result;
}

std::vector<MorphTarget> TakeTargets(const std::vector<MorphTarget>& like, double nothing, Primitive* primitive) {
  std::vector<MorphTarget> targets;
  for (size_t t = 0; t < like.size(); ++t) {
    targets.emplace_back();
    for (const Attribute& attribute : like[t]) {
      const Attribute* found = primitive->Find(NameOf(t, attribute.name));
      if (found == nullptr) continue;
      AccessorData data = found->data;
      for (uint64_t v = 0; v < data.count && attribute.name == "POSITION"; ++v) {
        const double length = Norm(Vec3Cast<double>(VectorAt(data, v)));
        if (length <= nothing)
          std::fill_n(data.bytes.begin() + static_cast<std::ptrdiff_t>(v * 3 * sizeof(float)), 3 * sizeof(float),
                      uint8_t{0});
      }
      targets.back().push_back({attribute.name, std::move(data)});
    }
  }
  std::vector<Attribute>& attributes = primitive->attributes;
  attributes.erase(std::remove_if(attributes.begin(), attributes.end(),
                                  [](const Attribute& a) { return IsTargetAttribute(a.name); }),
                   attributes.end());
  return targets;
}

StatusOr<MorphMeter> MorphMeter::Create(const std::vector<MorphedPrimitive>& originals, const std::vector<TargetMix>& mixes) {
  size_t num_targets = 0;
  for (const MorphedPrimitive& one : originals) num_targets = std::max(num_targets, one.targets->size());
  MorphMeter meter;
  for (size_t t = 0; t < num_targets; ++t) {
    meter.mixes_.emplace_back(num_targets);
    meter.mixes_.back()[t] = 1.0f;
  }
  meter.mixes_.insert(meter.mixes_.end(), mixes.begin(), mixes.end());
  for (const TargetMix& mix : meter.mixes_) {
    LACERTA_ASSIGN_OR_RETURN(SurfaceDistanceMeter mixed, SurfaceDistanceMeter::Create(Morphed(originals, mix)));
    meter.meters_.push_back(std::move(mixed));
  }
  return meter;
}

StatusOr<bool> MorphMeter::AreWithin(double error, const std::vector<MorphedPrimitive>& stored) const {
  constexpr uint64_t kFewSamples = 3'000, kSamples = 30'000;
  constexpr double kClear = 0.85;  // of the error: more samples would not find it above
  for (size_t m = 0; m < mixes_.size(); ++m) {
    const TriangleMesh morphed = Morphed(stored, mixes_[m]);
    LACERTA_ASSIGN_OR_RETURN(const double rough, Distance(m, morphed, kFewSamples));
    if (rough <= kClear * error) continue;
    LACERTA_ASSIGN_OR_RETURN(const double distance, Distance(m, morphed, kSamples));
    if (!(distance <= error)) return false;
  }
  return true;
}

StatusOr<double> MorphMeter::Distance(size_t mix, const TriangleMesh& morphed, uint64_t num_samples) const {
  LACERTA_ASSIGN_OR_RETURN(const SurfaceDistance distance, meters_[mix].Measure(morphed, SurfaceDistanceOptions::RmsOnly(num_samples)));
  return distance.Rms();
}

std::optional<std::vector<MorphTarget>> ReorderTargets(const MorphedPrimitive& morphed, const DracoPrecision& precision,
                                                       const Primitive& decoded) {
  std::vector<AccessorData> tied;
  for (const MorphTarget& target : *morphed.targets) {
    for (const Attribute& attribute : target) tied.push_back(attribute.data);
  }
  const auto order = MatchVertices(RoundAttributes(*morphed.primitive, precision), decoded, precision, tied);
  if (!order.has_value()) return std::nullopt;
  std::vector<MorphTarget> targets = *morphed.targets;
  for (MorphTarget& target : targets) {
    for (Attribute& attribute : target) attribute.data = Reorder(attribute.data, *order);
  }
  return targets;
}

uint64_t BytesOfTargets(const std::vector<MorphTarget>& targets) {
  uint64_t sum = 0;
  for (const MorphTarget& target : targets) {
    for (const Attribute& attribute : target) sum += StoredSize(attribute.data);
  }
  return sum;
}

}  // namespace lacerta
