#include "document/animation.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

namespace lacerta {
namespace {

constexpr uint64_t kMostKeyframes = uint64_t{1} << 24;  // of all tracks: many may refer to the same long accessor

std::optional<AnimationTrack::Part> PartOf(const std::string& path) {
  if (path == "translation") return AnimationTrack::Part::kTranslation;
  if (path == "rotation") return AnimationTrack::Part::kRotation;
  if (path == "scale") return AnimationTrack::Part::kScale;
  return std::nullopt;
}

// Values of one part of a node.
struct Keyframes {
  std::vector<float> times;
  AccessorData values;
  uint64_t values_per_key = 1;
  bool is_stepped = false;
};

// The middle of each three parts of a key: cubic splines have tangents before and after its values.
AccessorData WithoutTangents(const AccessorData& data, uint64_t values_per_key) {
  const size_t size = values_per_key * data.components * ComponentSize(data.type);
  AccessorData result = data;
  result.count = data.count / 3;
  result.bytes.clear();
  for (uint64_t key = 0; key < result.count / values_per_key; ++key) {
    const auto begin = data.bytes.begin() + static_cast<std::ptrdiff_t>((3 * key + 1) * size);
    result.bytes.insert(result.bytes.end(), begin, begin + static_cast<std::ptrdiff_t>(size));
  }
  return result;
}

// Of a channel's sampler.
std::optional<Keyframes> ReadKeyframes(const GltfDocument& document, const Json& animation, const Json& channel) {
  const Json* sampler = FindElement(animation, "samplers", AsIndex(Find(channel, "sampler")).value_or(~uint64_t{0}));
  if (sampler == nullptr) return std::nullopt;
  const std::optional<uint64_t> input = AsIndex(Find(*sampler, "input")), output = AsIndex(Find(*sampler, "output"));
  if (!input.has_value() || !output.has_value()) return std::nullopt;
  const StatusOr<AccessorData> times = ReadAccessor(document, *input);
  StatusOr<AccessorData> values = ReadAccessor(document, *output);
  if (!times.ok() || !values.ok() || times.value().count == 0 || times.value().components != 1) return std::nullopt;
  const std::string interpolation = AsString(Find(*sampler, "interpolation"));
  const bool is_cubic = interpolation == "CUBICSPLINE";
  const uint64_t parts = times.value().count * (is_cubic ? 3 : 1);
  Keyframes result{{}, std::move(values).value(), 0, interpolation == "STEP"};
  result.values_per_key = result.values.count / parts;
  if (result.values_per_key == 0 || result.values.count != result.values_per_key * parts) return std::nullopt;
  if (is_cubic) result.values = WithoutTangents(result.values, result.values_per_key);
  for (uint64_t i = 0; i < times.value().count; ++i) result.times.push_back(times.value().Float(i, 0));
  if (!std::is_sorted(result.times.begin(), result.times.end())) return std::nullopt;
  return result;
}

std::optional<uint64_t> TargetNode(const Json& channel) {
  const Json* target = Find(channel, "target");
  return target == nullptr ? std::nullopt : AsIndex(Find(*target, "node"));
}

std::string TargetPath(const Json& channel) {
  const Json* target = Find(channel, "target");
  return target == nullptr ? "" : AsString(Find(*target, "path"));
}

std::optional<AnimationTrack> ReadTrack(const GltfDocument& document, const Json& animation, const Json& channel) {
  const std::optional<uint64_t> node = TargetNode(channel);
  const std::optional<AnimationTrack::Part> part = PartOf(TargetPath(channel));
  if (!node.has_value() || !part.has_value()) return std::nullopt;
  std::optional<Keyframes> keyframes = ReadKeyframes(document, animation, channel);
  const uint32_t components = *part == AnimationTrack::Part::kRotation ? 4 : 3;
  if (!keyframes.has_value() || keyframes->values.components != components || keyframes->values_per_key != 1) return std::nullopt;
  return AnimationTrack{*node, *part, std::move(keyframes->times), std::move(keyframes->values), keyframes->is_stepped};
}

}  // namespace

void AnimationTrack::Place(double time, NodePlacement* placement) const {
  const auto later = std::upper_bound(times.begin(), times.end(), time,
                                      [](double t, float key) { return t < static_cast<double>(key); });
  const auto after = std::min<size_t>(static_cast<size_t>(later - times.begin()), times.size() - 1);
  const size_t before = later == times.begin() ? 0 : static_cast<size_t>(later - times.begin()) - 1;
  const double length = static_cast<double>(times[after]) - static_cast<double>(times[before]);
  const double share =
      is_stepped || !(length > 0.0) ? 0.0 : std::clamp((time - static_cast<double>(times[before])) / length, 0.0, 1.0);
  const auto value = [&](uint32_t c, double sign) {
    return (1.0 - share) * static_cast<double>(values.Float(before, c)) +
           share * sign * static_cast<double>(values.Float(after, c));
  };
  if (part != Part::kRotation) {
    std::array<double, 3>& target = part == Part::kScale ? placement->scale : placement->translation;
    for (uint32_t c = 0; c < 3; ++c) target[c] = value(c, 1.0);
    return;
  }
  double cosine = 0.0, squares = 0.0;
  for (uint32_t c = 0; c < 4; ++c)
    cosine += static_cast<double>(values.Float(before, c)) * static_cast<double>(values.Float(after, c));
  for (uint32_t c = 0; c < 4; ++c) {  // the shorter way around; q and -q are the same rotation
    placement->rotation[c] = value(c, cosine < 0.0 ? -1.0 : 1.0);
    squares += placement->rotation[c] * placement->rotation[c];
  }
  for (double& q : placement->rotation) q /= std::sqrt(squares);
}

std::vector<Animation> ReadAnimations(const GltfDocument& document) {
  uint64_t keyframes = 0;
  std::vector<Animation> animations;
  for (uint64_t a = 0; a < ArraySize(document.json, "animations"); ++a) {
    const Json& json = *FindElement(document.json, "animations", a);
    Animation animation;
    for (uint64_t c = 0; c < ArraySize(json, "channels") && keyframes < kMostKeyframes; ++c) {
      std::optional<AnimationTrack> track = ReadTrack(document, json, *FindElement(json, "channels", c));
      if (!track.has_value()) continue;
      keyframes += track->times.size();
      const bool is_first = animation.tracks.empty();
      const auto begin = static_cast<double>(track->times.front()), end = static_cast<double>(track->times.back());
      animation.begin = is_first ? begin : std::min(animation.begin, begin);
      animation.end = is_first ? end : std::max(animation.end, end);
      animation.tracks.push_back(std::move(*track));
    }
    if (!animation.tracks.empty()) animations.push_back(std::move(animation));
  }
  return animations;
}

std::vector<WeightTrack> ReadWeightTracks(const GltfDocument& document) {
  uint64_t values = 0;
  std::vector<WeightTrack> tracks;
  for (uint64_t a = 0; a < ArraySize(document.json, "animations"); ++a) {
    const Json& animation = *FindElement(document.json, "animations", a);
    for (uint64_t c = 0; c < ArraySize(animation, "channels") && values < kMostKeyframes; ++c) {
      const Json& channel = *FindElement(animation, "channels", c);
      const std::optional<uint64_t> node = TargetNode(channel);
      if (!node.has_value() || TargetPath(channel) != "weights") continue;
      std::optional<Keyframes> keyframes = ReadKeyframes(document, animation, channel);
      if (!keyframes.has_value() || keyframes->values.components != 1) continue;
      values += keyframes->values.count;
      tracks.push_back({*node, keyframes->values_per_key, std::move(keyframes->values)});
    }
  }
  return tracks;
}

}  // namespace lacerta
