#include "pack/family.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include "document/scene_poses.h"
#include "geometry/vertex_area_vectors.h"
#include "lacerta/surface_distance.h"
#include "pack/find_skin.h"

namespace lacerta {
namespace {

class UnionFind {
 public:
  explicit UnionFind(size_t size) : parent_(size) { std::iota(parent_.begin(), parent_.end(), size_t{0}); }
  size_t Find(size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void Join(size_t a, size_t b) { parent_[std::max(Find(a), Find(b))] = std::min(Find(a), Find(b)); }

 private:
  std::vector<size_t> parent_;
};

// For every mesh the transforms of its instances as text: equal for meshes that stand alike.
std::vector<std::string> Stances(const std::vector<Instance>& instances, uint64_t num_meshes) {
  std::vector<std::vector<Transform>> transforms(static_cast<size_t>(num_meshes));
  for (const Instance& instance : instances) {
    transforms[static_cast<size_t>(instance.mesh)].push_back(instance.transform);
  }
  std::vector<std::string> stances;
  for (std::vector<Transform>& of_mesh : transforms) {
    std::sort(of_mesh.begin(), of_mesh.end());
    stances.emplace_back(reinterpret_cast<const char*>(of_mesh.data()), of_mesh.size() * sizeof(Transform));
  }
  return stances;
}

// glTF ignores the node's transform of what a skin moves: it stands where the joints put it.
void PlaceBySkins(const GltfDocument& document, std::vector<Instance>* instances) {
  std::map<uint64_t, std::optional<Transform>> placements;
  std::optional<ScenePose> rest;
  for (Instance& instance : *instances) {
    if (!instance.skin.has_value()) continue;
    if (!rest.has_value()) rest = RestPose(document);
    auto known = placements.find(*instance.skin);
    if (known == placements.end()) known = placements.emplace(*instance.skin, PlacementBySkin(document, *instance.skin, *rest)).first;
    if (known->second.has_value()) instance.transform = *known->second;
  }
}

struct PlacedPosition {
  uint64_t stance = 0;
  Vec3f position;
  uint64_t mesh = 0;
};

bool Before(const PlacedPosition& a, const PlacedPosition& b) {
  if (a.stance != b.stance) return a.stance < b.stance;
  if (a.position.x != b.position.x) return a.position.x < b.position.x;
  if (a.position.y != b.position.y) return a.position.y < b.position.y;
  return a.position.z < b.position.z;
}

void JoinTouching(const std::vector<PlacedSurface>& surfaces, const std::vector<std::string>& stances,
                  UnionFind* meshes) {
  std::map<std::string, uint64_t> stance_ids;
  std::vector<PlacedPosition> positions;
  for (const PlacedSurface& placed : surfaces) {
    for (const Place& place : *placed.places) {
      const uint64_t stance =
          stance_ids.emplace(stances[static_cast<size_t>(place.mesh)], stance_ids.size()).first->second;
      for (const Vec3f& position : placed.surface.positions) positions.push_back({stance, position, place.mesh});
    }
  }
  std::sort(positions.begin(), positions.end(), Before);
  for (size_t i = 1; i < positions.size(); ++i) {
    if (!Before(positions[i - 1], positions[i])) {
      meshes->Join(static_cast<size_t>(positions[i - 1].mesh), static_cast<size_t>(positions[i].mesh));
    }
  }
}

struct Box {
  Vec3d min, max;
  bool empty = true;
  void Add(const Vec3d& p) {
    for (int axis = 0; axis < 3; ++axis) {
      min[axis] = empty ? p[axis] : std::min(min[axis], p[axis]);
      max[axis] = empty ? p[axis] : std::max(max[axis], p[axis]);
    }
    empty = false;
  }
  double Diagonal() const { return empty ? 0.0 : Norm(max - min); }
};

double AreaOf(const TriangleMesh& mesh) {
  double twice = 0.0;
  for (const Triangle& t : mesh.triangles) twice += Norm(AreaVector(mesh.positions, t));
  return twice / 2;
}

// Squared errors grow by it, and so does the area: mean over the directions.
double SquaredScale(const Transform& transform) { return std::pow(std::fabs(Determinant(transform)), 2.0 / 3.0); }

}  // namespace

StatusOr<Families> FindFamilies(const GltfDocument& document, const std::vector<PlacedSurface>& surfaces) {
  LACERTA_ASSIGN_OR_RETURN(std::vector<Instance> instances, CollectInstances(document));
  PlaceBySkins(document, &instances);
  const uint64_t num_meshes = ArraySize(document.json, "meshes");
  const std::vector<std::string> stances = Stances(instances, num_meshes);
  UnionFind meshes(static_cast<size_t>(num_meshes));
  for (const PlacedSurface& placed : surfaces) {
    for (const Place& place : *placed.places) {
      meshes.Join(static_cast<size_t>(placed.places->front().mesh), static_cast<size_t>(place.mesh));
    }
  }
  JoinTouching(surfaces, stances, &meshes);

  Families result;
  std::map<size_t, size_t> family_of_root;
  for (const PlacedSurface& placed : surfaces) {
    const size_t root = meshes.Find(static_cast<size_t>(placed.places->front().mesh));
    const auto [found, is_new] = family_of_root.emplace(root, result.families.size());
    if (is_new) result.families.emplace_back();
    result.of_surface.push_back(found->second);
    result.families[found->second].members.push_back(result.of_surface.size() - 1);
  }
  for (size_t mesh = 0; mesh < num_meshes; ++mesh) {
    const auto found = family_of_root.find(meshes.Find(mesh));
    if (found != family_of_root.end()) ++result.families[found->second].num_meshes;
  }
  for (Family& family : result.families) {
    Box box;
    for (const size_t member : family.members) {
      for (const Vec3f& position : surfaces[member].surface.positions) box.Add(Vec3Cast<double>(position));
    }
    family.diagonal = box.Diagonal();
    family.stretch = 0.0;
  }
  std::vector<std::vector<size_t>> surfaces_of_mesh(static_cast<size_t>(num_meshes));
  for (size_t s = 0; s < surfaces.size(); ++s) {
    for (const Place& place : *surfaces[s].places) surfaces_of_mesh[static_cast<size_t>(place.mesh)].push_back(s);
  }
  std::vector<double> areas;
  areas.reserve(surfaces.size());
  for (const PlacedSurface& placed : surfaces) areas.push_back(AreaOf(placed.surface));
  Box scene;
  for (const Instance& instance : instances) {
    const double scale = SquaredScale(instance.transform);
    for (const size_t s : surfaces_of_mesh[static_cast<size_t>(instance.mesh)]) {
      Family& family = result.families[result.of_surface[s]];
      family.in_scene = true;
      family.weight += areas[s] * scale * scale;
      family.stretch = std::max(family.stretch, LargestStretch(instance.transform));
      for (const Vec3f& position : surfaces[s].surface.positions) {
        scene.Add(Apply(instance.transform, Vec3Cast<double>(position)));
      }
    }
  }
  for (Family& family : result.families) {
    if (!(family.stretch > 0.0)) family.stretch = 1.0;
  }
  result.scene_diagonal = scene.Diagonal();
  for (Family& family : result.families) {
    if (family.in_scene) continue;
    const bool has_sizes = family.diagonal > 0.0 && result.scene_diagonal > 0.0;
    const double scale = has_sizes ? result.scene_diagonal / family.diagonal : 1.0;
    for (const size_t member : family.members) family.weight += areas[member] * std::pow(scale, 4.0);
  }
  return result;
}

double FamilyError(const Families& families, size_t index, double psnr) {
  constexpr double kLeastPsnr = 40.0;
  const Family& family = families.families[index];
  const double scene = DistanceOfPsnr(psnr, families.scene_diagonal) / family.stretch;
  const double own = DistanceOfPsnr(std::min(psnr, kLeastPsnr), family.diagonal);
  if (!family.in_scene || !std::isfinite(scene) || !(scene > 0.0)) return DistanceOfPsnr(psnr, family.diagonal);
  return std::min(scene, own);
}

}  // namespace lacerta
