#include "geometry/group_surface.h"

#include <algorithm>
#include <cmath>

#include "geometry/surface_sampler.h"
#include "geometry/vertex_area_vectors.h"

namespace lacerta {
namespace {

bool ShareAValue(const TriangleMesh& surface, const MeshAttribute& attribute, uint32_t f, uint32_t g) {
  for (size_t i = 0; i < 3; ++i) {
    for (size_t j = 0; j < 3; ++j) {
      if (surface.triangles[f][i] == surface.triangles[g][j] && attribute.corners[f][i] == attribute.corners[g][j]) return true;
    }
  }
  return false;
}

// Of each vertex, whether some attribute has more than one value there, or is absent from a part of its faces.
std::vector<bool> FindSeams(const AttributedMesh& mesh) {
  constexpr uint32_t kUnknown = MeshAttribute::kNoValue - 1;
  std::vector<bool> has_seam(mesh.surface.positions.size(), false);
  for (const MeshAttribute& attribute : mesh.attributes) {
    std::vector<uint32_t> row_of(has_seam.size(), kUnknown);
    for (size_t f = 0; f < mesh.surface.triangles.size(); ++f) {
      for (size_t k = 0; k < 3; ++k) {
        const uint32_t v = mesh.surface.triangles[f][k], row = attribute.corners[f][k];
        if (row_of[v] == kUnknown) row_of[v] = row;
        if (row_of[v] != row) has_seam[v] = true;
      }
    }
  }
  return has_seam;
}

}  // namespace

void InterpolateValue(const MeshAttribute& attribute, const GroupSurface::Point& point, double* value) {
  std::fill(value, value + attribute.components, 0.0);
  for (size_t k = 0; k < 3; ++k) {
    const float* row = attribute.values.data() + size_t{attribute.corners[point.face][k]} * attribute.components;
    for (uint32_t i = 0; i < attribute.components; ++i) value[i] += static_cast<double>(point.barycentric[k]) * static_cast<double>(row[i]);
  }
}

GroupSurface::GroupSurface(const AttributedMesh& mesh) : mesh_(mesh), place_(mesh.surface.triangles.size()), has_seam_(FindSeams(mesh)) {
  constexpr uint32_t kNone = SurfacePoint::kNone;
  std::map<uint32_t, std::vector<uint32_t>> faces_of_group;
  for (uint32_t f = 0; f < place_.size(); ++f) {
    std::vector<uint32_t>& faces = faces_of_group[mesh.GroupOf(f)];
    place_[f] = static_cast<uint32_t>(faces.size());
    faces.push_back(f);
  }
  std::vector<uint32_t> number(mesh.surface.positions.size(), kNone);
  for (auto& [group, faces] : faces_of_group) {
    TriangleMesh part;  // with its own vertices, so that many groups are not many copies
    for (const uint32_t f : faces) {
      Triangle t = mesh.surface.triangles[f];
      for (uint32_t& v : t) {
        if (number[v] == kNone) {
          number[v] = static_cast<uint32_t>(part.positions.size());
          part.positions.push_back(mesh.surface.positions[v]);
        }
        v = number[v];
      }
      part.triangles.push_back(t);
    }
    for (const uint32_t f : faces) {
      for (const uint32_t v : mesh.surface.triangles[f]) number[v] = kNone;
    }
    TriangleTree tree(part);
    corners_.insert(corners_.end(), tree.corners_in_tree_order().begin(), tree.corners_in_tree_order().end());
    for (const uint32_t f : tree.faces_in_tree_order()) faces_.push_back(faces[f]);
    const std::vector<double> cumulated = CumulatedAreas(tree.corners_in_tree_order());
    const double area = cumulated.empty() ? 0.0 : cumulated.back();
    groups_.emplace(group, Group{std::move(tree), std::move(faces), area});
  }
  cumulated_area_ = CumulatedAreas(corners_);
}

bool GroupSurface::HasArea(uint32_t group) const {
  const auto found = groups_.find(group);
  return found != groups_.end() && found->second.area > 0;
}

Vec3d GroupSurface::NormalOf(uint32_t face) const {
  return Normalized(AreaVector(mesh_.surface.positions, mesh_.surface.triangles[face]));
}

GroupSurface::Nearness GroupSurface::PointsNear(uint32_t group, const Vec3f& p, const Vec3d& normal, double beyond, uint32_t* hint,
                                                std::vector<Point>* points) const {
  points->clear();
  const auto found = groups_.find(group);
  if (found == groups_.end()) return {};
  const Group& part = found->second;
  const bool hint_is_here = *hint < place_.size() && mesh_.GroupOf(*hint) == group;
  const ClosestPointResult closest = part.tree.ClosestPointNear(p, hint_is_here ? place_[*hint] : SurfacePoint::kNone);
  if (closest.point.face == SurfacePoint::kNone) return {};
  const auto add = [&](const ClosestPointResult& result) {
    points->push_back({part.faces[result.point.face], result.point.barycentric, result.squared_distance, result.point.position});
  };
  add(closest);
  *hint = points->front().face;
  const double reach = std::sqrt(static_cast<double>(closest.squared_distance)) + beyond;
  std::vector<ClosestPointResult> near;
  part.tree.PointsNear(p, static_cast<float>(reach * reach), kMostNear - 1, &near);  // besides the closest one
  for (const ClosestPointResult& result : near) {
    if (result.point.face != closest.point.face) add(result);
  }
  constexpr double kLooksBack = -0.5;  // cosine: faces upright on the normal look away by chance, and begin at its own edges
  const auto along = [&](const Point& point) { return Dot(NormalOf(point.face), normal); };
  const auto first_other = std::stable_partition(points->begin(), points->end(), [&](const Point& point) { return along(point) > 0; });
  Nearness nearness{first_other != points->begin(), closest.squared_distance, {}};
  if (!nearness.agrees) return nearness;
  const auto back = std::find_if(first_other, points->end(), [&](const Point& point) { return along(point) < kLooksBack; });
  if (back != points->end()) nearness.height_of_back = Dot(Vec3Cast<double>(back->position) - Vec3Cast<double>(points->front().position), normal);
  points->erase(first_other, points->end());
  return nearness;
}

void GroupSurface::KeepOnePerSide(const MeshAttribute& attribute, std::vector<Point>* points) const {
  const size_t count = points->size();
  if (count < 2) return;
  std::array<uint8_t, kMostNear> side{};  // by the index of its first point
  for (size_t i = 0; i < count; ++i) {
    side[i] = static_cast<uint8_t>(i);
    for (size_t j = 0; j < i; ++j) {
      if (side[j] == side[i] || !ShareAValue(mesh_.surface, attribute, (*points)[i].face, (*points)[j].face)) continue;
      const uint8_t low = std::min(side[i], side[j]), high = std::max(side[i], side[j]);
      std::replace(side.begin(), side.begin() + static_cast<std::ptrdiff_t>(i) + 1, high, low);
    }
  }
  size_t kept = 0;
  for (size_t i = 0; i < count; ++i) {
    if (side[i] == i) (*points)[kept++] = (*points)[i];
  }
  points->resize(kept);
}

bool GroupSurface::AreSidesOfAllAttributes(const std::vector<Point>& points) const {
  return std::none_of(points.begin(), points.end(), [this](const Point& point) {
    const Triangle& t = mesh_.surface.triangles[point.face];
    return has_seam_[t[0]] || has_seam_[t[1]] || has_seam_[t[2]];
  });
}

}  // namespace lacerta
