// See tsan/run_together.h.
#ifndef LACERTA_TESTS_TSAN_TBB_BLOCKED_RANGE_H_
#define LACERTA_TESTS_TSAN_TBB_BLOCKED_RANGE_H_

#include <cstddef>

namespace tbb {

template <typename Value>
class blocked_range {
 public:
  blocked_range(Value begin, Value end, size_t grain = 1) : begin_(begin), end_(end), grain_(grain) {}
  Value begin() const { return begin_; }
  Value end() const { return end_; }
  size_t grainsize() const { return grain_; }

 private:
  Value begin_, end_;
  size_t grain_;
};

}  // namespace tbb

#endif  // LACERTA_TESTS_TSAN_TBB_BLOCKED_RANGE_H_
