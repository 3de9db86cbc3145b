// Finding the equal rows of a table.
#ifndef LACERTA_GEOMETRY_EQUAL_ROWS_H_
#define LACERTA_GEOMETRY_EQUAL_ROWS_H_

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <vector>

#include "lacerta/mesh.h"

namespace lacerta {

// For each row of `columns` numbers the first row that equals it (as == does: -0 equals 0; no NaN, please). O(n log n).
template <typename T>
std::vector<uint32_t> FirstEqualRow(Span<const T> table, size_t columns) {
  std::vector<uint32_t> order(table.size() / columns), first(order.size());
  std::iota(order.begin(), order.end(), 0u);
  // Below zero, zero or above it: row a before, equal to or after row b.
  const auto compare = [&](uint32_t a, uint32_t b) {
    const T *row_a = table.data() + a * columns, *row_b = table.data() + b * columns;
    for (size_t i = 0; i < columns; ++i) {
      if (row_a[i] != row_b[i]) return row_a[i] < row_b[i] ? -1 : 1;
    }
    return 0;
  };
  std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
    const int sign = compare(a, b);
    return sign < 0 || (sign == 0 && a < b);
  });
  for (size_t i = 0; i < order.size(); ++i) {
    first[order[i]] = i > 0 && compare(order[i], order[i - 1]) == 0 ? first[order[i - 1]] : order[i];
  }
  return first;
}

}  // namespace lacerta

#endif  // LACERTA_GEOMETRY_EQUAL_ROWS_H_
