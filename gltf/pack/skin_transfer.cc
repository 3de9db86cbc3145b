#include "pack/skin_transfer.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <utility>

#include "geometry/vertex_area_vectors.h"

namespace lacerta {
namespace {

constexpr uint32_t kNone = MeshAttribute::kNoValue;
constexpr size_t kKept = 4;             // JOINTS_0 holds so many
constexpr double kSeamDistance = 1e-3;  // within which other sides of a seam are looked for, relative to the diagonal

// The largest ones, with the sum 1.
Influences KeepLargest(Influences all) {
  std::sort(all.begin(), all.end(), [](const Influence& a, const Influence& b) {
    return a.weight != b.weight ? a.weight > b.weight : a.joint < b.joint;
  });
  all.resize(std::min(all.size(), kKept));
  float sum = 0.0f;
  for (const Influence& influence : all) sum += influence.weight;
  for (Influence& influence : all) influence.weight /= sum;
  std::sort(all.begin(), all.end(), [](const Influence& a, const Influence& b) { return a.joint < b.joint; });
  return all;
}

}  // namespace

SkinTransfer::SkinTransfer(const FamilyMeter& meter)
    : meter_(&meter),
      poses_(&meter.original().attributes[*meter.IndexOf(kPosesName)]),
      surface_(std::make_unique<const GroupSurface>(meter.original())) {}

StatusOr<SkinTransfer> SkinTransfer::Create(const FamilyMeter& meter) {
  SkinTransfer transfer(meter);
  for (const Primitive* primitive : meter.primitives()) {
    LACERTA_ASSIGN_OR_RETURN(VertexInfluences influences, ReadInfluences(*primitive, meter.skin()->num_joints));
    transfer.influences_.push_back(std::move(influences));
  }
  // Triangles of a group are in the order of its primitive.
  std::vector<uint32_t> next(meter.primitives().size(), 0);
  for (size_t f = 0; f < meter.original().surface.triangles.size(); ++f) {
    transfer.face_in_group_.push_back(next[meter.original().GroupOf(f)]++);
  }
  return transfer;
}

SkinTransfer::Key SkinTransfer::KeyOf(const Vec3f& position, const float* poses, size_t num_poses) {
  Key key = {position.x, position.y, position.z};
  key.insert(key.end(), poses, poses + 3 * num_poses);
  return key;
}

Influences SkinTransfer::Interpolate(const GroupSurface::Point& point) const {
  const uint32_t group = meter_->original().GroupOf(point.face);
  const Triangle& corners = meter_->primitives()[group]->triangles[face_in_group_[point.face]];
  Influences all;
  for (size_t k = 0; k < 3; ++k) {
    for (const Influence& own : influences_[group].Of(corners[k])) {
      const auto known = std::find_if(all.begin(), all.end(), [&](const Influence& i) { return i.joint == own.joint; });
      const float weight = own.weight * point.barycentric[k];
      if (known != all.end()) {
        known->weight += weight;
      } else if (weight > 0.0f) {
        all.push_back({own.joint, weight});
      }
    }
  }
  return all;
}

Influences SkinTransfer::At(uint32_t group, const Vec3f& position, const Vec3d& normal, const float* poses,
                            uint32_t* hint) const {
  std::vector<GroupSurface::Point> sides;
  surface_->PointsNear(group, position, normal, kSeamDistance * meter_->meter().diagonal(), hint, &sides);
  surface_->KeepOnePerSide(*poses_, &sides);
  Influences nearest;
  double least = std::numeric_limits<double>::infinity();
  std::vector<double> value(poses_->components);
  for (const GroupSurface::Point& side : sides) {
    InterpolateValue(*poses_, side, value.data());
    double square = 0.0;
    for (size_t i = 0; i < value.size(); ++i)
      square += (value[i] - static_cast<double>(poses[i])) * (value[i] - static_cast<double>(poses[i]));
    if (!(square < least)) continue;
    least = square;
    nearest = Interpolate(side);
  }
  return KeepLargest(std::move(nearest));
}

SkinTransfer::ByVertex SkinTransfer::Transfer(AttributedMesh* mesh) const {
  MeshAttribute& poses = mesh->attributes[static_cast<size_t>(poses_ - meter_->original().attributes.data())];
  const std::vector<Vec3d> normals = VertexAreaVectors(mesh->surface);
  const size_t columns = poses.components;
  std::map<std::pair<uint32_t, uint32_t>, uint32_t>
      row_of;  // of a vertex and its old row; the first group decides for all
  ByVertex result;
  std::vector<float> values;
  uint32_t hint = kNone;
  for (size_t f = 0; f < poses.corners.size(); ++f) {
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t vertex = mesh->surface.triangles[f][k];
      uint32_t& row = poses.corners[f][k];
      const auto [known, is_new] =
          row_of.emplace(std::make_pair(vertex, row), static_cast<uint32_t>(values.size() / columns));
      if (is_new) {
        const Vec3f& position = mesh->surface.positions[vertex];
        Influences influences = At(mesh->GroupOf(f), position, normals[vertex], &poses.values[row * columns], &hint);
        meter_->skin()->AppendPoses(Vec3Cast<double>(position), influences, &values);
        result.emplace(KeyOf(position, &values[values.size() - columns], meter_->skin()->poses.size()),
                       std::move(influences));
      }
      row = known->second;
    }
  }
  poses.values = std::move(values);
  WeldExactly(mesh);
  return result;
}

}  // namespace lacerta
