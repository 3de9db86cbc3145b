// Threads that the thread sanitizer sees through: what stands under tbb/ has the functions of TBB that Lacerta uses, over std::thread. The
// packaged library is not instrumented; what it hands from one thread to another looks like a race, and what is one would be drowned.
#ifndef LACERTA_TESTS_TSAN_RUN_TOGETHER_H_
#define LACERTA_TESTS_TSAN_RUN_TOGETHER_H_

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <thread>
#include <vector>

namespace lacerta_tsan {

inline constexpr int kThreads = 4;  // more than there may be cores: a race does not need them
inline thread_local int depth = 0;  // of calls within calls
inline std::atomic<int> most_threads{kThreads};

// Calls work(0), ..., work(count - 1), each once, from several threads; from this one alone in calls within calls within calls.
template <typename Work>
void RunTogether(size_t count, const Work& work) {
  constexpr int kDeepest = 2;
  std::atomic<size_t> next{0};
  const auto take = [&, inner = depth + 1] {
    const int outer = depth;
    depth = inner;
    for (size_t i = next++; i < count; i = next++) work(i);
    depth = outer;
  };
  std::vector<std::thread> others;
  const size_t wanted = depth < kDeepest ? std::min<size_t>(count, static_cast<size_t>(most_threads.load())) : 1;
  for (size_t t = 1; t < wanted; ++t) others.emplace_back(take);
  take();
  for (std::thread& thread : others) thread.join();
}

}  // namespace lacerta_tsan

#endif  // LACERTA_TESTS_TSAN_RUN_TOGETHER_H_
