// How far the attributes of one surface are from those of another, measured over the area of both.
//
// A sample on one surface is held to the closest point of the other in the same group of faces, of faces that look the same way where
// there are such. Where seams come near, that point may lie just across: so of all sides of the seams within a small distance, each
// with its closest point, the one counts whose value is nearest.
#ifndef LACERTA_ATTRIBUTE_DISTANCE_H_
#define LACERTA_ATTRIBUTE_DISTANCE_H_

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "lacerta/attributed_mesh.h"
#include "lacerta/status.h"

namespace lacerta {

struct AttributeDistanceOptions {
  uint64_t num_samples = 100'000;  // on each of the two surfaces, spread evenly over the area: 1 to 1e9
  uint32_t seed = 0;               // picks another set of samples
  double texture_size = 1024;      // texels along a texture coordinate from 0 to 1
  // How much farther than the closest point another side of a seam may be, relative to the diagonal of the original: about three
  // times the distance of surfaces that are 70 dB apart.
  double seam_distance = 1e-3;
};

// Texture coordinates in texels, normals and tangents in degrees (a tangent of the other sign: 180), all others in their own units
// as the length of the difference vector.
struct AttributeError {
  double rms_99 = 0;  // over the 99 % of the area where it is least
  double rms = 0;
  double max = 0;    // over the samples
  double share = 0;  // of the surface's area that has the attribute; the figures above are over that
};

struct AttributeDistance {
  // For each attribute of the original, in their order: from the original to the other surface, and from there to the original.
  std::vector<AttributeError> forward, backward;
  // Share of the area of the original, and of the other surface, near which all faces of the other one look away.
  double forward_turned = 0, backward_turned = 0;
  // Share of the area over which the back of a thin sheet, which looks away, is upon its front or before it on the other surface: less than a
  // tenth of the thickness is left. Of sheets that are thicker than 1e-5 diagonals, and thinner than seam_distance.
  double forward_swapped = 0, backward_swapped = 0;
  // RMS of the distance to the closest point of the same group, model units. Where there is one group, that of SurfaceDistanceMeter by as many samples.
  double forward_distance = 0, backward_distance = 0;

  AttributeError Worst(size_t attribute) const;  // of the two directions, figure by figure
};

// Measures many surfaces against one original. The result depends on meshes and options alone, not on the number of threads. Copies share
// what was prepared of the original.
class AttributeDistanceMeter {
 public:
  // Copies the original. Fails with kInvalidData where CheckAttributedMesh does, where there is no area, or a coordinate is beyond 1e18.
  static StatusOr<AttributeDistanceMeter> Create(AttributedMesh original);

  // The same for surfaces whose attributes go by other names; names: one for each attribute of the original.
  AttributeDistanceMeter WithNames(std::vector<std::string> names) const;

  // mesh: has the same attributes (name, kind, components) in the same order, else kInvalidArgument; kInvalidData as in Create and
  // where only one of the two surfaces has area in some group.
  StatusOr<AttributeDistance> Measure(const AttributedMesh& mesh, const AttributeDistanceOptions& options = {}) const;

 private:
  struct Original;
  AttributeDistanceMeter(std::shared_ptr<const Original> original, std::vector<std::string> names);

  std::shared_ptr<const Original> original_;
  std::vector<std::string> names_;  // of the attributes
};

}  // namespace lacerta

#endif  // LACERTA_ATTRIBUTE_DISTANCE_H_
