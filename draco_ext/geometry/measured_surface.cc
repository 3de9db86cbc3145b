#include "geometry/measured_surface.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "geometry/lean_tree.h"
#include "geometry/surface_sampler.h"
#include "geometry/triangle_tree.h"

namespace lacerta {
namespace {

class TreeSurface : public MeasuredSurface {
 public:
  TreeSurface(const TriangleMesh& mesh, bool with_vertices) : tree_(mesh), cumulated_area_(CumulatedAreas(tree_.corners_in_tree_order())) {
    if (!with_vertices) return;
    std::vector<bool> seen(mesh.positions.size());
    for (const uint32_t f : tree_.faces_in_tree_order()) {
      for (const uint32_t v : mesh.triangles[f]) {
        if (!seen[v]) vertices_.push_back(mesh.positions[v]);
        seen[v] = true;
      }
    }
  }

  double doubled_area() const override { return cumulated_area_.empty() ? 0.0 : cumulated_area_.back(); }

  double SquaredDistance(const Vec3f& p, uint32_t* hint) const override {
    const ClosestPointResult closest = tree_.ClosestPointNear(p, *hint);
    *hint = closest.point.face;
    return static_cast<double>(closest.squared_distance);
  }

  Points Samples(uint64_t num_samples, uint32_t seed) const override {
    return [sampler = SurfaceSampler(tree_.corners_in_tree_order(), cumulated_area_, num_samples, seed)](uint64_t i) mutable {
      return sampler.Sample(i).position;
    };
  }

  uint64_t num_vertices() const override { return vertices_.size(); }
  Points Vertices() const override {
    return [this](uint64_t i) { return vertices_[i]; };
  }

 private:
  const TriangleTree tree_;
  // In tree order: consecutive samples are neighbors in space.
  const std::vector<double> cumulated_area_;
  std::vector<Vec3f> vertices_;  // those in use, once each, where the tree order first meets them
};

class LeanSurface : public MeasuredSurface {
 public:
  explicit LeanSurface(const TriangleMesh& mesh) : tree_(mesh), is_used_(mesh.positions.size()) {
    const std::vector<uint32_t>& faces = tree_.faces_in_tree_order();
    double area = 0;
    for (size_t slot = 0; slot < faces.size(); ++slot) {
      area += AreaAt(slot);
      if ((slot + 1) % kBlock == 0 || slot + 1 == faces.size()) cumulated_area_.push_back(area);
      for (const uint32_t v : mesh.triangles[faces[slot]]) is_used_[v] = true;
    }
  }

  double doubled_area() const override { return cumulated_area_.empty() ? 0.0 : cumulated_area_.back(); }
  double SquaredDistance(const Vec3f& p, uint32_t* hint) const override { return tree_.SquaredDistance(p, hint); }

  Points Samples(uint64_t num_samples, uint32_t seed) const override {
    return [this, sequence = SampleSequence(num_samples, seed)](uint64_t i) {
      const double target = sequence.ShareAt(i) * cumulated_area_.back();
      const auto [u, v] = sequence.WeightsAt(i);
      return PointWithWeights(CornersAt(SlotOf(target)), u, v);
    };
  }

  // In their own order: what they are asked for, the largest distance, has none. Those that are not in use repeat one that is.
  uint64_t num_vertices() const override { return is_used_.size(); }
  Points Vertices() const override {
    const std::vector<Vec3f>& positions = tree_.mesh().positions;
    return [this, &positions](uint64_t i) { return positions[is_used_[i] ? i : tree_.mesh().triangles[0][0]]; };
  }

 private:
  static constexpr size_t kBlock = 16;  // triangles for which one sum of areas is kept

  TriangleTree::Corners CornersAt(size_t slot) const {
    const TriangleMesh& mesh = tree_.mesh();
    const Triangle& t = mesh.triangles[tree_.faces_in_tree_order()[slot]];
    return {mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]};
  }
  double AreaAt(size_t slot) const { return DoubledArea(CornersAt(slot)); }

  // The first whose cumulated area is above `target`, or the last.
  size_t SlotOf(double target) const {
    const auto block = std::upper_bound(cumulated_area_.begin(), cumulated_area_.end() - 1, target);
    double area = block == cumulated_area_.begin() ? 0 : *(block - 1);
    size_t slot = static_cast<size_t>(block - cumulated_area_.begin()) * kBlock;
    const size_t last = std::min(slot + kBlock, tree_.faces_in_tree_order().size()) - 1;
    for (; slot < last; ++slot) {
      area += AreaAt(slot);
      if (target < area) break;
    }
    return slot;
  }

  const LeanTree tree_;
  std::vector<double> cumulated_area_;  // doubled, in tree order, up to the end of each block
  std::vector<bool> is_used_;           // vertices
};

}  // namespace

Status CheckDiagonal(double diagonal) {
  // Squares of distances 100 dB below this are still in the range of float, in which the tree returns them.
  constexpr double kLeast = 1e-12;
  if (diagonal >= kLeast) return Status();
  return InvalidData("its bounding box is smaller than 1e-12 units; scale the mesh up");
}

std::unique_ptr<MeasuredSurface> MakeMeasuredSurface(const TriangleMesh& mesh, bool with_vertices) {
  return std::make_unique<TreeSurface>(mesh, with_vertices);
}

std::unique_ptr<MeasuredSurface> MakeLeanSurface(const TriangleMesh& mesh) { return std::make_unique<LeanSurface>(mesh); }

}  // namespace lacerta
