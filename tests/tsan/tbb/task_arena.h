// See tsan/run_together.h.
#ifndef LACERTA_TESTS_TSAN_TBB_TASK_ARENA_H_
#define LACERTA_TESTS_TSAN_TBB_TASK_ARENA_H_

#include <cstddef>

#include "../run_together.h"
#include "global_control.h"

namespace tbb {

class task_arena {
 public:
  explicit task_arena(int threads) : threads_(threads) {}
  template <typename Call>
  auto execute(const Call& call) -> decltype(call()) {
    const global_control control(global_control::max_allowed_parallelism, static_cast<size_t>(threads_));
    return call();
  }

 private:
  int threads_;
};

namespace this_task_arena {
inline int max_concurrency() { return lacerta_tsan::most_threads; }
template <typename Call>
auto isolate(const Call& call) -> decltype(call()) {
  return call();
}
}  // namespace this_task_arena

}  // namespace tbb

#endif  // LACERTA_TESTS_TSAN_TBB_TASK_ARENA_H_
