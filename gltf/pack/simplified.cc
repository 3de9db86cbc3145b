#include "pack/simplified.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "lacerta/surface_distance.h"
#include "pack/attributed_family.h"
#include "pack/influence_slots.h"
#include "pack/skin_transfer.h"
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

// JOINTS_0 in the type of the original's where it holds all joints.
Status AddSkin(const VertexSoup& soup, const Primitive& original, const SkinTransfer::ByVertex& by_vertex, Primitive* primitive) {
  const auto poses = std::find_if(soup.attributes.begin(), soup.attributes.end(),
                                  [](const VertexSoup::Attribute& attribute) { return attribute.name == kPosesName; });
  if (poses == soup.attributes.end()) return InternalError("the simplified surface has lost its poses");
  AccessorData joints = original.Find("JOINTS_0")->data;
  joints.count = soup.positions.size();
  joints.bytes.clear();
  std::vector<float> weights;
  for (size_t v = 0; v < soup.positions.size(); ++v) {
    const auto found = by_vertex.find(SkinTransfer::KeyOf(soup.positions[v], &poses->values[v * poses->components], poses->components / 3));
    if (found == by_vertex.end()) return InternalError("a vertex of the simplified surface has lost its joints");
    for (size_t c = 0; c < joints.components; ++c) {
      const Influence influence = c < found->second.size() ? found->second[c] : Influence{};
      weights.push_back(influence.weight);
      for (size_t byte = 0; byte < ComponentSize(joints.type); ++byte) joints.bytes.push_back(static_cast<uint8_t>(influence.joint >> (8 * byte)));
    }
  }
  primitive->attributes.push_back({"JOINTS_0", std::move(joints)});
  primitive->attributes.push_back({"WEIGHTS_0", MakeFloatAccessor(weights, 4)});
  return Status();
}

StatusOr<Primitive> ToPrimitive(const VertexSoup& soup, const Primitive& original, size_t member,
                                const FamilyMeter& meter, const SkinTransfer::ByVertex& by_vertex) {
  if (soup.triangles.empty()) return Unsupported("would have no triangle left");
  Primitive primitive;
  primitive.num_vertices = soup.positions.size();
  primitive.triangles = soup.triangles;
  for (const Attribute& attribute : original.attributes) {
    if (attribute.name == "POSITION") {
      primitive.attributes.push_back({attribute.name, MakeFloatAccessor(soup.positions)});
      continue;
    }
    if (meter.skin() != nullptr && IsSkinAttribute(attribute.name)) continue;
    const std::string name = SoupName(attribute, member, meter.texels_per_unit());
    const auto found =
        std::find_if(soup.attributes.begin(), soup.attributes.end(), [&](const VertexSoup::Attribute& candidate) {
          return candidate.name == name && candidate.components == attribute.data.components;
        });
    if (found == soup.attributes.end()) return InternalError("the simplified surface has lost " + attribute.name);
    primitive.attributes.push_back(
        {attribute.name, ToTypeOf(attribute.data, MakeFloatAccessor(found->values, found->components))});
  }
  if (meter.skin() != nullptr) LACERTA_RETURN_IF_ERROR(AddSkin(soup, original, by_vertex, &primitive));
  return primitive;
}

StatusOr<std::vector<Primitive>> Split(const AttributedMesh& mesh, const FamilyMeter& meter, const SkinTransfer::ByVertex& by_vertex) {
  const std::vector<const Primitive*>& originals = meter.primitives();
  const std::vector<VertexSoup> soups = SplitIntoSoups(mesh, static_cast<uint32_t>(originals.size()));
  std::vector<Primitive> primitives;
  for (size_t m = 0; m < soups.size(); ++m) {
    LACERTA_ASSIGN_OR_RETURN(Primitive primitive, ToPrimitive(soups[m], *originals[m], m, meter, by_vertex));
    primitives.push_back(std::move(primitive));
  }
  std::vector<Primitive*> pointers;
  pointers.reserve(primitives.size());
  for (Primitive& primitive : primitives) pointers.push_back(&primitive);
  ArrangeInfluences(std::move(pointers));
  return primitives;
}

// The search compares poses point by point, which mostly tells more than how far the surfaces are apart. That is measured, and where it is too much after all
// the search is run again with the bound that follows.
StatusOr<SimplifiedFamily> SimplifyInPoses(const FamilyMeter& meter, ErrorTargets targets) {
  constexpr double kLeast = 0.4, kMargin = 0.97;
  constexpr int kMostTries = 2;
  LACERTA_ASSIGN_OR_RETURN(const SkinTransfer transfer, SkinTransfer::Create(meter));
  SimplifyToErrorsOptions options;
  options.finish = [&](AttributedMesh* mesh) { transfer.Transfer(mesh); };
  const size_t poses = *meter.IndexOf(kPosesName);
  const double wanted = targets.attributes[poses];
  for (int i = 0; i < kMostTries; ++i) {
    LACERTA_ASSIGN_OR_RETURN(SimplifiedSurface simplified, SimplifyToErrors(meter.simplifiable(), meter.meter(), targets, options));
    if (!simplified.meets_targets) break;
    const SkinTransfer::ByVertex by_vertex = transfer.Transfer(&simplified.mesh);
    LACERTA_ASSIGN_OR_RETURN(std::vector<Primitive> primitives, Split(simplified.mesh, meter, by_vertex));
    LACERTA_ASSIGN_OR_RETURN(const double worst, meter.WorstPose(PointersTo(primitives)));
    AttributeError& error = simplified.errors.attributes[poses];
    error.rms = error.rms_99 = worst;
    if (worst <= wanted) return SimplifiedFamily{std::move(primitives), std::move(simplified.errors)};
    const double finer = std::max(kMargin * wanted / worst, kLeast);
    targets.attributes[poses] *= finer;
    targets.everywhere[poses] *= finer;
  }
  return Unsupported("no simplified surface is close enough in all poses of its skin");
}

// share: of every target; what rounding adds comes on top in squares.
StatusOr<SimplifiedFamily> SimplifyPrimitives(const FamilyMeter& meter, const std::vector<double>& everywhere, double share) {
  ErrorTargets targets = meter.TargetsWith(everywhere);
  targets.distance *= share;
  targets.turned *= share;
  for (double& target : targets.attributes) target *= share;
  for (double& target : targets.everywhere) target *= share;
  if (meter.skin() != nullptr) return SimplifyInPoses(meter, std::move(targets));
  LACERTA_ASSIGN_OR_RETURN(SimplifiedSurface simplified, SimplifyToErrors(meter.simplifiable(), meter.meter(), targets));
  // Where attributes decide, a shape kept closer costs nothing, and collapses that spare it spare the attributes.
  constexpr double kIdle = 0.5, kRoom = 1.1;  // of the distance allowed; over what was taken of it
  constexpr double kLoose = 69.9;             // dB: for finer targets a second search is seldom worth its time
  const bool is_loose = Psnr(meter.error(), meter.meter().diagonal()) < kLoose;
  if (simplified.meets_targets && is_loose && simplified.errors.distance < kIdle * targets.distance) {
    targets.distance = kRoom * simplified.errors.distance;
    StatusOr<SimplifiedSurface> closer = SimplifyToErrors(meter.simplifiable(), meter.meter(), targets);
    const bool is_better = closer.ok() && closer.value().meets_targets &&
                           closer.value().mesh.surface.triangles.size() < simplified.mesh.surface.triangles.size();
    if (is_better) simplified = std::move(closer).value();
  }
  if (!simplified.meets_targets) return Unsupported("no simplified surface is close enough");
  LACERTA_ASSIGN_OR_RETURN(std::vector<Primitive> primitives, Split(simplified.mesh, meter, {}));
  return SimplifiedFamily{std::move(primitives), std::move(simplified.errors)};
}

uint64_t BytesOf(const RoundedFamily& family) {
  uint64_t bytes = 0;
  for (const DracoEncoded& member : family.members) bytes += member.bytes.size();
  return bytes;
}

}  // namespace

StatusOr<RoundedFamily> SimplifyAndRound(const FamilyMeter& meter, const std::vector<double>& everywhere,
                                         const std::function<StatusOr<RoundedFamily>(SimplifiedFamily)>& round) {
  LACERTA_RETURN_IF_ERROR(meter.status());
  if (meter.leaves_out()) {
    // Names the attribute.
    return ToAttributedMesh(meter.primitives(), meter.texels_per_unit(), OtherAttributes::kRefuse, meter.skin(), meter.custom()).status();
  }
  StatusOr<RoundedFamily> rounded = Unsupported("");
  for (const double share : {0.85, 0.7, 0.5}) {  // of every target to simplification
    LACERTA_ASSIGN_OR_RETURN(SimplifiedFamily simplified, SimplifyPrimitives(meter, everywhere, share));
    rounded = round(std::move(simplified));
    if (rounded.ok() || rounded.status().code() != StatusCode::kUnsupported) break;
  }
  return rounded;
}

StatusOr<RoundedFamily> SimplifyFamily(const FamilyMeter& meter, const std::vector<double>& everywhere, Effort effort) {
  const auto round = [&](const SimplifiedFamily& simplified) {
    return RoundFamily(PointersTo(simplified.primitives), meter, &simplified.errors, everywhere);
  };
  StatusOr<RoundedFamily> best = SimplifyAndRound(meter, everywhere, round);
  if (!best.ok() || effort != Effort::kBest) return best;
  for (const double share : {0.75, 0.93}) {  // of every target, beside the usual one
    const StatusOr<SimplifiedFamily> simplified = SimplifyPrimitives(meter, everywhere, share);
    if (!simplified.ok()) continue;
    StatusOr<RoundedFamily> other = round(simplified.value());
    if (other.ok() && BytesOf(other.value()) < BytesOf(best.value())) best = std::move(other);
  }
  return best;
}

}  // namespace lacerta
