// Which surfaces of an asset touch and thus have to stay joined, and how far off they may be.
#ifndef LACERTA_PACK_FAMILY_H_
#define LACERTA_PACK_FAMILY_H_

#include <cstdint>
#include <vector>

#include "document/gltf_document.h"
#include "document/place.h"
#include "lacerta/codec.h"
#include "lacerta/mesh.h"
#include "lacerta/status.h"

namespace lacerta {

// A surface and where it is shown.
struct PlacedSurface {
  const std::vector<Place>* places = nullptr;
  TriangleMesh surface;
};

// Surfaces of one mesh, of meshes that have a vertex position in common and stand in the world alike (in the default
// scene, by equal transforms), and of meshes that share a surface.
struct Family {
  std::vector<size_t> members;  // indices into the surfaces
  uint64_t num_meshes = 0;
  double diagonal = 0.0;        // of their common box, mesh units
  double stretch = 1.0;         // from mesh units to world units where it is largest
  bool in_scene = false;        // the default scene shows it
  // What an error of 1 mesh unit (RMS over the surface), squared, adds up to over all that the default scene shows of the family, world
  // units to the fourth power; of what it does not show, as if it were as large as the scene.
  double weight = 0.0;
};

struct Families {
  std::vector<Family> families;
  std::vector<size_t> of_surface;  // parallel to the surfaces
  double scene_diagonal = 0.0;     // of all that the default scene shows, world units; 0 where it shows nothing
};

// Fails like CollectInstances.
StatusOr<Families> FindFamilies(const GltfDocument& document, const std::vector<PlacedSurface>& surfaces);

// The error in mesh units that a target for the whole scene leaves to a family: an error relative to the diagonal of the
// scene, divided by the stretch of the family; but a hundredth of the family's own diagonal at most, unless less than
// 40 dB were asked for, so that what is small in the scene keeps its shape. `psnr` in dB.
double FamilyError(const Families& families, size_t family, double psnr);

}  // namespace lacerta

#endif  // LACERTA_PACK_FAMILY_H_
