// See tsan/run_together.h.
#ifndef LACERTA_TESTS_TSAN_TBB_PARALLEL_FOR_H_
#define LACERTA_TESTS_TSAN_TBB_PARALLEL_FOR_H_

#include <algorithm>
#include <cstddef>

#include "../run_together.h"
#include "blocked_range.h"

namespace tbb {

template <typename Value, typename Body>
void parallel_for(const blocked_range<Value>& range, const Body& body) {
  const auto length = static_cast<size_t>(range.end() - range.begin()), grain = range.grainsize();
  lacerta_tsan::RunTogether((length + grain - 1) / grain, [&](size_t i) {
    const auto begin = static_cast<Value>(range.begin() + static_cast<Value>(i * grain));
    body(blocked_range<Value>(begin, static_cast<Value>(begin + static_cast<Value>(std::min(grain, length - i * grain))), grain));
  });
}

// In blocks: a thread would spend its time on taking numbers.
template <typename Index, typename Body>
void parallel_for(Index first, Index last, const Body& body) {
  if (!(first < last)) return;
  constexpr size_t kBlocks = 32;
  const size_t grain = std::max<size_t>(1, static_cast<size_t>(last - first) / kBlocks);
  parallel_for(blocked_range<Index>(first, last, grain), [&](const blocked_range<Index>& range) {
    for (Index i = range.begin(); i != range.end(); ++i) body(i);
  });
}

}  // namespace tbb

#endif  // LACERTA_TESTS_TSAN_TBB_PARALLEL_FOR_H_
