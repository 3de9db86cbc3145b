#include "common/bit_model.h"

#include <cstddef>

#include "common/formula_table.h"

namespace lacerta {
namespace {

template <size_t kSize>
LACERTA_FORMULA_TABLE std::array<uint16_t, kSize> MakeWeights() {
  std::array<uint16_t, kSize> weights{};
  for (uint32_t n = 0; n < kSize; ++n) weights[n] = static_cast<uint16_t>(65536 / (n + 2));
  return weights;
}

}  // namespace

LACERTA_FORMULA_TABLE const std::array<uint16_t, BitModel::kSlowCount + 1> BitModel::kWeight = MakeWeights<kSlowCount + 1>();

}  // namespace lacerta
