// In place of draco_ext/decoder/silent_level.cc: the same positions in fewer bytes of code. Tables take little time where memory is kept, as it is here.
#include "decoder/silent_level.h"

namespace lacerta {

void PredictRefinedMidpoints(const Topology& t, const StencilTable& table, std::vector<Vec3f>* positions) { PredictMidpoints(Refine(t), table, positions); }

}  // namespace lacerta
