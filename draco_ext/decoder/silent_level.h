// The last level of a stream where it has no coefficients, straight from the tables of the level before the one that it refines: tables of the finest
// levels are most of what a decoder would make, and nothing else asks for them.
#ifndef LACERTA_DECODER_SILENT_LEVEL_H_
#define LACERTA_DECODER_SILENT_LEVEL_H_

#include <vector>

#include "common/butterfly.h"
#include "common/subdivision.h"
#include "lacerta/mesh.h"

namespace lacerta {

// The same, bit by bit, as PredictMidpoints(Refine(t), table, positions): appends the butterfly's midpoints of the level that t refines to.
//   t          level i, without joined borders (`master` is empty)
//   table      as for PredictMidpoints
//   positions  of level i + 1, #V + #E, on entry; of level i + 2, #V + 3 #E + 3 #F, on return
void PredictRefinedMidpoints(const Topology& t, const StencilTable& table, std::vector<Vec3f>* positions);

}  // namespace lacerta

#endif  // LACERTA_DECODER_SILENT_LEVEL_H_
