// The one sort of the decoder: integers by a key. Instances of std::sort are large, which counts in WebAssembly.
#ifndef LACERTA_COMMON_KEYED_SORT_H_
#define LACERTA_COMMON_KEYED_SORT_H_

#include <cstddef>
#include <cstdint>
#include <vector>

namespace lacerta {

struct KeyedIndex {
  uint64_t key = 0;
  uint32_t index = 0;
};

// Sorts [begin, end) of the table by key; what has the same key stays in its order. O(n).
void SortKeyed(std::vector<KeyedIndex>* table, size_t begin, size_t end);

// Sorts [begin, end) likewise and sets first[index] of each of them to the first index among those that have the same key, whose indices must rise.
void FindFirstEqual(std::vector<KeyedIndex>* table, size_t begin, size_t end, std::vector<uint32_t>* first);

// Numbers 0 .. #keys - 1 by what they are equal to: refines *first, which for each tells the first one equal to it so far, by another column of keys.
void RefineEqual(const std::vector<uint32_t>& column, std::vector<uint32_t>* first);

}  // namespace lacerta

#endif  // LACERTA_COMMON_KEYED_SORT_H_
