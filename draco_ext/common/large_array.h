// Arrays of megabytes, which decoders take from the system anew: every page that is touched first costs a fault, most of what a first decoding
// takes. Linux gives large pages, of which there are few, to whom asks for them; others decide for themselves.
#ifndef LACERTA_COMMON_LARGE_ARRAY_H_
#define LACERTA_COMMON_LARGE_ARRAY_H_

#include <cstddef>
#include <vector>

namespace lacerta {

#if defined(__linux__)

// Below, an array may hold no large page, which mostly have 2 MiB.
inline constexpr size_t kFewestLargeBytes = size_t{1} << 21;

// Asks the system for large pages where [memory, memory + size) has room for them. A wish: it may be left unheard, and fails nothing.
void AskForLargePages(void* memory, size_t size);

// Grows an array, as resize does, by values of zero.
template <typename T>
void GrowLarge(std::vector<T>* array, size_t size) {
  if (size * sizeof(T) >= kFewestLargeBytes && size > array->capacity()) {
    std::vector<T> larger;
    larger.reserve(size);
    AskForLargePages(larger.data(), size * sizeof(T));
    larger.insert(larger.end(), array->begin(), array->end());
    array->swap(larger);
  }
  array->resize(size);
}

#else

template <typename T>
void GrowLarge(std::vector<T>* array, size_t size) {
  array->resize(size);
}

#endif

// Of zeros.
template <typename T>
std::vector<T> LargeArray(size_t size) {
  std::vector<T> array;
  GrowLarge(&array, size);
  return array;
}

}  // namespace lacerta

#endif  // LACERTA_COMMON_LARGE_ARRAY_H_
