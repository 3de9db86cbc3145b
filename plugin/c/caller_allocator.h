// The caller's allocator, as the standard library wants it.
#ifndef LACERTA_PLUGIN_C_CALLER_ALLOCATOR_H_
#define LACERTA_PLUGIN_C_CALLER_ALLOCATOR_H_

#include <cstddef>
#include <cstdlib>
#include <limits>
#include <new>

#include "lacerta.h"

namespace lacerta {

template <typename T>
class CallerAllocator {
 public:
  using value_type = T;

  explicit CallerAllocator(const lacerta_allocator& allocator) : allocator_(allocator) {}
  template <typename U>
  explicit CallerAllocator(const CallerAllocator<U>& other) : allocator_(other.get()) {}

  T* allocate(size_t count) {
    void* memory = nullptr;
    if (count <= std::numeric_limits<size_t>::max() / sizeof(T)) memory = allocator_.allocate(allocator_.user, count * sizeof(T));
#ifdef __cpp_exceptions
    if (memory == nullptr) throw std::bad_alloc();  // caught in the C function
#else
    if (memory == nullptr) std::abort();
#endif
    return static_cast<T*>(memory);
  }
  void deallocate(T* memory, size_t count) { allocator_.deallocate(allocator_.user, memory, count * sizeof(T)); }

  const lacerta_allocator& get() const { return allocator_; }
  friend bool operator==(const CallerAllocator& a, const CallerAllocator& b) {
    return a.allocator_.user == b.allocator_.user && a.allocator_.deallocate == b.allocator_.deallocate;
  }
  friend bool operator!=(const CallerAllocator& a, const CallerAllocator& b) { return !(a == b); }

 private:
  lacerta_allocator allocator_;
};

}  // namespace lacerta

#endif  // LACERTA_PLUGIN_C_CALLER_ALLOCATOR_H_
