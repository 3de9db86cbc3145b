#include "common/valence_coding.h"

namespace lacerta {

std::vector<uint32_t> NearJoins(const GrowingFront& front, uint32_t focus) {
  // Both neighbors of the edge after the focus, and those next to them, are too near.
  const uint32_t first = front[front[front[focus].next].next].next, last = front[front[focus].prev].prev;
  std::vector<uint32_t> forward, backward, near;
  const uint32_t before_focus = front[focus].prev;
  for (uint32_t e = first; e != before_focus && e != focus && forward.size() < kJoinReach; e = front[e].next) forward.push_back(e);
  const uint32_t second = front[front[focus].next].next;
  for (uint32_t e = last; e != second && e != front[focus].next && backward.size() < kJoinReach; e = front[e].prev) backward.push_back(e);
  const auto add = [&](uint32_t e) {
    if (front[e].free >= 2 && std::find(near.begin(), near.end(), e) == near.end()) near.push_back(e);
  };
  for (size_t i = 0; i < forward.size() || i < backward.size(); ++i) {
    if (i < forward.size()) add(forward[i]);
    if (i < backward.size()) add(backward[i]);
  }
  return near;
}

}  // namespace lacerta
