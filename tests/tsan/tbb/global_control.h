// See tsan/run_together.h.
#ifndef LACERTA_TESTS_TSAN_TBB_GLOBAL_CONTROL_H_
#define LACERTA_TESTS_TSAN_TBB_GLOBAL_CONTROL_H_

#include <algorithm>
#include <cstddef>

#include "../run_together.h"

namespace tbb {

class global_control {
 public:
  enum parameter { max_allowed_parallelism };
  global_control(parameter, size_t threads)
      : before_(lacerta_tsan::most_threads.exchange(static_cast<int>(std::min<size_t>(threads, lacerta_tsan::kThreads)))) {}
  ~global_control() { lacerta_tsan::most_threads = before_; }
  global_control(const global_control&) = delete;
  global_control& operator=(const global_control&) = delete;

 private:
  int before_;
};

}  // namespace tbb

#endif  // LACERTA_TESTS_TSAN_TBB_GLOBAL_CONTROL_H_
