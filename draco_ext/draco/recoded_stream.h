// Stock Draco streams in fewer bytes than Draco's own encoder takes.
#ifndef LACERTA_DRACO_RECODED_STREAM_H_
#define LACERTA_DRACO_RECODED_STREAM_H_

#include <cstdint>
#include <optional>
#include <vector>

#include "draco/predictable_values.h"
#include "lacerta/mesh.h"

namespace lacerta {

// The mesh of `stream` in fewer bytes: with blocks of symbols coded anew (EncodeSymbolBlock), and predictions of values by other parallelograms
// (CodeByParallelograms), each where that is smaller. Every Draco decoder reads the same from it, bit by bit. Meant for streams of meshes by edgebreaker
// that Draco's encoder has just written: any other comes back as it is.
Bytes RecodeStream(Bytes stream);

// The same for a stream of one attribute, taken apart.
struct StreamOfValues {
  Bytes before;             // its values, recoded; they are followed by their transform alone
  PredictableValues values;
  std::vector<uint32_t> value_of_point;  // #P: of each point that a decoder makes
};

// None where `stream` is another one, or its attribute is exact floats.
std::optional<StreamOfValues> TakeApart(const Bytes& stream);

}  // namespace lacerta

#endif  // LACERTA_DRACO_RECODED_STREAM_H_
