#include "pack/simplified.h"

#include <algorithm>
#include <string>
#include <utility>

#include "pack/attributed_family.h"
#include "remesh/simplify_to_errors.h"

namespace lacerta {
namespace {

// Back to the integers that a color came as: unsigned and normalized are all that glTF allows.
AccessorData ToTypeOf(const AccessorData& original, AccessorData floats) {
  if (original.type == ComponentType::kFloat) return floats;
  const size_t size = ComponentSize(original.type);
  const double scale = size == 1 ? 255.0 : 65535.0;
  AccessorData data = floats;
  data.type = original.type;
  data.normalized = original.normalized;
  data.bytes.clear();
  for (uint64_t i = 0; i < floats.count * floats.components; ++i) {
    const float value = floats.Float(i / floats.components, static_cast<uint32_t>(i % floats.components));
    const auto k = static_cast<uint32_t>(std::clamp(value * scale + 0.5, 0.0, scale));
    for (size_t byte = 0; byte < size; ++byte) data.bytes.push_back(static_cast<uint8_t>(k >> (8 * byte)));
  }
  return data;
}

StatusOr<Primitive> ToPrimitive(const VertexSoup& soup, const Primitive& original, size_t member,
                                const TexelScale& scale) {
  if (soup.triangles.empty()) return Unsupported("would have no triangle left");
  Primitive primitive;
  primitive.num_vertices = soup.positions.size();
  primitive.triangles = soup.triangles;
  for (const Attribute& attribute : original.attributes) {
    if (attribute.name == "POSITION") {
      primitive.attributes.push_back({attribute.name, MakeFloatAccessor(soup.positions)});
      continue;
    }
    const std::string name = SoupName(attribute, member, scale);
    const auto found =
        std::find_if(soup.attributes.begin(), soup.attributes.end(), [&](const VertexSoup::Attribute& candidate) {
          return candidate.name == name && candidate.components == attribute.data.components;
        });
    if (found == soup.attributes.end()) return InternalError("the simplified surface has lost " + attribute.name);
    primitive.attributes.push_back(
        {attribute.name, ToTypeOf(attribute.data, MakeFloatAccessor(found->values, found->components))});
  }
  return primitive;
}

StatusOr<std::vector<Primitive>> Split(const AttributedMesh& mesh, const FamilyMeter& meter) {
  const std::vector<const Primitive*>& originals = meter.primitives();
  const std::vector<VertexSoup> soups = SplitIntoSoups(mesh, static_cast<uint32_t>(originals.size()));
  std::vector<Primitive> primitives;
  for (size_t m = 0; m < soups.size(); ++m) {
    LACERTA_ASSIGN_OR_RETURN(Primitive primitive, ToPrimitive(soups[m], *originals[m], m, meter.texels_per_unit()));
    primitives.push_back(std::move(primitive));
  }
  return primitives;
}

}  // namespace

StatusOr<RoundedFamily> SimplifyFamily(const FamilyMeter& meter, const std::vector<double>& everywhere) {
  constexpr double kShare = 0.85;  // of every target to simplification: what rounding adds comes on top in squares
  LACERTA_RETURN_IF_ERROR(meter.status());
  if (meter.leaves_out()) {
    // Names the attribute.
    return ToAttributedMesh(meter.primitives(), meter.texels_per_unit(), OtherAttributes::kRefuse).status();
  }
  ErrorTargets targets = meter.targets();
  targets.everywhere = everywhere;
  targets.distance *= kShare;
  targets.turned *= kShare;
  for (double& target : targets.attributes) target *= kShare;
  for (double& target : targets.everywhere) target *= kShare;
  LACERTA_ASSIGN_OR_RETURN(const SimplifiedSurface simplified, SimplifyToErrors(meter.original(), meter.meter(), targets));
  if (!simplified.meets_targets) return Unsupported("no simplified surface is close enough");
  LACERTA_ASSIGN_OR_RETURN(const std::vector<Primitive> primitives, Split(simplified.mesh, meter));
  std::vector<const Primitive*> pointers;
  for (const Primitive& primitive : primitives) pointers.push_back(&primitive);
  return RoundFamily(pointers, meter, &simplified.errors, everywhere);
}

}  // namespace lacerta
