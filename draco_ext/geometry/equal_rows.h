// Finding the equal rows of a table.
#ifndef LACERTA_GEOMETRY_EQUAL_ROWS_H_
#define LACERTA_GEOMETRY_EQUAL_ROWS_H_

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

#include "lacerta/mesh.h"

namespace lacerta {

// For each row of `columns` numbers of four bytes the first row that equals it (as == does: -0 equals 0; no NaN, please). O(n).
template <typename T>
std::vector<uint32_t> FirstEqualRow(Span<const T> table, size_t columns) {
  static_assert(sizeof(T) == sizeof(uint32_t));
  constexpr uint32_t kEmpty = std::numeric_limits<uint32_t>::max();
  const auto hash_of = [columns](const T* row) {
    uint64_t hash = 0;
    for (size_t i = 0; i < columns; ++i) {
      const T value = row[i] + T{0};  // -0 becomes 0
      uint32_t bits;
      std::memcpy(&bits, &value, sizeof(bits));
      hash = (hash ^ bits) * 0x9e3779b97f4a7c15;
      hash ^= hash >> 29;
    }
    return hash * 0xbf58476d1ce4e5b9;
  };
  std::vector<uint32_t> first(table.size() / columns);
  std::vector<uint32_t> slots(first.size() + first.size() / 2 + 16, kEmpty);  // rows that are the first of their kind, by their hash
  for (size_t row = 0; row < first.size(); ++row) {
    const T* const numbers = table.data() + row * columns;
    // The upper half of the hash as a share of the slots.
    size_t slot = static_cast<size_t>((hash_of(numbers) >> 32) * slots.size() >> 32);
    while (slots[slot] != kEmpty && !std::equal(numbers, numbers + columns, table.data() + slots[slot] * columns)) {
      slot = slot + 1 == slots.size() ? 0 : slot + 1;
    }
    if (slots[slot] == kEmpty) slots[slot] = static_cast<uint32_t>(row);
    first[row] = slots[slot];
  }
  return first;
}

struct DistinctRows {
  std::vector<uint32_t> of_row;  // the number of each row: equal ones have the same
  std::vector<uint32_t> rows;    // of each number the first row that has it, ascending
};

// Numbers the rows as FirstEqualRow tells them apart.
template <typename T>
DistinctRows NumberRows(Span<const T> table, size_t columns) {
  DistinctRows result{FirstEqualRow(table, columns), {}};
  for (uint32_t row = 0; row < result.of_row.size(); ++row) {
    uint32_t& number = result.of_row[row];
    if (number != row) {
      number = result.of_row[number];  // the first one is numbered by now
    } else {
      number = static_cast<uint32_t>(result.rows.size());
      result.rows.push_back(row);
    }
  }
  return result;
}

}  // namespace lacerta

#endif  // LACERTA_GEOMETRY_EQUAL_ROWS_H_
