// Which morph targets an asset shows at once, and how far.
#ifndef LACERTA_PACK_TARGET_MIXES_H_
#define LACERTA_PACK_TARGET_MIXES_H_

#include <cstdint>
#include <vector>

#include "document/animation.h"
#include "document/gltf_document.h"
#include "pack/source.h"

namespace lacerta {

using TargetMix = std::vector<float>;  // the weight of every target

// At most four of the mixes that meshes and nodes have by themselves and in animations (up to 16 keyframes of each track, evenly spaced), which
// differ most: the one of the largest weights first, then always the one that is farthest from all before. Those of a single target with a weight of at
// most 1 are none, for that is looked at anyway. tracks: ReadWeightTracks of the document. sources: of the meshes in question, all with targets
// as many as `num_targets` or with none.
std::vector<TargetMix> FindTargetMixes(const GltfDocument& document, const std::vector<WeightTrack>& tracks, const std::vector<const Source*>& sources,
                                       size_t num_targets);

}  // namespace lacerta

#endif  // LACERTA_PACK_TARGET_MIXES_H_
