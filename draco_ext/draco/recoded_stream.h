// Stock Draco streams in fewer bytes than Draco's own encoder takes.
#ifndef LACERTA_DRACO_RECODED_STREAM_H_
#define LACERTA_DRACO_RECODED_STREAM_H_

#include "lacerta/mesh.h"

namespace lacerta {

// The mesh of `stream` in fewer bytes: with blocks of symbols coded anew (EncodeSymbolBlock), and predictions of values by other parallelograms
// (EncodeByParallelograms), each where that is smaller. Every Draco decoder reads the same from it, bit by bit. Meant for streams of meshes by edgebreaker
// that Draco's encoder has just written: any other comes back as it is.
Bytes RecodeStream(Bytes stream);

}  // namespace lacerta

#endif  // LACERTA_DRACO_RECODED_STREAM_H_
