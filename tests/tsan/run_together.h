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

// Calls work(0), ..., work(count - 1), each once, from several threads; from this one alone in calls within calls within calls. Every thread has
// its share, even where the first could do it all before the next one runs: no race goes unseen.
template <typename Work>
void RunTogether(size_t count, const Work& work) {
  constexpr int kDeepest = 2;
  const size_t wanted = depth < kDeepest ? std::min<size_t>(count, static_cast<size_t>(most_threads.load())) : std::min<size_t>(count, 1);
  const auto take = [&work, count, wanted, inner = depth + 1](size_t share) {
    const int outer = depth;
    depth = inner;
    for (size_t i = share; i < count; i += wanted) work(i);
    depth = outer;
  };
  std::vector<std::thread> others;
  for (size_t share = 1; share < wanted; ++share) others.emplace_back(take, share);
  if (wanted > 0) take(0);
  for (std::thread& thread : others) thread.join();
}

}  // namespace lacerta_tsan

#endif  // LACERTA_TESTS_TSAN_RUN_TOGETHER_H_
