// Finding equal positions, as == does: -0 equals 0.
#ifndef LACERTA_GEOMETRY_POSITION_TABLE_H_
#define LACERTA_GEOMETRY_POSITION_TABLE_H_

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

#include "lacerta/mesh.h"

namespace lacerta {

// A hash table of the numbers of positions, which are somewhere else: 6 bytes for each of those expected, up to 12 beyond, 18 while it grows.
class PositionTable {
 public:
  explicit PositionTable(size_t expected = 0) : slots_(SlotsFor(expected), kNone) {}

  // The number under which p was entered before. Where it was not, `number`, under which it is from now on: positions[number] has to be p by the next call.
  uint32_t FindOrEnter(const std::vector<Vec3f>& positions, const Vec3f& p, uint32_t number) {
    if (SlotsFor(size_) > slots_.size()) Grow(positions);
    const size_t slot = SlotOf(positions, p);
    if (slots_[slot] != kNone) return slots_[slot];
    slots_[slot] = number;
    ++size_;
    return number;
  }

 private:
  static constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();

  static size_t SlotsFor(size_t size) { return size + size / 2 + 16; }

  static uint64_t Hash(const Vec3f& p) {
    uint64_t hash = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const float value = p[axis] + 0.0f;  // -0 becomes 0
      uint32_t bits;
      std::memcpy(&bits, &value, sizeof(bits));
      hash = (hash ^ bits) * 0x9e3779b97f4a7c15;
      hash ^= hash >> 29;
    }
    return hash * 0xbf58476d1ce4e5b9;
  }

  // Where p is, or where it would go.
  size_t SlotOf(const std::vector<Vec3f>& positions, const Vec3f& p) const {
    // The upper half of the hash as a share of the slots.
    size_t slot = static_cast<size_t>((Hash(p) >> 32) * slots_.size() >> 32);
    while (slots_[slot] != kNone && !(positions[slots_[slot]] == p)) slot = slot + 1 == slots_.size() ? 0 : slot + 1;
    return slot;
  }

  void Grow(const std::vector<Vec3f>& positions) {
    std::vector<uint32_t> before(2 * slots_.size(), kNone);
    before.swap(slots_);
    for (const uint32_t number : before) {
      if (number != kNone) slots_[SlotOf(positions, positions[number])] = number;
    }
  }

  std::vector<uint32_t> slots_;
  size_t size_ = 0;
};

}  // namespace lacerta

#endif  // LACERTA_GEOMETRY_POSITION_TABLE_H_
