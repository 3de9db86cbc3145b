#include "decoder/joint_weights.h"

#include <algorithm>
#include <string>
#include <utility>

namespace lacerta {
namespace {

constexpr size_t kKept = 4;

VertexSoup::Attribute* Find(VertexSoup* soup, const char* name) {
  for (VertexSoup::Attribute& a : soup->attributes) {
    if (a.name == name) return &a;
  }
  return nullptr;
}

}  // namespace

FourWeights LargestFour(const float* row, const JointTable& joints) {
  FourWeights result;
  std::array<float, kKept>& weights = result.weights;  // descending
  for (size_t c = 0; c < joints.size(); ++c) {
    size_t at = kKept;
    for (; at > 0 && row[c] > weights[at - 1]; --at) {
      if (at == kKept) continue;
      weights[at] = weights[at - 1];
      result.joints[at] = result.joints[at - 1];
    }
    if (at == kKept) continue;
    weights[at] = row[c];
    result.joints[at] = joints[c];
  }
  const float sum = weights[0] + weights[1] + weights[2] + weights[3];
  if (sum > 0) {
    for (float& weight : weights) weight /= sum;
  } else {
    weights[0] = 1.0f;
    result.joints[0] = joints[0];
  }
  return result;
}

Status SpreadWeights(const JointTable& joints, VertexSoup* soup) {
  VertexSoup::Attribute* const weights = Find(soup, kWeightsName);
  const VertexSoup::Attribute* const named = Find(soup, kJointsName);
  if (weights == nullptr && named == nullptr) return Status();
  if (weights == nullptr || named == nullptr || named->components != kKept || weights->components != kKept)
    return InvalidData("the base has not four joints and four weights for each vertex");
  std::vector<float> values(soup->positions.size() * joints.size(), 0.0f);
  for (size_t i = 0; i < weights->values.size(); ++i) {
    if (weights->values[i] == 0) continue;
    const auto joint = std::find(joints.begin(), joints.end(), named->values[i]);
    if (joint == joints.end())
      return InvalidData("the base names joint " + std::to_string(static_cast<int64_t>(named->values[i])) +
                         ", which the stream has not got");
    values[i / kKept * joints.size() + static_cast<size_t>(joint - joints.begin())] += weights->values[i];
  }
  weights->kind = AttributeKind::kWeights;
  weights->components = static_cast<uint32_t>(joints.size());
  weights->values = std::move(values);
  soup->attributes.erase(soup->attributes.begin() + (named - soup->attributes.data()));
  return Status();
}

void GatherWeights(const JointTable& joints, VertexSoup* soup) {
  VertexSoup::Attribute* const weights = Find(soup, kWeightsName);
  if (weights == nullptr || joints.empty() || weights->components != joints.size()) return;
  VertexSoup::Attribute four{kWeightsName, AttributeKind::kWeights, kKept, {}},
      named{kJointsName, AttributeKind::kGeneric, kKept, {}};
  for (size_t v = 0; v < soup->positions.size(); ++v) {
    const FourWeights of = LargestFour(&weights->values[v * joints.size()], joints);
    four.values.insert(four.values.end(), of.weights.begin(), of.weights.end());
    named.values.insert(named.values.end(), of.joints.begin(), of.joints.end());
  }
  *weights = std::move(four);
  soup->attributes.push_back(std::move(named));
}

}  // namespace lacerta
