#include "encoder/growth_guide.h"

#include <algorithm>

namespace lacerta {
namespace {

// The half-edges after and before one in its triangle.
uint32_t Next(uint32_t h) { return h % 3 == 2 ? h - 2 : h + 1; }
uint32_t Previous(uint32_t h) { return h % 3 == 0 ? h + 2 : h - 1; }

}  // namespace

GrowthGuide::GrowthGuide(const ClosedMesh& mesh, uint32_t first, uint32_t corner)
    : mesh_(mesh),
      first_(first),
      corner_(corner),
      entry_(mesh.twin.size(), kNone),
      is_taken_(mesh.triangles.size(), 0),
      is_known_(mesh.valence.size(), 0) {}

void GrowthGuide::SetGate(uint32_t entry, uint32_t half_edge) {
  gate_.resize(std::max<size_t>(gate_.size(), entry + 1), kNone);
  gate_[entry] = half_edge;
  entry_[half_edge] = entry;
}

std::array<uint32_t, 3> GrowthGuide::Start() {
  if (start_ == kNone) {
    start_ = 3 * first_ + corner_;
  } else {
    while (is_taken_[next_start_]) ++next_start_;
    start_ = 3 * next_start_;
  }
  const Triangle& t = mesh_.triangles[start_ / 3];
  std::array<uint32_t, 3> valences{};
  for (uint32_t k = 0; k < 3; ++k) {
    const uint32_t v = t[(start_ + k) % 3];
    valences[k] = mesh_.valence[v];
    is_known_[v] = 1;
    vertex_map_.push_back(v);
  }
  is_taken_[start_ / 3] = 1;
  return valences;
}

void GrowthGuide::Started(const std::array<uint32_t, 3>& entries) {
  // Entry k -> k + 1 runs along the half-edge opposite corner k + 2.
  const uint32_t opposite[3] = {Previous(start_), start_, Next(start_)};
  for (size_t k = 0; k < 3; ++k) SetGate(entries[k], mesh_.twin[opposite[k]]);
}

GrowthStep GrowthGuide::Ask(const GrowingFront&, uint32_t focus) {
  const uint32_t gate = gate_[focus];
  const uint32_t v = mesh_.triangles[gate / 3][gate % 3];
  GrowthStep step;
  if (!is_known_[v]) {
    is_known_[v] = 1;
    step.dummy = v >= mesh_.num_vertices;
    step.valence = mesh_.valence[v];
    if (!step.dummy) vertex_map_.push_back(v);
    return step;
  }
  // Around v from the edge to the focus until the region is met again.
  step.joins = true;
  uint32_t side = Next(gate);  // focus -> v
  for (;;) {
    const uint32_t across = mesh_.twin[side];  // v -> neighbor, outside
    const uint32_t inward = Previous(across);  // next neighbor -> v
    if (is_taken_[mesh_.twin[inward] / 3]) {
      step.target = entry_[inward];
      return step;
    }
    side = inward;
    ++step.free_after;
  }
}

void GrowthGuide::Take(uint32_t gate, uint32_t first_entry, uint32_t second_entry) {
  is_taken_[gate / 3] = 1;
  if (first_entry != kNone) SetGate(first_entry, mesh_.twin[Next(gate)]);
  if (second_entry != kNone) SetGate(second_entry, mesh_.twin[Previous(gate)]);
}

void GrowthGuide::Added(uint32_t focus, uint32_t entry) { Take(gate_[focus], focus, entry); }
void GrowthGuide::Joined(uint32_t focus, uint32_t /*target*/, uint32_t other) { Take(gate_[focus], focus, other); }
// The triangle (after, removed, before): what lies beyond it is beyond before -> after.
void GrowthGuide::Closed(uint32_t before, uint32_t removed) { Take(gate_[removed], kNone, before); }

}  // namespace lacerta
