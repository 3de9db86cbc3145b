#include "pack/influence_slots.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

#include "document/draco_encode.h"

namespace lacerta {
namespace {

constexpr uint32_t kSlots = 4;

AccessorData* FindData(Primitive* primitive, const char* name) {
  for (Attribute& attribute : primitive->attributes) {
    if (attribute.name == name) return &attribute.data;
  }
  return nullptr;
}

// How often joints move vertices, and the same vertices as another.
struct Uses {
  std::map<uint32_t, uint64_t> of_joint;
  std::map<uint32_t, std::map<uint32_t, uint64_t>> together;
};

Uses CountUses(const AccessorData& joints, const AccessorData& weights) {
  Uses uses;
  for (uint64_t v = 0; v < joints.count; ++v) {
    for (uint32_t a = 0; a < kSlots; ++a) {
      if (weights.Float(v, a) == 0.0f) continue;
      const uint32_t joint = joints.Uint(v, a);
      ++uses.of_joint[joint];
      for (uint32_t b = 0; b < kSlots; ++b) {
        if (b != a && weights.Float(v, b) != 0.0f) ++uses.together[joint][joints.Uint(v, b)];
      }
    }
  }
  return uses;
}

// Joint by joint, the most used first, the slot that is least used by others that it is together with.
std::map<uint32_t, uint32_t> ChooseSlots(const Uses& uses) {
  std::vector<std::pair<uint64_t, uint32_t>> order;
  for (const auto& [joint, count] : uses.of_joint) order.emplace_back(count, joint);
  std::sort(order.begin(), order.end(), [](const auto& a, const auto& b) { return a.first != b.first ? a.first > b.first : a.second < b.second; });
  std::map<uint32_t, uint32_t> slot_of;
  for (const auto& [count, joint] : order) {
    std::array<uint64_t, kSlots> taken = {};
    const auto others = uses.together.find(joint);
    if (others != uses.together.end()) {
      for (const auto& [other, times] : others->second) {
        if (const auto known = slot_of.find(other); known != slot_of.end()) taken[known->second] += times;
      }
    }
    slot_of[joint] = static_cast<uint32_t>(std::min_element(taken.begin(), taken.end()) - taken.begin());
  }
  return slot_of;
}

// Bytes of positions, joints and weights at a usual precision.
size_t UsualSize(const Primitive& primitive) {
  constexpr int kPositionBits = 11, kWeightBits = 8;
  Primitive part{primitive.num_vertices, primitive.triangles, {}};
  for (const char* name : {"POSITION", "JOINTS_0", "WEIGHTS_0"}) part.attributes.push_back(*primitive.Find(name));
  DracoPrecision precision;
  precision.positions = FitLattice(part.attributes[0].data, kPositionBits);
  precision.lattices["WEIGHTS_0"] = {{}, 1.0f, kWeightBits};
  const StatusOr<DracoEncoded> encoded = EncodeDracoPrimitive(part, precision);
  return encoded.ok() ? encoded.value().bytes.size() : 0;
}

}  // namespace

void ArrangeInfluences(Primitive* primitive) {
  AccessorData* joints = FindData(primitive, "JOINTS_0");
  AccessorData* weights = FindData(primitive, "WEIGHTS_0");
  if (joints == nullptr || weights == nullptr || primitive->Find("JOINTS_1") != nullptr) return;
  const bool is_index = joints->type == ComponentType::kUint8 || joints->type == ComponentType::kUint16;
  if (!is_index || joints->components != kSlots || weights->components != kSlots) return;
  const std::map<uint32_t, uint32_t> slot_of = ChooseSlots(CountUses(*joints, *weights));
  const AccessorData old_joints = *joints, old_weights = *weights;
  const size_t old_size = UsualSize(*primitive);
  const auto copy = [](const AccessorData& from, uint64_t v, uint32_t a, uint32_t b, AccessorData* to) {
    const size_t size = ComponentSize(from.type);
    std::copy_n(from.bytes.begin() + static_cast<std::ptrdiff_t>((v * kSlots + a) * size), size,
                to->bytes.begin() + static_cast<std::ptrdiff_t>((v * kSlots + b) * size));
  };
  std::fill(joints->bytes.begin(), joints->bytes.end(), uint8_t{0});
  std::fill(weights->bytes.begin(), weights->bytes.end(), uint8_t{0});
  for (uint64_t v = 0; v < joints->count; ++v) {
    std::array<bool, kSlots> taken = {};
    std::array<uint32_t, kSlots> to = {kSlots, kSlots, kSlots, kSlots};
    for (uint32_t a = 0; a < kSlots; ++a) {
      if (old_weights.Float(v, a) == 0.0f) continue;
      const uint32_t wanted = slot_of.at(old_joints.Uint(v, a));
      if (taken[wanted]) continue;
      taken[wanted] = true;
      to[a] = wanted;
    }
    for (uint32_t a = 0; a < kSlots; ++a) {
      if (old_weights.Float(v, a) == 0.0f) continue;
      if (to[a] == kSlots) {  // a joint that came before is there
        to[a] = static_cast<uint32_t>(std::find(taken.begin(), taken.end(), false) - taken.begin());
        taken[to[a]] = true;
      }
      copy(old_joints, v, a, to[a], joints);
      copy(old_weights, v, a, to[a], weights);
    }
  }
  if (UsualSize(*primitive) < old_size) return;
  *joints = old_joints;
  *weights = old_weights;
}

}  // namespace lacerta
