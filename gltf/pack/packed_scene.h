// An asset as its packer sees it, whatever the target: its primitives, which of them touch, what moves them.
#ifndef LACERTA_PACK_PACKED_SCENE_H_
#define LACERTA_PACK_PACKED_SCENE_H_

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "document/animation.h"
#include "document/gltf_document.h"
#include "document/scene_poses.h"
#include "lacerta/status.h"
#include "pack/family.h"
#include "pack/source.h"

namespace lacerta {

struct PackedScene {
  static constexpr size_t kNone = ~size_t{0};

  const GltfDocument* document = nullptr;
  std::vector<Source> sources;
  std::vector<size_t> family_of;  // parallel to `sources`; kNone where there is no primitive
  Families families;              // their members are indices into `sources`
  uint64_t texel_side = 1024;
  std::vector<ScenePose> poses;  // where there are skins
  std::vector<WeightTrack> weight_tracks;  // where there are morph targets
};

// Refers to the document. dropped: as for ReadSources. Fails like ReadSources and FindFamilies.
StatusOr<PackedScene> ReadPackedScene(const GltfDocument& document, const DroppedAttributes& dropped);

}  // namespace lacerta

#endif  // LACERTA_PACK_PACKED_SCENE_H_
