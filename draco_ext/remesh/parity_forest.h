// Disjoint sets whose members are either turned like the root of their set or against it.
#ifndef LACERTA_REMESH_PARITY_FOREST_H_
#define LACERTA_REMESH_PARITY_FOREST_H_

#include <cstddef>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace lacerta {

class ParityForest {
 public:
  struct Place {
    uint32_t root;
    uint8_t parity;  // 1: against the root
  };

  explicit ParityForest(size_t size) : parent_(size), parity_(size, 0), size_(size, 1) {
    std::iota(parent_.begin(), parent_.end(), 0u);
  }

  Place Find(uint32_t a) {
    Place place = {a, 0};
    while (parent_[place.root] != place.root) {
      place.parity ^= parity_[place.root];
      place.root = parent_[place.root];
    }
    uint8_t left = place.parity;  // of a below the root, once the path is made short
    while (parent_[a] != a) {
      const uint32_t next = parent_[a];
      const uint8_t step = parity_[a];
      parent_[a] = place.root;
      parity_[a] = left;
      left ^= step;
      a = next;
    }
    return place;
  }

  // Joins two sets so that a and b differ by `parity`. False where they are in one set already and do not.
  bool Join(uint32_t a, uint32_t b, uint8_t parity) {
    Place p = Find(a), q = Find(b);
    if (p.root == q.root) return (p.parity ^ q.parity) == parity;
    if (size_[p.root] < size_[q.root]) std::swap(p, q);
    parent_[q.root] = p.root;
    parity_[q.root] = static_cast<uint8_t>(p.parity ^ q.parity ^ parity);
    size_[p.root] += size_[q.root];
    return true;
  }

  // How many are in the set of a.
  uint32_t SizeOf(uint32_t a) { return size_[Find(a).root]; }

 private:
  std::vector<uint32_t> parent_;
  std::vector<uint8_t> parity_;
  std::vector<uint32_t> size_;
};

}  // namespace lacerta

#endif  // LACERTA_REMESH_PARITY_FOREST_H_
