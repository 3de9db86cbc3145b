#include "pack/simplified.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "document/lattice.h"
#include "pack/attributed_family.h"
#include "pack/precision.h"
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

// How much of every target is left to rounding once simplification has had its share: errors add up in squares.
struct Rest {
  double distance = 1.0;
  AttributeTargets attributes;  // shares here, not errors
};

double RestOf(double error, double target) {
  constexpr double kLeast = 0.25;
  constexpr double kMost = 0.9;
  const double ratio = std::min(error / target, 1.0);
  return std::clamp(0.95 * std::sqrt(1.0 - ratio * ratio), kLeast, kMost);
}

double* ShareOf(const MeshAttribute& attribute, Rest* rest) {
  switch (attribute.kind) {
    case AttributeKind::kTextureCoordinates:
      return &rest->attributes.uv_texels;
    case AttributeKind::kNormal:
    case AttributeKind::kTangent:
      return &rest->attributes.normal_degrees;
    default:
      return &rest->attributes.color;
  }
}

uint64_t SizeOf(const SimplifiedFamily& family) {
  uint64_t size = 0;
  for (const DracoEncoded& member : family.members) size += member.bytes.size();
  return size;
}

class FamilySimplifier {
 public:
  FamilySimplifier(const std::vector<const Primitive*>& primitives, const AttributedMesh& original,
                   const SurfaceErrorMeter& meter, ErrorTargets error_targets, const AttributeTargets& targets,
                   const TexelScale& texels_per_unit)
      : primitives_(primitives), original_(original), meter_(meter), error_targets_(std::move(error_targets)),
        targets_(targets), texels_per_unit_(texels_per_unit) {}

  // `share` of every target goes to simplification.
  StatusOr<SimplifiedFamily> Run(double share) const {
    constexpr int kMostRounds = 6;
    ErrorTargets targets = error_targets_;
    targets.distance *= share;
    for (double& target : targets.attributes) target *= share;
    for (double& target : targets.everywhere) target *= share;
    targets.turned *= share;
    LACERTA_ASSIGN_OR_RETURN(const SimplifiedSurface simplified, SimplifyToErrors(original_, meter_, targets));
    if (!simplified.meets_targets) return Unsupported("no simplified surface is close enough");
    LACERTA_ASSIGN_OR_RETURN(const std::vector<Primitive> primitives, Split(simplified.mesh));
    Rest rest;
    rest.distance = RestOf(simplified.errors.distance, error_targets_.distance);
    rest.attributes = {1.0, 1.0, 1.0, 1.0, false};
    for (size_t a = 0; a < original_.attributes.size(); ++a) {
      double* own = ShareOf(original_.attributes[a], &rest);
      *own = std::min(*own, RestOf(simplified.errors.attributes[a].rms_99, error_targets_.attributes[a]));
    }
    std::optional<SimplifiedFamily> best;
    for (int round = 0; round < kMostRounds; ++round) {
      LACERTA_ASSIGN_OR_RETURN(SimplifiedFamily family, Encode(simplified.mesh.surface, primitives, rest));
      LACERTA_ASSIGN_OR_RETURN(const bool met, Judge(&family, &rest));
      if (!met && best.has_value()) break;  // the looser one was too loose
      if (met && best.has_value() && SizeOf(family) >= SizeOf(*best)) break;
      if (met) best = std::move(family);
    }
    if (!best.has_value()) return Unsupported("no simplified surface is close enough once it is rounded");
    return std::move(*best);
  }

 private:
  StatusOr<std::vector<Primitive>> Split(const AttributedMesh& mesh) const {
    const std::vector<VertexSoup> soups = SplitIntoSoups(mesh, static_cast<uint32_t>(primitives_.size()));
    std::vector<Primitive> primitives;
    for (size_t m = 0; m < soups.size(); ++m) {
      LACERTA_ASSIGN_OR_RETURN(Primitive primitive, ToPrimitive(soups[m], *primitives_[m], m, texels_per_unit_));
      primitives.push_back(std::move(primitive));
    }
    return primitives;
  }

  StatusOr<SimplifiedFamily> Encode(const TriangleMesh& surface, const std::vector<Primitive>& primitives,
                                    const Rest& rest) const {
    SimplifiedFamily family;
    const SharedLattice lattice = FindPositionLattice(surface, error_targets_.distance * rest.distance);
    family.position_bits = lattice.lattice.bits;
    AttributeTargets targets = targets_;
    targets.uv_texels *= rest.attributes.uv_texels;
    targets.normal_degrees *= rest.attributes.normal_degrees;
    targets.color *= rest.attributes.color;
    for (size_t m = 0; m < primitives.size(); ++m) {
      AttributePrecision attributes = FindAttributeBits(primitives[m], targets, [&](uint64_t set) {
        return texels_per_unit_(m, set);
      });
      LACERTA_ASSIGN_OR_RETURN(DracoEncoded encoded,
                               EncodeDracoPrimitive(primitives[m], {lattice.lattice, std::move(attributes.bits)}));
      family.members.push_back(std::move(encoded));
      family.reports.push_back(std::move(attributes.reports));
    }
    return family;
  }

  // Measures what is decoded and writes that into the reports. Changes the rest for the next round: less for what is too
  // far off; where nothing is, more for what keeps far within its target.
  StatusOr<bool> Judge(SimplifiedFamily* family, Rest* rest) const {
    constexpr uint64_t kSamples = 100'000;
    std::vector<const Primitive*> decoded;
    for (const DracoEncoded& member : family->members) decoded.push_back(&member.decoded);
    LACERTA_ASSIGN_OR_RETURN(const AttributedMesh mesh, ToAttributedMesh(decoded, texels_per_unit_));
    LACERTA_ASSIGN_OR_RETURN(const SurfaceErrors errors, meter_.Measure(mesh, kSamples));
    const bool met = WorstRatio(errors, error_targets_) <= 1.0;
    std::map<double*, double> ratios;  // the worst for each share
    ratios[&rest->distance] = errors.distance / error_targets_.distance;
    for (size_t a = 0; a < original_.attributes.size(); ++a) {
      double& ratio = ratios[ShareOf(original_.attributes[a], rest)];
      ratio = std::max(ratio, errors.attributes[a].rms_99 / error_targets_.attributes[a]);
      if (!error_targets_.everywhere.empty()) {
        ratio = std::max(ratio, errors.attributes[a].rms / error_targets_.everywhere[a]);
      }
    }
    constexpr double kFarWithin = 0.85;
    for (const auto& [share, ratio] : ratios) {
      if (ratio > 1.0) *share *= 0.7;
      if (met && ratio < kFarWithin && share != &rest->distance) *share *= 1.0 / std::max(ratio, 0.5);
    }
    // Positions that slide along the surface take their texture with them.
    const bool distance_met = ratios[&rest->distance] <= 1.0;
    if (!met && distance_met) rest->distance *= 0.6;
    family->error = errors.distance;
    for (size_t m = 0; m < family->reports.size(); ++m) {
      for (AttributeReport& report : family->reports[m]) {
        const std::optional<size_t> a = AttributeOf(original_, *primitives_[m], report.name, m, texels_per_unit_);
        if (a.has_value()) report.error = ReportedError(original_, errors, error_targets_, targets_, *a);
      }
    }
    return met;
  }

  const std::vector<const Primitive*>& primitives_;
  const AttributedMesh& original_;
  const SurfaceErrorMeter& meter_;
  const ErrorTargets error_targets_;
  const AttributeTargets& targets_;
  const TexelScale& texels_per_unit_;
};

}  // namespace

StatusOr<SimplifiedFamily> SimplifyFamily(const std::vector<const Primitive*>& primitives, double error,
                                          const AttributeTargets& targets, uint64_t texel_side,
                                          const TexelScale& texels_per_unit, const std::vector<double>& everywhere) {
  LACERTA_ASSIGN_OR_RETURN(const AttributedMesh original, ToAttributedMesh(primitives, texels_per_unit));
  LACERTA_ASSIGN_OR_RETURN(const SurfaceErrorMeter meter,
                           SurfaceErrorMeter::Create(original, static_cast<double>(texel_side)));
  ErrorTargets error_targets = FamilyTargets(original, error, targets, texel_side);
  error_targets.everywhere = everywhere;
  const FamilySimplifier simplifier(primitives, original, meter, error_targets, targets, texels_per_unit);
  constexpr double kShare = 0.85;  // to simplification: what rounding adds comes on top in squares
  return simplifier.Run(kShare);
}

}  // namespace lacerta
