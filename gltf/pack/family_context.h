// A family of primitives in a scene, and what was asked for.
#ifndef LACERTA_PACK_FAMILY_CONTEXT_H_
#define LACERTA_PACK_FAMILY_CONTEXT_H_

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "document/primitive.h"
#include "lacerta/gltf.h"
#include "lacerta/status.h"
#include "pack/attributed_family.h"
#include "pack/packed_scene.h"
#include "pack/skin.h"
#include "pack/target_mixes.h"

namespace lacerta {

// The quality that a target asks for, dB; 70 where it is one in bytes, which says nothing about the precision of Draco primitives.
double TargetPsnr(const EncodeTarget& target);

struct FamilyContext {
  const PackedScene* scene = nullptr;
  const PackOptions* options = nullptr;
  size_t family = 0;

  const std::vector<size_t>& members() const { return scene->families.families[family].members; }
  double Error() const { return FamilyError(scene->families, family, TargetPsnr(options->encode.target)); }  // mesh units
  std::vector<const Primitive*> Primitives() const;
  std::vector<const Source*> Sources() const;
  bool HasTargets() const;  // of morphs
  std::vector<const std::vector<MorphTarget>*> Targets() const;  // of each member
  std::vector<TargetMix> Mixes() const;  // that the asset shows
  bool MayRoundTargets() const { return options->fallback == Fallback::kDraco && !options->float_targets; }
  StatusOr<std::optional<Skin>> FindSkin() const;  // what moves the family; empty where nothing does
  TexelScale Scale() const;
  uint64_t BytesBefore() const;    // of all members' data, as often as the asset holds it, but for what stays whatever becomes of them
  uint64_t DracoJsonBytes() const;  // about what JSON KHR_draco_mesh_compression takes at all places that show the family
  uint64_t ProgressiveJsonBytes() const;  // the same of LACERTA_mesh_progressive beside it
};

}  // namespace lacerta

#endif  // LACERTA_PACK_FAMILY_CONTEXT_H_
