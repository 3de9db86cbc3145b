#include "pack/attributed_family.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <map>
#include <optional>
#include <utility>

#include "extension/target_channels.h"
#include "geometry/vertex_area_vectors.h"
#include "pack/morphs.h"

namespace lacerta {
namespace {

// Offsets are off beside the surface that they start from.
constexpr double kShareOfTargets = 0.6;
constexpr double kRadiansPerDegree = 3.14159265358979323846 / 180.0;

bool BeginsWith(const std::string& text, const char* prefix) { return text.rfind(prefix, 0) == 0; }

bool IsCustom(const std::string& name) { return BeginsWith(name, "_"); }

std::optional<AttributeKind> KindOf(const Attribute& attribute, const std::set<std::string>& custom) {
  const std::string& name = attribute.name;
  if (BeginsWith(name, "TEXCOORD_") && attribute.data.components == 2) return AttributeKind::kTextureCoordinates;
  if (BeginsWith(name, "COLOR_")) return AttributeKind::kColor;
  if (name == "NORMAL" && attribute.data.components == 3) return AttributeKind::kNormal;
  if (name == "TANGENT" && attribute.data.components == 4) return AttributeKind::kTangent;
  if (IsTargetAttribute(name) || ParseTargetChannels(name).has_value() || custom.count(name) > 0)
    return AttributeKind::kGeneric;
  return std::nullopt;
}

StatusOr<VertexSoup::Attribute> PosesOf(const Primitive& primitive, const Skin& skin) {
  LACERTA_ASSIGN_OR_RETURN(const VertexInfluences influences, ReadInfluences(primitive, skin.num_joints));
  VertexSoup::Attribute poses{kPosesName, AttributeKind::kGeneric, static_cast<uint32_t>(3 * skin.poses.size()), {}};
  const TriangleMesh surface = Surface(primitive);
  for (size_t v = 0; v < surface.positions.size(); ++v) {
    skin.AppendPoses(Vec3Cast<double>(surface.positions[v]), influences.Of(v), &poses.values);
  }
  return poses;
}

StatusOr<VertexSoup::Attribute> WeightsOf(const Primitive& primitive, const Skin& skin, const JointTable& joints) {
  LACERTA_ASSIGN_OR_RETURN(const VertexInfluences influences, ReadInfluences(primitive, skin.num_joints));
  VertexSoup::Attribute weights{kWeightsName, AttributeKind::kWeights, static_cast<uint32_t>(joints.size()), {}};
  weights.values.resize(primitive.num_vertices * joints.size());
  for (uint64_t v = 0; v < primitive.num_vertices; ++v) {
    float sum = 0.0f;
    for (const Influence& influence : influences.Of(v)) sum += influence.weight;
    for (const Influence& influence : influences.Of(v)) {
      const auto joint =
          static_cast<size_t>(std::lower_bound(joints.begin(), joints.end(), influence.joint) - joints.begin());
      weights.values[v * joints.size() + joint] = influence.weight / sum;
    }
  }
  return weights;
}

StatusOr<VertexSoup> ToSoup(const Primitive& primitive, size_t member, const TexelScale& scale, OtherAttributes others,
                            const Skin* skin, const std::set<std::string>& custom, const JointTable& joints) {
  VertexSoup soup;
  TriangleMesh surface = Surface(primitive);
  soup.positions = std::move(surface.positions);
  soup.triangles = std::move(surface.triangles);
  for (const Attribute& attribute : primitive.attributes) {
    if (attribute.name == "POSITION" || (skin != nullptr && IsSkinAttribute(attribute.name))) continue;
    const std::optional<AttributeKind> kind = KindOf(attribute, custom);
    if (!kind.has_value() && others == OtherAttributes::kLeaveOut) continue;
    if (!kind.has_value()) return Unsupported("has the attribute " + attribute.name + ", which is not simplified");
    VertexSoup::Attribute values{SoupName(attribute, member, scale), *kind, attribute.data.components, {}};
    values.values.reserve(static_cast<size_t>(primitive.num_vertices) * values.components);
    for (uint64_t v = 0; v < primitive.num_vertices; ++v) {
      for (uint32_t c = 0; c < values.components; ++c) values.values.push_back(attribute.data.Float(v, c));
    }
    soup.attributes.push_back(std::move(values));
  }
  if (skin != nullptr) {
    LACERTA_ASSIGN_OR_RETURN(VertexSoup::Attribute moved,
                             joints.empty() ? PosesOf(primitive, *skin) : WeightsOf(primitive, *skin, joints));
    soup.attributes.push_back(std::move(moved));
  }
  return soup;
}

double ScaleOf(const MeshAttribute& texture) {
  return std::strtod(texture.name.c_str() + texture.name.find('/') + 1, nullptr);
}

// How fast what is shown of a component changes with its linear light, IEC 61966-2-1.
double SrgbSlope(double linear) {
  constexpr double kDark = 0.0031308;
  return linear <= kDark ? 12.92 : 1.055 / 2.4 * std::pow(std::min(linear, 1.0), 1 / 2.4 - 1);
}

// What colors may be off, as the length of a difference of linear light, for an error of each component as screens show them.
double ColorTarget(const AttributedMesh& mesh, const MeshAttribute& color, double on_screen) {
  double squares = 0.0, weight = 0.0;
  for (size_t f = 0; f < color.corners.size(); ++f) {
    if (color.corners[f][0] == MeshAttribute::kNoValue) continue;
    const double area = Norm(AreaVector(mesh.surface.positions, mesh.surface.triangles[f]));
    for (const uint32_t row : color.corners[f]) {
      for (uint32_t c = 0; c < std::min(color.components, 3u); ++c) {
        const double slope = SrgbSlope(static_cast<double>(color.values[size_t{row} * color.components + c]));
        squares += area * slope * slope;
        weight += area;
      }
    }
  }
  constexpr double kOfIntegers = 0.00113;  // those of 8 bits: 1 / (255 sqrt(12))
  constexpr double kRoundedAgain = 2.0;    // components, and room for what was integers to become integers again
  const double linear = weight > 0.0 && squares > 0.0 ? on_screen / std::sqrt(squares / weight) : on_screen;
  return kRoundedAgain * std::max(linear, kOfIntegers);
}

}  // namespace

std::string SoupName(const Attribute& attribute, size_t member, const TexelScale& scale) {
  if (!BeginsWith(attribute.name, "TEXCOORD_")) return attribute.name;
  return attribute.name + "/" + std::to_string(scale(member, SetOfTexCoord(attribute.name)));
}

std::set<std::string> CustomAttributesOf(const std::vector<const Primitive*>& primitives) {
  constexpr uint32_t kMostComponents = 4;
  std::map<std::string, bool> found;  // whether they mean something between vertices
  std::set<std::string> exact;
  for (const Primitive* primitive : primitives) {
    for (const Attribute& attribute : primitive->attributes) {
      if (!IsCustom(attribute.name)) continue;
      const AccessorData& data = attribute.data;
      bool is_usable = data.type == ComponentType::kFloat && data.components <= kMostComponents, has_fractions = false;
      for (uint64_t v = 0; v < data.count && is_usable; ++v) {
        for (uint32_t c = 0; c < data.components; ++c) {
          const float x = data.Float(v, c);
          is_usable = is_usable && std::isfinite(x);
          has_fractions = has_fractions || x != std::floor(x);
        }
      }
      if (!is_usable) exact.insert(attribute.name);
      found[attribute.name] = found[attribute.name] || has_fractions;
    }
  }
  std::set<std::string> result;
  for (const auto& [name, has_fractions] : found) {
    if (has_fractions && exact.count(name) == 0) result.insert(name);
  }
  return result;
}

StatusOr<AttributedMesh> ToAttributedMesh(const std::vector<const Primitive*>& primitives, const TexelScale& scale,
                                          OtherAttributes others, const Skin* skin, const std::set<std::string>& custom,
                                          const JointTable& joints) {
  std::vector<VertexSoup> soups;
  for (size_t m = 0; m < primitives.size(); ++m) {
    LACERTA_ASSIGN_OR_RETURN(VertexSoup soup, ToSoup(*primitives[m], m, scale, others, skin, custom, joints));
    soups.push_back(std::move(soup));
  }
  return WeldSoups(soups);
}

bool HasOtherAttributes(const std::vector<const Primitive*>& primitives, const Skin* skin, const std::set<std::string>& custom) {
  for (const Primitive* primitive : primitives) {
    for (const Attribute& attribute : primitive->attributes) {
      const bool is_other = attribute.name != "POSITION" && !KindOf(attribute, custom).has_value();
      if (is_other && (skin == nullptr || !IsSkinAttribute(attribute.name))) return true;
    }
  }
  return false;
}

ErrorTargets FamilyTargets(const AttributedMesh& original, double error, const AttributeTargets& targets,
                           uint64_t texel_side) {
  ErrorTargets result;
  result.distance = error;
  // What turns is a few samples in ten thousand: other samples than those of the search tell of a seventh more.
  constexpr double kOfTurned = 0.85;
  result.turned = kOfTurned * targets.turned;
  const auto bound_everywhere = [&](double bound) {
    result.everywhere.resize(original.attributes.size(), std::numeric_limits<double>::infinity());
    result.everywhere[result.attributes.size()] = bound;
    result.attributes.push_back(bound);
  };
  for (const MeshAttribute& attribute : original.attributes) {
    if (attribute.kind == AttributeKind::kTextureCoordinates) {
      result.attributes.push_back(targets.uv_texels * static_cast<double>(texel_side) / ScaleOf(attribute));
    } else if (attribute.kind == AttributeKind::kColor) {
      result.attributes.push_back(ColorTarget(original, attribute, targets.color));
    } else if (attribute.name == kPosesName) {
      bound_everywhere(error);
    } else if (IsTargetPosition(attribute.name)) {
      bound_everywhere(kShareOfTargets * error);
    } else if (IsCustom(attribute.name)) {
      const double range = std::max(RangeOf(attribute), static_cast<double>(std::numeric_limits<float>::min()));
      result.attributes.push_back(targets.custom * range * std::sqrt(attribute.components));
    } else if (const auto channels = ParseTargetChannels(attribute.name);
               channels.has_value() && channels->attribute == "POSITION") {
      result.attributes.push_back(error);  // of the whole surface, with its targets
    } else if (IsTargetAttribute(attribute.name) || channels.has_value()) {
      result.attributes.push_back(targets.normal_degrees * kRadiansPerDegree);
    } else {
      result.attributes.push_back(targets.normal_degrees);
    }
  }
  return result;
}

}  // namespace lacerta
