// Memory that runs out, as a status: nothing throws across our API.
#ifndef LACERTA_DRACO_WITHIN_MEMORY_H_
#define LACERTA_DRACO_WITHIN_MEMORY_H_

#include <new>

#include "lacerta/status.h"

namespace lacerta {

// What `work`, which takes nothing and returns a Status or StatusOr, returns; kLimitExceeded where there was not memory enough for it.
template <typename Work>
auto WithinMemory(const Work& work) -> decltype(work()) {
  try {
    return work();
  } catch (const std::bad_alloc&) {
    return LimitExceeded(
        "not enough memory: a surface takes at least 170 MB and 45 bytes a triangle, one with attributes about 900; simplify it first, or cut it into several meshes");
  }
}

}  // namespace lacerta

#endif  // LACERTA_DRACO_WITHIN_MEMORY_H_
