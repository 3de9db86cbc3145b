// From quantized coefficients to positions. The encoder calls this too, to see what will be decoded.
#ifndef LACERTA_DECODER_SYNTHESIS_H_
#define LACERTA_DECODER_SYNTHESIS_H_

#include <vector>

#include "common/butterfly.h"
#include "common/coefficient_sets.h"
#include "common/subdivision.h"
#include "lacerta/mesh.h"

namespace lacerta {

// Appends the positions of the new vertices of one level, one per edge of `coarse`: butterfly prediction, on curved levels moved onto
// curves, plus the dequantized detail in the local frame of the butterfly's midpoint. A copy (Topology::is_copy) gets the position of its master.
//   coarse     level i
//   table      stencils of the base mesh or of `coarse`: subdivision makes no new extraordinary vertices
//   quantized  shapes as in QuantizedLevel, or empty on a silent level; steps: its quantization
//   positions  #V of `coarse` on entry, #V + #E on return, model units
void SynthesizeLevel(const Topology& coarse, const StencilTable& table, const LevelSteps& steps,
                     const QuantizedLevel& quantized, std::vector<Vec3f>* positions);

// The second half of that: moves the butterfly's midpoints, the last #E of `positions`, to where curves and coefficients want them. Nothing to do on
// a silent level that is not curved.
void AddDetails(const Topology& coarse, const LevelSteps& steps, const QuantizedLevel& quantized, std::vector<Vec3f>* positions);

// Whether no coordinate is infinite or no number.
bool AreFinite(Span<const Vec3f> positions);

}  // namespace lacerta

#endif  // LACERTA_DECODER_SYNTHESIS_H_
