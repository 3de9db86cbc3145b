#include "baselines/zerotree.h"

#include <algorithm>
#include <array>

#include "common/bit_model.h"
#include "common/coefficient_models.h"
#include "decoder/range_decoder.h"
#include "encoder/range_encoder.h"

namespace lacerta::baselines {
namespace {

// The largest magnitudes of the sets of descendants of each node.
struct SetMaxima {
  std::vector<uint32_t> magnitude, descendants, grandchildren;
};

SetMaxima FindMaxima(const EdgeTrees& trees, const std::vector<int32_t>& values) {
  SetMaxima maxima;
  for (const int32_t v : values) maxima.magnitude.push_back(Magnitude(v));
  maxima.descendants.assign(values.size(), 0);
  maxima.grandchildren.assign(values.size(), 0);
  for (uint32_t n = trees.num_nodes(); n-- > 0;) {
    for (const uint32_t child : trees.children[n]) {
      if (child == kNone) continue;
      maxima.grandchildren[n] = std::max(maxima.grandchildren[n], maxima.descendants[child]);
      maxima.descendants[n] = std::max({maxima.descendants[n], maxima.magnitude[child], maxima.descendants[child]});
    }
  }
  return maxima;
}

int NumPlanes(const std::vector<int32_t>& values) {
  uint32_t all = 0;
  for (const int32_t v : values) all |= Magnitude(v);
  int planes = 0;
  while (all >> planes != 0) ++planes;
  return planes;
}

// The state of one set, the same on both sides.
class SetCoder {
 public:
  SetCoder(const EdgeTrees& trees, int num_planes)
      : trees_(trees), num_planes_(num_planes), models_(trees.num_levels()) {
    known_.values.assign(trees.num_nodes(), 0);
    known_.unknown_bits.assign(trees.num_nodes(), static_cast<uint8_t>(num_planes));
    visible_.assign(trees.num_nodes(), 0);
    std::fill(visible_.begin(), visible_.begin() + trees.first[1], kNode | kDescendants);
  }

  int num_planes() const { return num_planes_; }
  const ZerotreePrefix& known() const { return known_; }

  // Codes one plane. truth, values: what is coded; null where decisions come from a decoder. Returns whether `budget`,
  // which counts down, sufficed.
  template <typename Coder>
  bool CodePlane(int plane, const SetMaxima* truth, const std::vector<int32_t>* values, Coder* coder,
                 uint64_t* budget) {
    for (int level = 0; level < trees_.num_levels(); ++level) {
      for (uint32_t n = trees_.first[level]; n < trees_.first[level + 1]; ++n) {
        if ((visible_[n] & kNode) != 0) {
          if (*budget == 0) return false;
          --*budget;
          CodeNode(n, plane, values, &models_[level], coder);
        }
        for (const uint8_t set : {kDescendants, kGrandchildren}) {
          if ((visible_[n] & set) == 0 || trees_.is_leaf(n)) continue;
          if (*budget == 0) return false;
          --*budget;
          const auto& maxima = truth ? (set == kDescendants ? truth->descendants : truth->grandchildren) : kNoMaxima;
          BitModel& model = set == kDescendants ? models_[level].descendants : models_[level].grandchildren;
          if (coder->Code(model, truth && maxima[n] >> plane != 0)) Open(n, set);
        }
      }
    }
    // Nodes inside of sets that are still zero.
    for (uint32_t n = 0; n < trees_.num_nodes(); ++n) {
      if ((visible_[n] & kNode) == 0) known_.unknown_bits[n] = static_cast<uint8_t>(plane);
    }
    return true;
  }

 private:
  static constexpr uint8_t kNode = 1, kDescendants = 2, kGrandchildren = 4;  // what is asked about a node
  inline static const std::vector<uint32_t> kNoMaxima;

  struct Models {
    std::array<BitModel, 2> nonzero;  // a leaf or not
    BitModel refinement, descendants, grandchildren;
  };

  template <typename Coder>
  void CodeNode(uint32_t n, int plane, const std::vector<int32_t>* values, Models* models, Coder* coder) {
    int32_t& known = known_.values[n];
    const int32_t value = values ? (*values)[n] : 0;
    const bool bit = (Magnitude(value) >> plane & 1) != 0;
    const int32_t weight = int32_t{1} << plane;
    if (known != 0) {
      if (coder->Code(models->refinement, bit)) known += known < 0 ? -weight : weight;
    } else if (coder->Code(models->nonzero[trees_.is_leaf(n)], bit)) {
      known = coder->CodeEven(value < 0) ? -weight : weight;
    }
    known_.unknown_bits[n] = static_cast<uint8_t>(plane);
  }

  void Open(uint32_t n, uint8_t set) {
    visible_[n] = static_cast<uint8_t>(visible_[n] & ~set);
    const uint32_t child = trees_.children[n][0];
    if (set == kDescendants && !trees_.is_leaf(child)) visible_[n] |= kGrandchildren;
    for (const uint32_t c : trees_.children[n]) {
      if (c != kNone) visible_[c] |= set == kDescendants ? kNode : kDescendants;
    }
  }

  const EdgeTrees& trees_;
  int num_planes_;
  std::vector<Models> models_;    // per level
  std::vector<uint8_t> visible_;  // #nodes
  ZerotreePrefix known_;
};

}  // namespace

Bytes EncodeZerotrees(const EdgeTrees& trees, const std::vector<std::vector<int32_t>>& sets, uint64_t num_decisions) {
  std::vector<SetMaxima> truth;
  std::vector<SetCoder> coders;
  Bytes stream;
  int most_planes = 0;
  for (const std::vector<int32_t>& set : sets) {
    truth.push_back(FindMaxima(trees, set));
    coders.emplace_back(trees, NumPlanes(set));
    stream.push_back(static_cast<uint8_t>(coders.back().num_planes()));
    most_planes = std::max(most_planes, coders.back().num_planes());
  }
  RangeEncoder encoder;
  bool going_on = true;
  for (int plane = most_planes - 1; plane >= 0 && going_on; --plane) {
    for (size_t i = 0; i < sets.size() && going_on; ++i) {
      if (plane < coders[i].num_planes())
        going_on = coders[i].CodePlane(plane, &truth[i], &sets[i], &encoder, &num_decisions);
    }
  }
  const Bytes payload = encoder.Finish();
  stream.insert(stream.end(), payload.begin(), payload.end());
  return stream;
}

std::vector<ZerotreePrefix> DecodeZerotrees(const EdgeTrees& trees, size_t num_sets, Span<const uint8_t> stream,
                                            uint64_t num_decisions) {
  std::vector<SetCoder> coders;
  int most_planes = 0;
  for (size_t i = 0; i < num_sets; ++i) {
    coders.emplace_back(trees, stream[i]);
    most_planes = std::max(most_planes, coders.back().num_planes());
  }
  RangeDecoder decoder(stream.Subspan(num_sets));
  bool going_on = true;
  for (int plane = most_planes - 1; plane >= 0 && going_on; --plane) {
    for (size_t i = 0; i < num_sets && going_on; ++i) {
      if (plane < coders[i].num_planes())
        going_on = coders[i].CodePlane(plane, nullptr, nullptr, &decoder, &num_decisions);
    }
  }
  std::vector<ZerotreePrefix> known;
  for (const SetCoder& coder : coders) known.push_back(coder.known());
  return known;
}

}  // namespace lacerta::baselines
