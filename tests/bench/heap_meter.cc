#include "bench/heap_meter.h"

#include <malloc.h>

#include <atomic>
#include <cstdlib>
#include <new>

namespace {

// Operators new and delete have no other place to count in.
std::atomic<size_t> in_use{0}, peak{0}, limit{0};
constexpr size_t kAlwaysGranted = 4096;  // to those who report the failure, too

}  // namespace

// In a file of their own, lest the compiler inline them and take malloc and delete for a mismatch.
void* operator new(size_t size) {
  if (limit != 0 && size >= kAlwaysGranted && in_use + size > limit) throw std::bad_alloc();
  void* p = std::malloc(size);
  if (p == nullptr) throw std::bad_alloc();
  const size_t now = in_use += malloc_usable_size(p);
  for (size_t most = peak; now > most && !peak.compare_exchange_weak(most, now);) continue;
  return p;
}

void operator delete(void* p) noexcept {
  if (p != nullptr) in_use -= malloc_usable_size(p);
  std::free(p);
}

void operator delete(void* p, size_t) noexcept { operator delete(p); }

namespace lacerta {

size_t HeapInUse() { return in_use; }
size_t HeapPeak() { return peak; }
void ResetHeapPeak() { peak = in_use.load(); }
void SetHeapLimit(size_t bytes) { limit = bytes; }

}  // namespace lacerta
