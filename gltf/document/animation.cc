#include "document/animation.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

namespace lacerta {
namespace {

std::optional<AnimationTrack::Part> PartOf(const std::string& path) {
  if (path == "translation") return AnimationTrack::Part::kTranslation;
  if (path == "rotation") return AnimationTrack::Part::kRotation;
  if (path == "scale") return AnimationTrack::Part::kScale;
  return std::nullopt;
}

// The middle of each triple: cubic splines have a tangent before and after every value.
AccessorData WithoutTangents(const AccessorData& data) {
  const size_t size = data.components * ComponentSize(data.type);
  AccessorData result = data;
  result.count = data.count / 3;
  result.bytes.clear();
  for (uint64_t i = 0; i < result.count; ++i) {
    const auto begin = data.bytes.begin() + static_cast<std::ptrdiff_t>((3 * i + 1) * size);
    result.bytes.insert(result.bytes.end(), begin, begin + static_cast<std::ptrdiff_t>(size));
  }
  return result;
}

std::optional<AnimationTrack> ReadTrack(const GltfDocument& document, const Json& animation, const Json& channel) {
  const Json* target = Find(channel, "target");
  const Json* sampler = FindElement(animation, "samplers", AsIndex(Find(channel, "sampler")).value_or(~uint64_t{0}));
  if (target == nullptr || sampler == nullptr) return std::nullopt;
  const std::optional<uint64_t> node = AsIndex(Find(*target, "node"));
  const std::optional<AnimationTrack::Part> part = PartOf(AsString(Find(*target, "path")));
  const std::optional<uint64_t> input = AsIndex(Find(*sampler, "input")), output = AsIndex(Find(*sampler, "output"));
  if (!node.has_value() || !part.has_value() || !input.has_value() || !output.has_value()) return std::nullopt;
  const StatusOr<AccessorData> times = ReadAccessor(document, *input);
  StatusOr<AccessorData> values = ReadAccessor(document, *output);
  if (!times.ok() || !values.ok() || times.value().count == 0 || times.value().components != 1) return std::nullopt;
  const std::string interpolation = AsString(Find(*sampler, "interpolation"));
  AnimationTrack track{*node, *part, {}, std::move(values).value(), interpolation == "STEP"};
  if (interpolation == "CUBICSPLINE") track.values = WithoutTangents(track.values);
  const uint32_t components = *part == AnimationTrack::Part::kRotation ? 4 : 3;
  if (track.values.components != components || track.values.count != times.value().count) return std::nullopt;
  for (uint64_t i = 0; i < times.value().count; ++i) track.times.push_back(times.value().Float(i, 0));
  if (!std::is_sorted(track.times.begin(), track.times.end())) return std::nullopt;
  return track;
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
  constexpr uint64_t kMostKeyframes = uint64_t{1} << 24;  // of all tracks: many may refer to the same long accessor
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

}  // namespace lacerta
