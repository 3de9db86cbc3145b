// Writing a refinement with quality layers. Twin: decoder/layer_decoder.h.
#ifndef LACERTA_ENCODER_LAYER_WRITER_H_
#define LACERTA_ENCODER_LAYER_WRITER_H_

#include <vector>

#include "encoder/layer_split.h"
#include "encoder/stream_writer.h"
#include "encoder/surface_target.h"
#include "lacerta/mesh.h"
#include "lacerta/status.h"

namespace lacerta {

// Writes layers of SplitIntoLayers: layer by layer, levels coarse to fine. A segment after which the surface would be no nearer to the
// target is left to be shown with the next one. Parts of the result are what is shown at a time: the first with the header, and one per
// state of a decoder. Fails as WriteRefinement does.
StatusOr<RefinementBytes> WriteLayers(const SurfaceTarget& target, const std::vector<QualityLayer>& layers, const BaseTags& tags,
                                      BaseStepField base_step);

}  // namespace lacerta

#endif  // LACERTA_ENCODER_LAYER_WRITER_H_
