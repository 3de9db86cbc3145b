// Which skin moves a family of primitives, and in which poses that is looked at.
#ifndef LACERTA_PACK_FIND_SKIN_H_
#define LACERTA_PACK_FIND_SKIN_H_

#include <optional>
#include <vector>

#include "document/gltf_document.h"
#include "document/scene_poses.h"
#include "lacerta/status.h"
#include "pack/skin.h"
#include "pack/source.h"

namespace lacerta {

// The skin of sources that belong together, with those of the scene's poses in which they differ most in shape. Where nodes show all of
// them by several skins, the poses are those of any of these, and the joints those that all of these have. Fails with kUnsupported, and
// the reason, where not all sources have the same, or one cannot be used.
StatusOr<Skin> FindSkin(const GltfDocument& document, const std::vector<const Source*>& sources,
                        const std::vector<ScenePose>& poses);

// Where a skin puts what it moves, mesh to world, in a pose: the transform of the joint whose scale is the median. Empty where that is
// not known or shrinks it to nothing.
std::optional<Transform> PlacementBySkin(const GltfDocument& document, uint64_t skin, const ScenePose& pose);

}  // namespace lacerta

#endif  // LACERTA_PACK_FIND_SKIN_H_
