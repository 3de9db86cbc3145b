// See tsan/run_together.h.
#ifndef LACERTA_TESTS_TSAN_TBB_PARALLEL_INVOKE_H_
#define LACERTA_TESTS_TSAN_TBB_PARALLEL_INVOKE_H_

#include <cstddef>
#include <functional>

#include "../run_together.h"

namespace tbb {

template <typename... Calls>
void parallel_invoke(const Calls&... calls) {
  const std::function<void()> all[] = {std::cref(calls)...};
  lacerta_tsan::RunTogether(sizeof...(calls), [&](size_t i) { all[i](); });
}

}  // namespace tbb

#endif  // LACERTA_TESTS_TSAN_TBB_PARALLEL_INVOKE_H_
