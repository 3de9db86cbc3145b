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

void CountUses(const AccessorData& joints, const AccessorData& weights, Uses* uses) {
  for (uint64_t v = 0; v < joints.count; ++v) {
    for (uint32_t a = 0; a < kSlots; ++a) {
      if (weights.Float(v, a) == 0.0f) continue;
      const uint32_t joint = joints.Uint(v, a);
      ++uses->of_joint[joint];
      for (uint32_t b = 0; b < kSlots; ++b) {
        if (b != a && weights.Float(v, b) != 0.0f) ++uses->together[joint][joints.Uint(v, b)];
      }
    }
  }
}

// Joint by joint, the most used first, the slot that is least used by others that it is together with.
std::map<uint32_t, uint32_t> ChooseSlots(const Uses& uses) {
  std::vector<std::pair<uint64_t, uint32_t>> order;
  for (const auto& [joint, count] : uses.of_joint) order.emplace_back(count, joint);
  std::sort(order.begin(), order.end(),
            [](const auto& a, const auto& b) { return a.first != b.first ? a.first > b.first : a.second < b.second; });
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

bool IsArrangeable(const Primitive& primitive) {
  const Attribute *joints = primitive.Find("JOINTS_0"), *weights = primitive.Find("WEIGHTS_0");
  if (joints == nullptr || weights == nullptr || primitive.Find("JOINTS_1") != nullptr) return false;
  const bool is_index = joints->data.type == ComponentType::kUint8 || joints->data.type == ComponentType::kUint16;
  return is_index && joints->data.components == kSlots && weights->data.components == kSlots;
}

Primitive Arranged(const Primitive& primitive, const std::map<uint32_t, uint32_t>& slot_of) {
  Primitive result = primitive;
  const AccessorData &old_joints = primitive.Find("JOINTS_0")->data, &old_weights = primitive.Find("WEIGHTS_0")->data;
  AccessorData *joints = FindData(&result, "JOINTS_0"), *weights = FindData(&result, "WEIGHTS_0");
  const auto copy = [](const AccessorData& from, uint64_t v, uint32_t a, uint32_t b, AccessorData* to) {
    const size_t size = ComponentSize(from.type);
    std::copy_n(from.bytes.begin() + static_cast<std::ptrdiff_t>((v * kSlots + a) * size), size,
                to->bytes.begin() + static_cast<std::ptrdiff_t>((v * kSlots + b) * size));
  };
  std::fill(joints->bytes.begin(), joints->bytes.end(), uint8_t{0});
  std::fill(weights->bytes.begin(), weights->bytes.end(), uint8_t{0});
  for (uint64_t v = 0; v < joints->count; ++v) {
    std::vector<std::pair<uint32_t, uint32_t>> own;  // joint and place, so that the order in the vertex does not matter
    for (uint32_t a = 0; a < kSlots; ++a) {
      if (old_weights.Float(v, a) != 0.0f) own.emplace_back(old_joints.Uint(v, a), a);
    }
    std::sort(own.begin(), own.end());
    std::array<bool, kSlots> taken = {};
    std::vector<std::pair<uint32_t, uint32_t>> rest;
    const auto put = [&](uint32_t from, uint32_t to) {
      taken[to] = true;
      copy(old_joints, v, from, to, joints);
      copy(old_weights, v, from, to, weights);
    };
    for (const auto& [joint, place] : own) {
      const uint32_t wanted = slot_of.at(joint);
      if (taken[wanted]) {
        rest.emplace_back(joint, place);
      } else {
        put(place, wanted);
      }
    }
    for (const auto& [joint, place] : rest)
      put(place, static_cast<uint32_t>(std::find(taken.begin(), taken.end(), false) - taken.begin()));
  }
  return result;
}

}  // namespace

void ArrangeInfluences(std::vector<Primitive*> primitives) {
  const auto has_none = [](const Primitive* p) {
    return p->Find("JOINTS_0") == nullptr && p->Find("WEIGHTS_0") == nullptr;
  };
  primitives.erase(std::remove_if(primitives.begin(), primitives.end(), has_none), primitives.end());
  if (!std::all_of(primitives.begin(), primitives.end(), [](const Primitive* p) { return IsArrangeable(*p); })) return;
  Uses uses;
  for (const Primitive* p : primitives) CountUses(p->Find("JOINTS_0")->data, p->Find("WEIGHTS_0")->data, &uses);
  const std::map<uint32_t, uint32_t> slot_of = ChooseSlots(uses);
  std::vector<Primitive> arranged;
  size_t before = 0, after = 0;
  for (const Primitive* p : primitives) {
    arranged.push_back(Arranged(*p, slot_of));
    before += UsualSize(*p);
    after += UsualSize(arranged.back());
  }
  if (after >= before) return;
  for (size_t i = 0; i < primitives.size(); ++i) *primitives[i] = std::move(arranged[i]);
}

}  // namespace lacerta
