#include "pack/skin.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "remesh/base_parts.h"

namespace lacerta {

bool IsSkinAttribute(const std::string& name) {
  return name.rfind("JOINTS_", 0) == 0 || name.rfind("WEIGHTS_", 0) == 0;
}

StatusOr<VertexInfluences> ReadInfluences(const Primitive& primitive, size_t num_joints) {
  constexpr size_t kMostSets = 16;
  std::vector<std::pair<const AccessorData*, const AccessorData*>> sets;
  for (size_t set = 0; set < kMostSets; ++set) {
    const Attribute* joints = primitive.Find("JOINTS_" + std::to_string(set));
    const Attribute* weights = primitive.Find("WEIGHTS_" + std::to_string(set));
    if ((joints == nullptr) != (weights == nullptr))
      return Unsupported("has joints without weights, or weights without joints");
    if (joints == nullptr) continue;
    const bool is_index = joints->data.type == ComponentType::kUint8 || joints->data.type == ComponentType::kUint16;
    if (!is_index || joints->data.components != 4 || weights->data.components != 4) {
      return Unsupported("has joints or weights of an unknown type");
    }
    sets.emplace_back(&joints->data, &weights->data);
  }
  if (sets.empty()) return Unsupported("has a skin, but no joints");
  VertexInfluences result;
  result.first.push_back(0);
  Influences own;
  for (uint64_t v = 0; v < primitive.num_vertices; ++v) {
    own.clear();
    for (const auto& [joints, weights] : sets) {
      for (uint32_t c = 0; c < 4; ++c) {
        const float weight = weights->Float(v, c);
        const uint32_t joint = joints->Uint(v, c);
        if (weight == 0.0f) continue;
        if (!(weight > 0.0f) || !std::isfinite(weight))
          return Unsupported("has a weight that is below 0 or not finite");
        if (joint >= num_joints)
          return Unsupported("refers to joint " + std::to_string(joint) + ", which its skin has not got");
        own.push_back({joint, weight});
      }
    }
    std::sort(own.begin(), own.end(), [](const Influence& a, const Influence& b) {
      return a.joint != b.joint ? a.joint < b.joint : a.weight < b.weight;
    });
    for (size_t i = 0; i < own.size(); ++i) {
      if (i > 0 && own[i].joint == own[i - 1].joint) {
        result.all.back().weight += own[i].weight;
      } else {
        result.all.push_back(own[i]);
      }
    }
    result.first.push_back(static_cast<uint32_t>(result.all.size()));
  }
  return result;
}

Vec3d Skin::Posed(size_t pose, const Vec3d& position, Span<const Influence> influences) const {
  Vec3d sum;
  for (const Influence& influence : influences) {
    sum = sum + Apply(poses[pose][influence.joint], position) * static_cast<double>(influence.weight);
  }
  return sum;
}

void Skin::AppendPoses(const Vec3d& position, Span<const Influence> influences, std::vector<float>* values) const {
  const double scale = 1.0 / std::sqrt(static_cast<double>(poses.size()));
  for (size_t pose = 0; pose < poses.size(); ++pose) {
    const Vec3f posed = Vec3Cast<float>(Posed(pose, position, influences) * scale);
    values->insert(values->end(), {posed.x, posed.y, posed.z});
  }
}

StatusOr<TriangleMesh> PosedSurface(const std::vector<const Primitive*>& primitives, const Skin& skin, size_t pose) {
  TriangleMesh result;
  for (const Primitive* primitive : primitives) {
    LACERTA_ASSIGN_OR_RETURN(const VertexInfluences influences, ReadInfluences(*primitive, skin.num_joints));
    TriangleMesh surface = Surface(*primitive);
    for (size_t v = 0; v < surface.positions.size(); ++v) {
      surface.positions[v] = Vec3Cast<float>(skin.Posed(pose, Vec3Cast<double>(surface.positions[v]), influences.Of(v)));
    }
    result = Together(std::move(result), surface);
  }
  return result;
}

}  // namespace lacerta
