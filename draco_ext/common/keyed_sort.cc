#include "common/keyed_sort.h"

#include <algorithm>
#include <numeric>

namespace lacerta {

void SortKeyed(std::vector<KeyedIndex>* table, size_t begin, size_t end) {
  std::sort(table->data() + begin, table->data() + end,
            [](const KeyedIndex& a, const KeyedIndex& b) { return a.key != b.key ? a.key < b.key : a.index < b.index; });
}

void FindFirstEqual(std::vector<KeyedIndex>* table, size_t begin, size_t end, std::vector<uint32_t>* first) {
  SortKeyed(table, begin, end);
  const std::vector<KeyedIndex>& keyed = *table;
  for (size_t i = begin; i < end; ++i) {
    const bool is_equal = i > begin && keyed[i].key == keyed[i - 1].key;
    (*first)[keyed[i].index] = is_equal ? (*first)[keyed[i - 1].index] : keyed[i].index;
  }
}

void RefineEqual(const std::vector<uint32_t>& column, std::vector<uint32_t>* first) {
  std::vector<KeyedIndex> keyed(column.size());
  for (uint32_t i = 0; i < column.size(); ++i) keyed[i] = {uint64_t{(*first)[i]} << 32 | column[i], i};
  FindFirstEqual(&keyed, 0, keyed.size(), first);
}

}  // namespace lacerta
