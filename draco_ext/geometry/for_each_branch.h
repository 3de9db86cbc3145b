// Parallel work that has parallel loops of its own.
#ifndef LACERTA_GEOMETRY_FOR_EACH_BRANCH_H_
#define LACERTA_GEOMETRY_FOR_EACH_BRANCH_H_

#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

#include <cstddef>
#include <exception>
#include <vector>

namespace lacerta {

// Calls work(0) .. work(count - 1) in parallel. Each runs to its end whatever becomes of the others; then the first exception by number is thrown.
// Under tbb::parallel_for alone an exception, memory that runs out say, cancels the loops within all other branches: they return as if they were
// done, and the branch goes on with what they left out. Isolated: a thread that waits for loops within one does not begin with another meanwhile, whose
// memory and stack would come on top.
template <typename Work>
void ForEachBranch(size_t count, const Work& work) {
  std::vector<std::exception_ptr> thrown(count);
  tbb::parallel_for(size_t{0}, count, [&](size_t i) {
    try {
      tbb::this_task_arena::isolate([&] { work(i); });
    } catch (...) {
      thrown[i] = std::current_exception();
    }
  });
  for (const std::exception_ptr& exception : thrown) {
    if (exception) std::rethrow_exception(exception);
  }
}

}  // namespace lacerta

#endif  // LACERTA_GEOMETRY_FOR_EACH_BRANCH_H_
