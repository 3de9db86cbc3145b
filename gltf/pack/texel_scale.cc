#include "pack/texel_scale.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "document/image_size.h"
#include "document/materials.h"
#include "geometry/bounding_box.h"
#include "pack/unused_attributes.h"

namespace lacerta {
namespace {

constexpr const char* kTexCoord = "TEXCOORD_";

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

// How often a texture is repeated along a unit of `set`, at the most.
double RepeatsPerUnit(const GltfDocument& document, const std::vector<Place>& places, uint64_t set) {
  constexpr double kMostRepeats = 1e4;  // an absurd transform shall not ask for absurd bits
  double scale = 1.0;
  for (const Json* material : MaterialsOf(document, places)) scale = std::max(scale, LargestScale(*material, set));
  return std::min(scale, kMostRepeats);
}

// The same of a set that no texture is laid by.
double RepeatsPerUnitUnseen(const std::vector<PlacedPrimitive>& members, const std::string& name) {
  constexpr double kMostRepeats = 4.0, kLeastPerUnit = 1e-6;
  BoundingBox box;  // of all values, in x and y
  for (const PlacedPrimitive& member : members) {
    const Attribute* attribute = member.primitive->Find(name);
    if (attribute == nullptr || attribute->data.components != 2) continue;
    for (uint64_t v = 0; v < attribute->data.count; ++v) Extend(Vec3f{attribute->data.Float(v, 0), attribute->data.Float(v, 1), 0.0f}, &box);
  }
  const Vec3d sides = Vec3Cast<double>(box.high) - Vec3Cast<double>(box.low);
  const double extent = std::max(sides.x, sides.y);
  return extent > kMostRepeats ? std::max(kMostRepeats / extent, kLeastPerUnit) : 1.0;
}

}  // namespace

uint64_t SetOfTexCoord(const std::string& name) { return std::strtoull(name.c_str() + std::strlen(kTexCoord), nullptr, 10); }

uint64_t TexelSide(const GltfDocument& document) {
  constexpr uint64_t kLeastSide = 1024;
  return std::max(LargestImageSide(document), kLeastSide);
}

TexelScale TexelScaleOf(const GltfDocument& document, const std::vector<PlacedPrimitive>& members, uint64_t side) {
  std::set<std::string> names;
  for (const PlacedPrimitive& member : members) {
    for (const Attribute& attribute : member.primitive->attributes) {
      if (attribute.name.rfind(kTexCoord, 0) == 0) names.insert(attribute.name);
    }
  }
  std::map<std::pair<size_t, uint64_t>, double> repeats;
  for (const std::string& name : names) {
    const uint64_t set = SetOfTexCoord(name);
    const bool is_seen = std::any_of(members.begin(), members.end(), [&](const PlacedPrimitive& member) { return !IsUnused(document, *member.places, name); });
    const double unseen = is_seen ? 1.0 : RepeatsPerUnitUnseen(members, name);
    for (size_t m = 0; m < members.size(); ++m) repeats[{m, set}] = is_seen ? RepeatsPerUnit(document, *members[m].places, set) : unseen;
  }
  return [repeats = std::move(repeats), side = static_cast<double>(side)](size_t member, uint64_t set) {
    const auto found = repeats.find({member, set});
    return found == repeats.end() ? side : found->second * side;
  };
}

}  // namespace lacerta
