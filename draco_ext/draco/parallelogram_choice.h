// The parallelograms from which a stock Draco stream predicts the values of an attribute, chosen for the fewest bytes.
#ifndef LACERTA_DRACO_PARALLELOGRAM_CHOICE_H_
#define LACERTA_DRACO_PARALLELOGRAM_CHOICE_H_

#include <draco/compression/mesh/mesh_decoder.h>

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "lacerta/mesh.h"

namespace lacerta {

// Values in the order in which a stream codes them, and what may predict them.
struct PredictableValues {
  uint32_t components = 0;
  std::vector<int32_t> values;                          // #N x components, -kMostValue .. kMostValue
  std::vector<std::array<uint32_t, 3>> parallelograms;  // a, b, c < n: value n may be a + b - c
  std::vector<uint32_t> first_parallelogram;            // #N + 1: of each value, at most kMostParallelograms

  size_t size() const { return first_parallelogram.size() - 1; }
};

inline constexpr uint32_t kMostParallelograms = 4;  // of a value, for Draco's decoder
inline constexpr int32_t kMostValue = 1 << 28;      // or least, negated

// decoder: of a mesh by edgebreaker, which it has decoded without transforms, so that values are integers. None where they are beyond kMostValue.
std::optional<PredictableValues> FindPredictableValues(const draco::MeshDecoder& decoder, int attribute);

// What a stream holds for these values by "constrained multi parallelograms": the prediction with its transform, the symbols, which parallelograms are
// left out of the mean that predicts each value, and the range of the values. Draco's encoder decides as it goes, by the entropy of what it has
// coded so far; here choices and their costs, of tagged and of raw symbols, are found in turns. values: not empty.
Bytes EncodeByParallelograms(const PredictableValues& values);

}  // namespace lacerta

#endif  // LACERTA_DRACO_PARALLELOGRAM_CHOICE_H_
