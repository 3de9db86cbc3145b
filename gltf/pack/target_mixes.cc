#include "pack/target_mixes.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace lacerta {
namespace {

constexpr size_t kMostMixes = 4;
constexpr uint64_t kKeyframes = 16;         // of a track
constexpr uint64_t kMostNumbers = 1 << 22;  // in all mixes that are looked at
constexpr float kUnseen = 0.01f;            // weights that show nothing
constexpr float kLeastApart = 0.1f;         // mixes that are nearer are alike

class MixesSeen {
 public:
  explicit MixesSeen(size_t num_targets) : num_targets_(num_targets) {}

  void Add(TargetMix mix) {
    const auto is_shown = [](float w) { return std::fabs(w) > kUnseen; };
    const bool is_finite = std::all_of(mix.begin(), mix.end(), [](float w) { return std::isfinite(w); });
    const bool is_large = std::any_of(mix.begin(), mix.end(), [](float w) { return w < -kUnseen || w > 1.0f + kUnseen; });
    const bool tells_more = is_large || std::count_if(mix.begin(), mix.end(), is_shown) > 1;
    if (is_finite && tells_more && mix.size() == num_targets_ && num_numbers_ < kMostNumbers) {
      num_numbers_ += mix.size();
      mixes_.push_back(std::move(mix));
    }
  }

  void Add(const Json* weights) {
    if (weights == nullptr || !weights->is_array()) return;
    TargetMix mix;
    for (const Json& weight : *weights) mix.push_back(weight.is_number() ? weight.get<float>() : NAN);
    Add(std::move(mix));
  }

  void Add(const WeightTrack& track) {
    const uint64_t num_keys = track.values.count / track.num_targets, num_looks = std::min(num_keys, kKeyframes);
    for (uint64_t i = 0; i < num_looks; ++i) {
      const uint64_t key = num_looks == 1 ? 0 : i * (num_keys - 1) / (num_looks - 1);
      TargetMix mix;
      for (uint64_t t = 0; t < track.num_targets; ++t) mix.push_back(track.values.Float(key * track.num_targets + t, 0));
      Add(std::move(mix));
    }
  }

  // Those that differ most.
  std::vector<TargetMix> Choose() const {
    std::vector<TargetMix> chosen;
    std::vector<float> apart;  // squared, of every mix: from rest at first, then from the nearest of those chosen
    for (const TargetMix& mix : mixes_) apart.push_back(SquaredDistance(mix, TargetMix(num_targets_)));
    while (chosen.size() < kMostMixes) {
      const auto farthest = std::max_element(apart.begin(), apart.end());
      if (farthest == apart.end() || *farthest < kLeastApart * kLeastApart) break;
      chosen.push_back(mixes_[static_cast<size_t>(farthest - apart.begin())]);
      for (size_t i = 0; i < apart.size(); ++i) {
        const float distance = SquaredDistance(mixes_[i], chosen.back());
        apart[i] = chosen.size() == 1 ? distance : std::min(apart[i], distance);
      }
    }
    return chosen;
  }

 private:
  static float SquaredDistance(const TargetMix& a, const TargetMix& b) {
    float sum = 0;
    for (size_t t = 0; t < a.size(); ++t) sum += (a[t] - b[t]) * (a[t] - b[t]);
    return sum;
  }

  const size_t num_targets_;
  uint64_t num_numbers_ = 0;
  std::vector<TargetMix> mixes_;
};

}  // namespace

std::vector<TargetMix> FindTargetMixes(const GltfDocument& document, const std::vector<WeightTrack>& tracks, const std::vector<const Source*>& sources,
                                       size_t num_targets) {
  MixesSeen seen(num_targets);
  std::set<uint64_t> shown_by;
  for (const auto& [mesh, nodes] : NodesByMesh(document, sources)) {
    seen.Add(Find(*FindElement(document.json, "meshes", mesh), "weights"));
    for (const uint64_t n : nodes) seen.Add(Find(*FindElement(document.json, "nodes", n), "weights"));
    shown_by.insert(nodes.begin(), nodes.end());
  }
  for (const WeightTrack& track : tracks) {
    if (shown_by.count(track.node) > 0) seen.Add(track);
  }
  return seen.Choose();
}

}  // namespace lacerta
