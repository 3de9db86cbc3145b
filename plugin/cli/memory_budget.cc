#include "memory_budget.h"

#include <algorithm>
#include <fstream>
#include <string>

#if defined(__linux__)
#include <sys/resource.h>
#include <tbb/parallel_for.h>
#endif

namespace lacerta::cli {
namespace {

// The number behind `key` in a file of lines "key: N kB", in bytes.
std::optional<uint64_t> KilobytesOf(const char* path, const std::string& key) {
  std::ifstream file(path);
  std::string word;
  uint64_t kilobytes = 0;
  while (file >> word) {
    if (word == key && file >> kilobytes) return kilobytes * 1024;
  }
  return std::nullopt;
}

// The number that a file begins with; none where it is a word, as "max" is.
std::optional<uint64_t> NumberIn(const char* path) {
  std::ifstream file(path);
  uint64_t number = 0;
  return file >> number ? std::optional<uint64_t>(number) : std::nullopt;
}

}  // namespace

std::optional<uint64_t> FreeMemory() {
  std::optional<uint64_t> free = KilobytesOf("/proc/meminfo", "MemAvailable:");
  const std::optional<uint64_t> most = NumberIn("/sys/fs/cgroup/memory.max"), taken = NumberIn("/sys/fs/cgroup/memory.current");
  if (!most || !taken) return free;
  const uint64_t left = *most - std::min(*most, *taken);
  return free ? std::min(*free, left) : left;
}

void HoldToMemory(uint64_t bytes) {
#if defined(__linux__)
  tbb::parallel_for(0, 1 << 10, [](int) {});  // threads start now: one that finds no memory for its stack later on has no name for that
  rlimit limit;
  if (getrlimit(RLIMIT_DATA, &limit) != 0) return;
  bytes += KilobytesOf("/proc/self/status", "VmData:").value_or(0);
  limit.rlim_cur = std::min<rlim_t>(bytes, limit.rlim_max);
  setrlimit(RLIMIT_DATA, &limit);
#else
  (void)bytes;
#endif
}

}  // namespace lacerta::cli
