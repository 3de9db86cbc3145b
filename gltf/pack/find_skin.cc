#include "pack/find_skin.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "lacerta/surface_distance.h"
#include "remesh/base_parts.h"

namespace lacerta {
namespace {

constexpr size_t kMostPoses = 6;
constexpr size_t kMostJoints = size_t{1} << 16;
constexpr size_t kMostTransforms = 1'000'000;  // of all joints in all poses that are looked at

// Whether skins move everything alike: by the same nodes, bound at the same places. Exporters write one for each mesh.
bool AreAlike(const Json& a, const Json& b) {
  const Json *a_binds = Find(a, "inverseBindMatrices"), *b_binds = Find(b, "inverseBindMatrices");
  const bool same_binds = (a_binds == nullptr) == (b_binds == nullptr) && (a_binds == nullptr || *a_binds == *b_binds);
  return same_binds && *Find(a, "joints") == *Find(b, "joints");
}

// The first skin that is like this one.
uint64_t FirstAlike(const GltfDocument& document, uint64_t skin) {
  const Json* json = FindElement(document.json, "skins", skin);
  if (json == nullptr || Find(*json, "joints") == nullptr) return skin;
  for (uint64_t s = 0; s < skin; ++s) {
    const Json& other = *FindElement(document.json, "skins", s);
    if (Find(other, "joints") != nullptr && AreAlike(other, *json)) return s;
  }
  return skin;
}

// By which nodes show the meshes of the sources: one, or several that all of these meshes have. None twice.
StatusOr<std::set<uint64_t>> SkinsOf(const GltfDocument& document, const std::vector<const Source*>& sources) {
  std::set<uint64_t> skins;
  for (const auto& [mesh, nodes] : NodesByMesh(document, sources)) {
    std::set<uint64_t> own;
    for (const uint64_t n : nodes) {
      const std::optional<uint64_t> skin = AsIndex(Find(*FindElement(document.json, "nodes", n), "skin"));
      if (!skin.has_value()) return Unsupported("has joints, but node " + std::to_string(n) + " shows it without a skin");
      own.insert(FirstAlike(document, *skin));
    }
    if (own.empty()) continue;
    if (!skins.empty() && skins != own) return Unsupported("touches what another skin moves");
    skins = std::move(own);
  }
  if (skins.empty()) return Unsupported("has joints, but no node shows it with a skin");
  return skins;
}

bool IsFinite(const Transform& m) {
  constexpr double kMost = 1e15;
  return std::all_of(m.begin(), m.end(), [](double x) { return std::fabs(x) < kMost; });
}

StatusOr<std::vector<Transform>> ReadInverseBinds(const GltfDocument& document, const Json& skin, size_t num_joints) {
  std::vector<Transform> result(num_joints, kIdentity);
  const Json* reference = Find(skin, "inverseBindMatrices");
  if (reference == nullptr) return result;
  const StatusOr<AccessorData> data = ReadMatrices(document, AsIndex(reference).value_or(~uint64_t{0}));
  if (!data.ok() || data.value().count < num_joints)
    return Unsupported("its skin's inverse bind matrices cannot be read");
  constexpr uint32_t kRows = 4;
  for (size_t j = 0; j < num_joints; ++j) {
    for (uint32_t i = 0; i < result[j].size(); ++i) {
      result[j][i] = static_cast<double>(data.value().Float(j, i / 3 * kRows + i % 3));
    }
  }
  return result;
}

// From mesh units to those of the world.
double ScaleOf(const Transform& joint) { return std::cbrt(std::fabs(Determinant(joint))); }

// That of the joints whose scale is the median; the first of those.
Transform MiddleOf(const std::vector<Transform>& joints) {
  std::vector<std::pair<double, size_t>> scales;
  for (size_t j = 0; j < joints.size(); ++j) scales.emplace_back(ScaleOf(joints[j]), j);
  std::nth_element(scales.begin(), scales.begin() + static_cast<std::ptrdiff_t>(scales.size() / 2), scales.end());
  return joints[scales[scales.size() / 2].second];
}

// Mesh to world by each joint. Fails with kUnsupported where the skin refers to a node that does not exist.
StatusOr<std::vector<Transform>> JointsIn(const Json& skin, const std::vector<Transform>& inverse_binds, const ScenePose& pose) {
  std::vector<Transform> joints;
  for (size_t j = 0; j < inverse_binds.size(); ++j) {
    const uint64_t node = AsIndex(FindElement(skin, "joints", j)).value_or(~uint64_t{0});
    if (node >= pose.size()) return Unsupported("its skin refers to a node that does not exist");
    joints.push_back(Multiply(pose[static_cast<size_t>(node)], inverse_binds[j]));
  }
  return joints;
}

// Some vertices of a family.
struct Sample {
  std::vector<Vec3d> positions;
  std::vector<Influences> influences;
};

StatusOr<Sample> TakeSample(const std::vector<const Source*>& sources, size_t num_joints) {
  constexpr size_t kPoints = 256;  // of each source
  Sample sample;
  for (const Source* source : sources) {
    LACERTA_ASSIGN_OR_RETURN(const VertexInfluences influences, ReadInfluences(*source->primitive, num_joints));
    const TriangleMesh surface = Surface(*source->primitive);
    const size_t stride = std::max<size_t>(1, surface.positions.size() / kPoints);
    for (size_t v = 0; v < surface.positions.size(); v += stride) {
      sample.positions.push_back(Vec3Cast<double>(surface.positions[v]));
      const Span<const Influence> own = influences.Of(v);
      sample.influences.emplace_back(own.begin(), own.end());
    }
  }
  return sample;
}

// What moving and turning the whole does not change: distances between some of the points.
std::vector<double> ShapeOf(const std::vector<Vec3d>& points) {
  std::vector<double> distances;
  for (const size_t step : {size_t{1}, points.size() / 3, points.size() / 2}) {
    for (size_t i = 0; i < points.size(); ++i)
      distances.push_back(Norm(points[i] - points[(i + step) % points.size()]));
  }
  return distances;
}

double Length(const std::vector<double>& v) {
  double sum = 0.0;
  for (const double x : v) sum += x * x;
  return std::sqrt(sum);
}

double Difference(std::vector<double> a, const std::vector<double>& b) {
  for (size_t i = 0; i < a.size(); ++i) a[i] -= b[i];
  return Length(a);
}

// Leaves those poses that are farthest from the others and from the mesh as it is; none that blows up or shrinks it.
Status KeepMostDifferent(const Sample& sample, Skin* skin) {
  constexpr double kMostStretch = 10.0;
  const std::vector<double> as_it_is = ShapeOf(sample.positions);
  std::vector<std::vector<double>> shapes;
  std::vector<double> nearest;  // of each pose to what is chosen
  for (size_t pose = 0; pose < skin->poses.size(); ++pose) {
    std::vector<Vec3d> posed;
    for (size_t i = 0; i < sample.positions.size(); ++i)
      posed.push_back(skin->Posed(pose, sample.positions[i], sample.influences[i]));
    shapes.push_back(ShapeOf(posed));
    const double stretch = Length(shapes.back()) / Length(as_it_is);
    nearest.push_back(stretch < kMostStretch && stretch > 1.0 / kMostStretch ? Difference(shapes.back(), as_it_is)
                                                                             : -1.0);
  }
  std::vector<std::vector<Transform>> chosen;
  while (chosen.size() < kMostPoses) {
    const auto farthest = std::max_element(nearest.begin(), nearest.end());
    if (!(*farthest >= 0.0) || (*farthest == 0.0 && !chosen.empty())) break;
    const auto index = static_cast<size_t>(farthest - nearest.begin());
    chosen.push_back(skin->poses[index]);
    for (size_t i = 0; i < shapes.size(); ++i) nearest[i] = std::min(nearest[i], Difference(shapes[i], shapes[index]));
  }
  if (chosen.empty()) return Unsupported("its skin stretches or shrinks it tenfold in every pose");
  skin->poses = std::move(chosen);
  return Status();
}

// Enlarges poses that are smaller than the surface is, so that an error is as large a share of them as of the surface.
Status ScaleSmallPoses(const std::vector<const Source*>& sources, Skin* skin) {
  std::vector<const Primitive*> primitives;
  TriangleMesh all;
  for (const Source* source : sources) {
    primitives.push_back(&*source->primitive);
    all = Together(std::move(all), Surface(*source->primitive));
  }
  const double diagonal = BoundingBoxDiagonal(all);
  for (size_t pose = 0; pose < skin->poses.size(); ++pose) {
    LACERTA_ASSIGN_OR_RETURN(const TriangleMesh posed, PosedSurface(primitives, *skin, pose));
    const double scale = diagonal / BoundingBoxDiagonal(posed);
    if (!(scale > 1.0) || !std::isfinite(scale)) continue;
    for (Transform& m : skin->poses[pose]) {
      for (double& x : m) x *= scale;
    }
  }
  return Status();
}

// One of the skins by which nodes show a family.
struct PosedSkin {
  const Json* json = nullptr;
  std::vector<Transform> inverse_binds;  // of each joint
  double scale = 0.0;                    // from mesh units to those of the world in the first pose, which is the one at rest
};

StatusOr<PosedSkin> ReadSkin(const GltfDocument& document, uint64_t index) {
  PosedSkin skin;
  skin.json = FindElement(document.json, "skins", index);
  const size_t num_joints = skin.json == nullptr ? 0 : static_cast<size_t>(ArraySize(*skin.json, "joints"));
  if (num_joints == 0) return Unsupported("its skin has no joints");
  if (num_joints > kMostJoints) return Unsupported("its skin has more joints than an index can name");
  LACERTA_ASSIGN_OR_RETURN(skin.inverse_binds, ReadInverseBinds(document, *skin.json, num_joints));
  return skin;
}

// Adds where the joints of `of_node` are in a pose to *skin, in mesh units, unless that is not finite.
Status AddPose(const ScenePose& pose, PosedSkin* of_node, Skin* skin) {
  LACERTA_ASSIGN_OR_RETURN(std::vector<Transform> joints, JointsIn(*of_node->json, of_node->inverse_binds, pose));
  if (!std::all_of(joints.begin(), joints.end(), IsFinite)) return Status();
  if (!(of_node->scale > 0.0)) of_node->scale = ScaleOf(MiddleOf(joints));
  if (!(of_node->scale > 0.0)) return Unsupported("its skin shrinks it to nothing");
  joints.resize(skin->num_joints);
  for (Transform& m : joints) {
    for (double& x : m) x /= of_node->scale;
  }
  skin->poses.push_back(std::move(joints));
  return Status();
}

}  // namespace

StatusOr<Skin> FindSkin(const GltfDocument& document, const std::vector<const Source*>& sources,
                        const std::vector<ScenePose>& poses) {
  LACERTA_ASSIGN_OR_RETURN(const std::set<uint64_t> indices, SkinsOf(document, sources));
  std::vector<PosedSkin> skins;
  for (const uint64_t index : indices) {
    LACERTA_ASSIGN_OR_RETURN(PosedSkin skin, ReadSkin(document, index));
    skins.push_back(std::move(skin));
  }
  Skin skin;
  skin.num_joints = kMostJoints;  // that all of them have
  for (const PosedSkin& of_node : skins) skin.num_joints = std::min(skin.num_joints, of_node.inverse_binds.size());
  for (const ScenePose& pose : poses) {
    for (PosedSkin& of_node : skins) {
      if ((skin.poses.size() + 1) * skin.num_joints > kMostTransforms) break;
      LACERTA_RETURN_IF_ERROR(AddPose(pose, &of_node, &skin));
    }
  }
  if (skin.poses.empty()) return Unsupported("its skin's matrices are not finite");
  LACERTA_ASSIGN_OR_RETURN(const Sample sample, TakeSample(sources, skin.num_joints));
  LACERTA_RETURN_IF_ERROR(KeepMostDifferent(sample, &skin));
  LACERTA_RETURN_IF_ERROR(ScaleSmallPoses(sources, &skin));
  return skin;
}

std::optional<Transform> PlacementBySkin(const GltfDocument& document, uint64_t skin, const ScenePose& pose) {
  const Json* json = FindElement(document.json, "skins", skin);
  const uint64_t num_joints = json == nullptr ? 0 : ArraySize(*json, "joints");
  if (num_joints == 0 || num_joints > kMostJoints) return std::nullopt;
  const auto inverse_binds = ReadInverseBinds(document, *json, static_cast<size_t>(num_joints));
  if (!inverse_binds.ok()) return std::nullopt;
  const auto joints = JointsIn(*json, inverse_binds.value(), pose);
  if (!joints.ok() || !std::all_of(joints.value().begin(), joints.value().end(), IsFinite)) return std::nullopt;
  const Transform middle = MiddleOf(joints.value());
  return ScaleOf(middle) > 0.0 ? std::optional<Transform>(middle) : std::nullopt;
}

}  // namespace lacerta
