#include "pack/weighted_family.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "geometry/close_seams.h"
#include "pack/attributed_family.h"
#include "pack/skin.h"
#include "remesh/level_wedges.h"

namespace lacerta {
namespace {

constexpr uint32_t kNone = MeshAttribute::kNoValue;

// How far apart joints that move the same vertex put it, root mean square over the vertices of the pose where that is
// most; what one weight gains another loses.
StatusOr<double> ReachOf(const FamilyMeter& meter) {
  const Skin& skin = *meter.skin();
  std::vector<double> squares(skin.poses.size(), 0.0);
  double count = 0;
  for (const Primitive* primitive : meter.primitives()) {
    LACERTA_ASSIGN_OR_RETURN(const VertexInfluences influences, ReadInfluences(*primitive, skin.num_joints));
    const TriangleMesh surface = Surface(*primitive);
    for (size_t v = 0; v < surface.positions.size(); ++v) {
      const Span<const Influence> own = influences.Of(v);
      if (own.size() < 2) continue;
      const auto most = std::max_element(own.begin(), own.end(),
                                         [](const Influence& a, const Influence& b) { return a.weight < b.weight; });
      const Vec3d position = Vec3Cast<double>(surface.positions[v]);
      for (const Influence& other : own) {
        if (other.joint == most->joint) continue;
        ++count;
        for (size_t p = 0; p < squares.size(); ++p) {
          const Vec3d apart = Apply(skin.poses[p][other.joint], position) - Apply(skin.poses[p][most->joint], position);
          squares[p] += Dot(apart, apart);
        }
      }
    }
  }
  const double most = *std::max_element(squares.begin(), squares.end());
  return count > 0 ? std::sqrt(most / count / 2) : 0.0;
}

StatusOr<JointTable> JointsOf(const FamilyMeter& meter) {
  constexpr size_t kMostJoints = 255;
  std::set<uint16_t> found;
  for (const Primitive* primitive : meter.primitives()) {
    LACERTA_ASSIGN_OR_RETURN(const VertexInfluences influences, ReadInfluences(*primitive, meter.skin()->num_joints));
    for (const Influence& influence : influences.all) found.insert(static_cast<uint16_t>(influence.joint));
    for (uint64_t v = 0; v < primitive->num_vertices; ++v) {
      if (influences.Of(v).size() == 0) return Unsupported("has vertices that no joint moves");
    }
  }
  if (found.size() > kMostJoints)
    return Unsupported("is moved by " + std::to_string(found.size()) + " joints, a stream has room for " +
                       std::to_string(kMostJoints));
  return JointTable(found.begin(), found.end());
}

}  // namespace

StatusOr<WeightedFamily> ToWeightedFamily(const FamilyMeter& meter) {
  // Weights that hardly matter, and those of a single joint, are coded nevertheless: steps of the base are no finer
  // than this.
  constexpr double kCoarsest = 1.0 / 16;
  WeightedFamily family;
  LACERTA_ASSIGN_OR_RETURN(family.joints, JointsOf(meter));
  LACERTA_ASSIGN_OR_RETURN(const double reach, ReachOf(meter));
  family.reach = std::max(reach, meter.error() / kCoarsest);
  LACERTA_ASSIGN_OR_RETURN(family.original,
                           ToAttributedMesh(meter.primitives(), meter.texels_per_unit(), OtherAttributes::kLeaveOut,
                                            meter.skin(), meter.custom(), family.joints));
  family.targets = meter.targets();
  family.targets.attributes.clear();
  family.targets.everywhere.clear();
  for (size_t a = 0; a < family.original.attributes.size(); ++a) {
    const std::optional<size_t> known = meter.IndexOf(family.original.attributes[a].name);
    if (!known.has_value()) family.weights = a;
    family.targets.attributes.push_back(known.has_value() ? meter.targets().attributes[*known]
                                                          : meter.error() / family.reach);
  }
  CloseUnseenSeams(family.targets.attributes, meter.meter().texture_size(), &family.original);
  return family;
}

Status MeasureInPoses(const FamilyMeter& meter, const WeightedFamily& family, const AttributedMesh& mesh,
                      uint64_t num_samples, SurfaceErrors* errors) {
  constexpr uint64_t kShare = 4, kFewest = 3000;  // of the samples, in each pose
  const MeshAttribute& weights = mesh.attributes[family.weights];
  // Vertices where weights have seams are several.
  std::vector<uint32_t> vertex_of(weights.num_values(), kNone), first_of(weights.num_values(), kNone);
  TriangleMesh surface;
  std::vector<Influences> influences;
  for (size_t f = 0; f < mesh.surface.triangles.size(); ++f) {
    Triangle triangle;
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t vertex = mesh.surface.triangles[f][k], row = weights.corners[f][k];
      if (row == kNone) return InternalError("a skinned surface has no weights");
      if (vertex_of[row] != vertex) {
        vertex_of[row] = vertex;
        first_of[row] = static_cast<uint32_t>(surface.positions.size());
        surface.positions.push_back(mesh.surface.positions[vertex]);
        const FourWeights four = LargestFour(&weights.values[size_t{row} * weights.components], family.joints);
        influences.emplace_back();
        for (size_t i = 0; i < four.weights.size(); ++i) influences.back().push_back({four.joints[i], four.weights[i]});
      }
      triangle[k] = first_of[row];
    }
    surface.triangles.push_back(triangle);
  }
  const auto posed = [&](size_t pose) -> StatusOr<TriangleMesh> {
    TriangleMesh moved = surface;
    for (size_t v = 0; v < moved.positions.size(); ++v) {
      moved.positions[v] =
          Vec3Cast<float>(meter.skin()->Posed(pose, Vec3Cast<double>(surface.positions[v]), influences[v]));
    }
    return moved;
  };
  LACERTA_ASSIGN_OR_RETURN(const double worst, meter.WorstPose(posed, std::max(num_samples / kShare, kFewest)));
  AttributeError& error = errors->attributes[family.weights];
  error.rms = error.rms_99 = worst / family.reach;
  return Status();
}

std::vector<float> FactorsInPoses(const FamilyMeter& meter, const WeightedFamily& family,
                                  const AttributedSemiRegularMesh& levels, size_t attribute) {
  if (attribute != family.weights) return {};
  const AttributedMesh mesh = FinestLevel(levels);
  const MeshAttribute& weights = mesh.attributes[attribute];
  const Skin& skin = *meter.skin();
  std::vector<float> factors(weights.values.size(), 1.0f);
  std::vector<uint8_t> is_known(weights.num_values(), 0);
  for (size_t f = 0; f < mesh.surface.triangles.size(); ++f) {
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t row = weights.corners[f][k];
      if (row == kNone || is_known[row] != 0) continue;
      is_known[row] = 1;
      const Vec3d position = Vec3Cast<double>(mesh.surface.positions[mesh.surface.triangles[f][k]]);
      const float* const own = &weights.values[size_t{row} * weights.components];
      std::vector<double> squares(family.joints.size(), 0.0);
      for (const std::vector<Transform>& pose : skin.poses) {
        std::vector<Vec3d> moved;
        Vec3d posed;
        double sum = 0;
        for (size_t c = 0; c < family.joints.size(); ++c) {
          moved.push_back(Apply(pose[family.joints[c]], position));
          const double weight = std::max(static_cast<double>(own[c]), 0.0);
          posed += moved[c] * weight;
          sum += weight;
        }
        for (size_t c = 0; c < squares.size() && sum > 0; ++c) {
          const Vec3d apart = moved[c] - posed * (1 / sum);
          squares[c] = std::max(squares[c], Dot(apart, apart));
        }
      }
      for (size_t c = 0; c < squares.size(); ++c) {
        factors[size_t{row} * weights.components + c] =
            static_cast<float>(std::min(1.0, std::sqrt(squares[c]) / family.reach));
      }
    }
  }
  return factors;
}

}  // namespace lacerta
