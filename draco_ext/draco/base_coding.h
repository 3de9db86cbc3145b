// How the base section of a stream is coded.
#ifndef LACERTA_DRACO_BASE_CODING_H_
#define LACERTA_DRACO_BASE_CODING_H_

#include <cstdint>

namespace lacerta {

// The values are those of the custom form (docs/format.md).
enum class BaseCoding : uint8_t {
  kStock = 0,    // a stock Draco mesh stream: all that the Draco form has
  kCompact = 1,  // connectivity by valences, differential positions (DecodeCompactBase)
};

}  // namespace lacerta

#endif  // LACERTA_DRACO_BASE_CODING_H_
