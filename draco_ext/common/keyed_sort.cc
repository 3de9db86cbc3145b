#include "common/keyed_sort.h"

#include <algorithm>

namespace lacerta {
namespace {

// So many are sorted by insertion: tables of the pairs around one vertex are small, and there are many of them.
constexpr size_t kFew = 48;

void SortFew(KeyedIndex* begin, KeyedIndex* end) {
  for (KeyedIndex* next = begin; next != end; ++next) {
    const KeyedIndex value = *next;
    KeyedIndex* to = next;
    for (; to != begin && value.key < to[-1].key; --to) *to = to[-1];
    *to = value;
  }
}

// By byte after byte of the keys, from the lowest; bytes that all keys have in common are passed over.
void SortMany(KeyedIndex* begin, KeyedIndex* end) {
  uint64_t differing = 0;
  for (const KeyedIndex* item = begin; item != end; ++item) differing |= item->key ^ begin->key;
  std::vector<KeyedIndex> from(end - begin);
  for (int shift = 0; shift < 64; shift += 8) {
    if ((differing >> shift & 0xff) == 0) continue;
    std::copy(begin, end, from.begin());
    size_t places[257] = {};
    for (const KeyedIndex& item : from) ++places[(item.key >> shift & 0xff) + 1];
    for (int i = 0; i < 256; ++i) places[i + 1] += places[i];
    for (const KeyedIndex& item : from) begin[places[item.key >> shift & 0xff]++] = item;
  }
}

}  // namespace

void SortKeyed(std::vector<KeyedIndex>* table, size_t begin, size_t end) {
  (end - begin <= kFew ? SortFew : SortMany)(table->data() + begin, table->data() + end);
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
