// Writing a refinement with quality layers. Twin: decoder/layer_decoder.h.
#ifndef LACERTA_ENCODER_LAYER_WRITER_H_
#define LACERTA_ENCODER_LAYER_WRITER_H_

#include <vector>

#include "common/stream_layout.h"
#include "encoder/layer_split.h"
#include "encoder/stream_writer.h"
#include "encoder/surface_target.h"
#include "lacerta/mesh.h"
#include "lacerta/status.h"

namespace lacerta {

// A segment and the values that it brings a level to.
struct LayerValues {
  LayerSegment segment;
  QuantizedLevel values;  // on the shifted steps
};

// The segments of layers of SplitIntoLayers: layer by layer, in a layer those first that bring the surface nearest to the target per bit,
// as far as levels may begin. One after which the surface would be no nearer than before waits for the next.
std::vector<LayerValues> OrderSegments(const SurfaceTarget& target, const std::vector<QualityLayer>& layers);

// Writes a refinement with quality layers. steps, levels: of the last layer; other arguments as of WriteRefinement.
//   segments  shifts of a level fall, down to 0; the first one of a level comes after the first ones of coarser levels that are not
//             silent; the last one does not wait
// Parts of the result are the states of a decoder, the first with the header. Fails as WriteRefinement does, and with kInvalidArgument
// where the segments break these rules or do not end with `levels`.
StatusOr<RefinementBytes> WriteLayers(const BaseMesh& base, Span<const Topology> topologies, const std::vector<LevelSteps>& steps,
                                      const std::vector<QuantizedLevel>& levels, const std::vector<LayerValues>& segments,
                                      const BaseTags& tags, BaseStepField base_step);

}  // namespace lacerta

#endif  // LACERTA_ENCODER_LAYER_WRITER_H_
