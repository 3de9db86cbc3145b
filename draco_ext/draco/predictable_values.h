// The values of an attribute in a stock Draco stream by edgebreaker, and the parallelograms that may predict them.
#ifndef LACERTA_DRACO_PREDICTABLE_VALUES_H_
#define LACERTA_DRACO_PREDICTABLE_VALUES_H_

#include <draco/compression/mesh/mesh_decoder.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace lacerta {

// Values in the order in which a stream codes them, and what may predict them.
struct PredictableValues {
  uint32_t components = 0;
  std::vector<int32_t> values;                          // #N x components, -kMostValue .. kMostValue
  std::vector<std::array<uint32_t, 3>> parallelograms;  // a, b, c < n: value n may be a + b - c
  std::vector<uint32_t> first_parallelogram;            // #N + 1: of each value, at most kMostParallelograms
  std::vector<uint8_t> has_usual;                       // #N: its first parallelogram is the only one of Draco's "parallelogram"

  size_t size() const { return has_usual.size(); }
  uint32_t num_parallelograms(size_t n) const { return first_parallelogram[n + 1] - first_parallelogram[n]; }
};

inline constexpr uint32_t kMostParallelograms = 4;  // of a value, for Draco's decoder
inline constexpr int32_t kMostValue = 1 << 28;      // or least, negated

// decoder: of a mesh by edgebreaker, which it has decoded without transforms, so that values are integers. None where they are beyond kMostValue.
std::optional<PredictableValues> FindPredictableValues(const draco::MeshDecoder& decoder, int attribute);

}  // namespace lacerta

#endif  // LACERTA_DRACO_PREDICTABLE_VALUES_H_
