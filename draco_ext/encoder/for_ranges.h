// Loops over vertices or edges whose turns have nothing to do with each other.
#ifndef LACERTA_ENCODER_FOR_RANGES_H_
#define LACERTA_ENCODER_FOR_RANGES_H_

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cstddef>

namespace lacerta {

// Calls work(begin, end) for ranges that make up [0, size), on several threads where it is long.
template <typename Work>
void ForRanges(size_t size, const Work& work) {
  constexpr size_t kGrain = 8192;
  if (size < 2 * kGrain) return work(size_t{0}, size);
  tbb::parallel_for(tbb::blocked_range<size_t>(0, size, kGrain), [&](const tbb::blocked_range<size_t>& range) { work(range.begin(), range.end()); });
}

}  // namespace lacerta

#endif  // LACERTA_ENCODER_FOR_RANGES_H_
