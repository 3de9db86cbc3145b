#include "pack/texel_scale.h"

#include <algorithm>
#include <cmath>

#include "document/image_size.h"
#include "document/materials.h"

namespace lacerta {
namespace {

// The largest scale of `set` in any textureInfo of a material.
double LargestScale(const Json& material, uint64_t set) {
  double largest = 1.0;
  VisitTextures(material, "", [&](const std::string&, const Json& texture) {
    const Json* transform = FindExtension(texture, "KHR_texture_transform");
    if (transform == nullptr || TexCoordOf(texture) != set) return;
    for (uint64_t axis = 0; axis < 2; ++axis) {
      largest = std::max(largest, std::abs(AsNumber(FindElement(*transform, "scale", axis)).value_or(1.0)));
    }
  });
  return largest;
}

}  // namespace

uint64_t TexelSide(const GltfDocument& document) {
  constexpr uint64_t kLeastSide = 1024;
  return std::max(LargestImageSide(document), kLeastSide);
}

double TexelsPerUnit(const GltfDocument& document, const std::vector<Place>& places, uint64_t set, uint64_t side) {
  constexpr double kMostRepeats = 1e4;  // an absurd transform shall not ask for absurd bits
  double scale = 1.0;
  for (const Json* material : MaterialsOf(document, places)) scale = std::max(scale, LargestScale(*material, set));
  return std::min(scale, kMostRepeats) * static_cast<double>(side);
}

}  // namespace lacerta
