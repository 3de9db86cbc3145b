#include "common/growing_front.h"

#include <algorithm>

namespace lacerta {

uint32_t GrowingFront::Make(uint32_t vertex, uint32_t free) {
  const auto entry = static_cast<uint32_t>(entries_.size());
  entries_.push_back({vertex, 0, entry, entry, static_cast<uint32_t>(live_.size()), 0});
  live_.push_back(entry);
  SetFree(entry, free);
  return entry;
}

void GrowingFront::Link(uint32_t first, uint32_t second) {
  entries_[first].next = second;
  entries_[second].prev = first;
}

void GrowingFront::SetFree(uint32_t entry, uint32_t free) {
  entries_[entry].free = free;
  entries_[entry].stamp = ++stamp_;
  if (free < candidates_.size()) {
    candidates_[free].push_back({entry, stamp_});
  } else {
    constexpr uint32_t kMost = 0x7fffffff;  // only what is damaged has more
    others_.emplace(int64_t{stamp_} - (int64_t{std::min(free, kMost)} << 32), entry);
  }
}

std::array<uint32_t, 3> GrowingFront::AddTriangle(const std::array<uint32_t, 3>& vertices, const std::array<uint32_t, 3>& free) {
  std::array<uint32_t, 3> entries{};
  for (size_t k = 0; k < 3; ++k) entries[k] = Make(vertices[k], free[k]);
  for (size_t k = 0; k < 3; ++k) Link(entries[k], entries[(k + 1) % 3]);
  return entries;
}

uint32_t GrowingFront::TakeFocus() {
  for (std::vector<Candidate>& candidates : candidates_) {
    for (; !candidates.empty(); candidates.pop_back()) {
      const auto [entry, stamp] = candidates.back();
      if (entries_[entry].stamp == stamp) return entry;
    }
  }
  for (;; others_.pop()) {
    const auto [priority, entry] = others_.top();
    if (entries_[entry].stamp == static_cast<uint32_t>(priority)) return entry;
  }
}

uint32_t GrowingFront::InsertAfter(uint32_t entry, uint32_t vertex, uint32_t free) {
  const uint32_t made = Make(vertex, free), next = entries_[entry].next;
  Link(entry, made);
  Link(made, next);
  return made;
}

uint32_t GrowingFront::Join(uint32_t entry, uint32_t target, uint32_t free, uint32_t other_free) {
  const uint32_t before_target = entries_[target].prev, next = entries_[entry].next;
  const uint32_t other = Make(entries_[target].vertex, other_free);
  Link(entry, target);
  Link(before_target, other);
  Link(other, next);
  SetFree(target, free);
  return other;
}

void GrowingFront::Remove(uint32_t entry) {
  FrontEntry& removed = entries_[entry];
  Link(removed.prev, removed.next);
  removed.stamp = ++stamp_;  // what the queue knows of it is out of date
  live_[removed.place] = live_.back();
  entries_[live_.back()].place = removed.place;
  live_.pop_back();
}

}  // namespace lacerta
