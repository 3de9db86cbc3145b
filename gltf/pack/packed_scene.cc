#include "pack/packed_scene.h"

#include <algorithm>
#include <utility>

#include "pack/influence_slots.h"
#include "pack/texel_scale.h"

namespace lacerta {

StatusOr<PackedScene> ReadPackedScene(const GltfDocument& document, const DroppedAttributes& dropped) {
  PackedScene scene;
  scene.document = &document;
  scene.texel_side = TexelSide(document);
  if (ArraySize(document.json, "skins") > 0) scene.poses = ScenePoses(document);
  LACERTA_ASSIGN_OR_RETURN(scene.sources, ReadSources(document, dropped));
  const bool has_targets = std::any_of(scene.sources.begin(), scene.sources.end(), [](const Source& source) { return !source.targets.empty(); });
  if (has_targets) scene.weight_tracks = ReadWeightTracks(document);
  std::vector<PlacedSurface> surfaces;
  std::vector<size_t> source_of;
  for (size_t i = 0; i < scene.sources.size(); ++i) {
    if (!scene.sources[i].primitive.has_value()) continue;
    surfaces.push_back({&scene.sources[i].places, Surface(*scene.sources[i].primitive)});
    source_of.push_back(i);
  }
  LACERTA_ASSIGN_OR_RETURN(scene.families, FindFamilies(document, surfaces));
  scene.family_of.assign(scene.sources.size(), PackedScene::kNone);
  for (size_t s = 0; s < surfaces.size(); ++s) scene.family_of[source_of[s]] = scene.families.of_surface[s];
  for (Family& family : scene.families.families) {
    std::vector<Primitive*> primitives;
    for (size_t& member : family.members) {
      member = source_of[member];
      primitives.push_back(&*scene.sources[member].primitive);
    }
    ArrangeInfluences(std::move(primitives));
  }
  return scene;
}

}  // namespace lacerta
