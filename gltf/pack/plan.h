// What becomes of every primitive of an asset, decided before anything is changed.
#ifndef LACERTA_PACK_PLAN_H_
#define LACERTA_PACK_PLAN_H_

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "document/draco_encode.h"
#include "document/gltf_document.h"
#include "document/place.h"
#include "document/primitive.h"
#include "lacerta/gltf.h"
#include "pack/family_stream.h"
#include "pack/source.h"

namespace lacerta {

// Primitives that show the same surface are stored once.
struct PrimitivePlan {
  std::vector<Place> places;      // at least one
  std::vector<Place> geometries;  // as in Source
  PrimitiveReport report;         // of the first place
  double weight = 0.0;            // of its family
  bool smooth_normals = false;    // NORMAL was dropped, readers derive it
  std::optional<EncodedMesh> progressive;
  // The stream of the family, shared by its members, and which group of it this is.
  std::shared_ptr<const FamilyStream> family;
  size_t group = 0;
  std::optional<DracoEncoded> draco;
  std::vector<MorphTarget> targets;  // in the order of the vertices of `draco`
};

// Makes a stream of the shape alone the plan. target: what it was encoded for, not a share of a scene.
void TakeStream(EncodedMesh encoded, const EncodeTarget& target, PrimitivePlan* plan);

// Whether a stream of the shape alone is stock Draco, with nothing to refine and nothing to tell that Draco does not, and is not asked for as a stream.
bool IsAllInDraco(const EncodedMesh& encoded, bool smooth_normals, const PackOptions& options);
// Makes such a stream what stock Draco is: its description would be a sixth of a small file. Others stay.
Status TakeAsDracoIfThatIsAll(const PackOptions& options, PrimitivePlan* plan);

// Reads and encodes all primitives. Fails like PackGltf.
StatusOr<std::vector<PrimitivePlan>> PlanPrimitives(const GltfDocument& document, const PackOptions& options);

}  // namespace lacerta

#endif  // LACERTA_PACK_PLAN_H_
