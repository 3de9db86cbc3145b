// The front of a region that grows over a closed mesh: closed loops of vertices, each with the number of its edges that lie
// outside of the region still. Shared by both sides of the coding of connectivity (common/valence_coding.h).
#ifndef LACERTA_COMMON_GROWING_FRONT_H_
#define LACERTA_COMMON_GROWING_FRONT_H_

#include <array>
#include <cstdint>
#include <queue>
#include <utility>
#include <vector>

#include "common/subdivision.h"

namespace lacerta {

// A place of the front. A vertex has several where the region touches itself.
struct FrontEntry {
  uint32_t vertex = 0;
  uint32_t free = 0;            // edges of the vertex, in the sector of this entry, that are not in the region
  uint32_t prev = 0, next = 0;  // entries; the region lies to the left of vertex -> next
  uint32_t place = 0;           // in GrowingFront::live
  uint32_t stamp = 0;           // of the last change
};

class GrowingFront {
 public:
  const FrontEntry& operator[](uint32_t entry) const { return entries_[entry]; }
  bool empty() const { return live_.empty(); }
  // All entries, in an order that both sides have.
  const std::vector<uint32_t>& live() const { return live_; }
  size_t num_entries_made() const { return entries_.size(); }

  // A new loop around a triangle. Returns its three entries.
  std::array<uint32_t, 3> AddTriangle(const std::array<uint32_t, 3>& vertices, const std::array<uint32_t, 3>& free);
  // The entry with the fewest free edges, of those the one that changed last. Not empty.
  uint32_t TakeFocus();
  // Puts a vertex between `entry` and the one after it.
  uint32_t InsertAfter(uint32_t entry, uint32_t vertex, uint32_t free);
  // Joins the front at `target` to `entry` and the one after it: `target` from now on follows upon `entry`, with `free` edges, and
  // the entry that is returned, of the same vertex, comes before what came after `entry`, with `other_free` edges.
  uint32_t Join(uint32_t entry, uint32_t target, uint32_t free, uint32_t other_free);
  void SetFree(uint32_t entry, uint32_t free);
  void Remove(uint32_t entry);

 private:
  uint32_t Make(uint32_t vertex, uint32_t free);
  void Link(uint32_t first, uint32_t second);

  std::vector<FrontEntry> entries_;
  std::vector<uint32_t> live_;
  struct Candidate {
    uint32_t entry = 0, stamp = 0;
  };
  // For the focus, out of date where the stamp is. By the number of free edges, the last one that changed at the end; of more
  // edges: stamp - 2^32 free, entry, of the type of PositionPredictor's queue: one instance of code.
  std::array<std::vector<Candidate>, 12> candidates_;
  std::priority_queue<std::pair<int64_t, uint32_t>> others_;
  uint32_t stamp_ = 0;
};

}  // namespace lacerta

#endif  // LACERTA_COMMON_GROWING_FRONT_H_
