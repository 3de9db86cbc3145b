#include "common/step_forecast.h"

#include <algorithm>

namespace lacerta {

int NextStepBits(int bits) {
  const int significand = 128 + (bits & 127);
  int exponent = bits >> 7;
  int next = (6 * significand + 2) / 5;
  if (next >= 256) {
    next = (3 * significand + 2) / 5;
    ++exponent;
  }
  return std::min((exponent << 7) + next - 128, kMostStepBits);
}

}  // namespace lacerta
