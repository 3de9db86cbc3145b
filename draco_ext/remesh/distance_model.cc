#include "remesh/distance_model.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

#include "geometry/triangle_points.h"
#include "geometry/vertex_area_vectors.h"
#include "lacerta/surface_distance.h"

namespace lacerta {

// A sample of a surface with the share of the area that it stands for.
struct AreaSample {
  uint32_t face;
  Vec3d weights;  // barycentric
  double share;
};

// A point on a mesh with the plane that it is to meet: residual = normal . (point - target).
struct FitResidual {
  uint32_t face = SurfacePoint::kNone;
  Vec3d weights;  // barycentric
  Vec3d normal;   // unit
  double residual = 0;
  double weight = 0;
};

namespace {

constexpr size_t kBlockSize = 1024;
constexpr double kTiny = 1e-7;  // distance, of the target's diagonal: it has no direction

Vec3d FaceNormal(const TriangleMesh& mesh, uint32_t face) {
  return Normalized(AreaVector(mesh.positions, mesh.triangles[face]));
}

// Along the way from `to` to `from`, or the face's normal where there is none.
Vec3d DirectionBetween(const Vec3d& from, const Vec3d& to, double tiny, const TriangleMesh& mesh, uint32_t face) {
  const Vec3d way = from - to;
  const double length = Norm(way);
  return length > tiny ? way * (1 / length) : FaceNormal(mesh, face);
}

// As shares of the whole; all zero where there is none.
std::vector<double> AreaShares(const TriangleMesh& mesh) {
  std::vector<double> areas(mesh.triangles.size());
  double total = 0;
  for (size_t f = 0; f < areas.size(); ++f) total += areas[f] = Norm(AreaVector(mesh.positions, mesh.triangles[f]));
  for (double& area : areas) area = total > 0 ? area / total : 0;
  return areas;
}

// About so many samples, half of them spread over the area and half over the faces, so that small parts of many faces, such as letters
// on a plate, have some.
std::vector<AreaSample> SampleSpread(const TriangleMesh& mesh, const std::vector<uint32_t>& order, double num_samples) {
  const std::vector<double> areas = AreaShares(mesh);
  const auto num_faces = static_cast<double>(std::count_if(areas.begin(), areas.end(), [](double area) { return area > 0; }));
  std::vector<AreaSample> result;
  double due = 0.5, sum = 0;
  uint64_t n = 0;
  for (const uint32_t f : order) {
    if (!(areas[f] > 0)) continue;
    const double expected = 0.5 * num_samples * (areas[f] + 1 / num_faces);
    due += expected;
    for (; due >= 1; due -= 1) {
      result.push_back({f, TrianglePoint(n++, 0.5), areas[f] / expected});
      sum += result.back().share;
    }
  }
  for (AreaSample& s : result) s.share /= sum;
  return result;
}

// About so many, but some in every face with an area, so that none is free to go anywhere.
std::vector<AreaSample> SampleEveryFace(const TriangleMesh& mesh, const std::vector<uint32_t>& order, double num_samples) {
  constexpr size_t kFewest = 3;
  const std::vector<double> areas = AreaShares(mesh);
  std::vector<AreaSample> result;
  double due = 0.5;
  uint64_t n = 0;
  for (const uint32_t f : order) {
    if (!(areas[f] > 0)) continue;
    due += areas[f] * num_samples;
    const auto whole = static_cast<size_t>(due);
    due -= static_cast<double>(whole);
    const size_t count = std::max(whole, kFewest);
    for (size_t i = 0; i < count; ++i) result.push_back({f, TrianglePoint(n++, 0.5), areas[f] / static_cast<double>(count)});
  }
  return result;
}

Vec3d PointOn(const TriangleMesh& mesh, uint32_t face, const Vec3d& weights) {
  const Triangle& t = mesh.triangles[face];
  Vec3d p;
  for (int k = 0; k < 3; ++k) p += Vec3Cast<double>(mesh.positions[t[k]]) * weights[k];
  return p;
}

void Add(const std::vector<FitResidual>& residuals, const TriangleMesh& mesh, const MeshNeighbors& neighbors, double* mean,
         DistanceModel* model) {
  for (const FitResidual& r : residuals) {
    if (r.face == SurfacePoint::kNone) continue;
    *mean += r.weight * r.residual * r.residual;
    const double half = 0.5 * r.weight;
    const Triangle& t = mesh.triangles[r.face];
    for (int k = 0; k < 3; ++k) {
      model->gradient[t[k]] += r.normal * (half * r.residual * r.weights[k]);
      model->diagonal[t[k]].AddOuter(r.normal, half * r.weights[k] * r.weights[k]);
      const double product = r.weights[(k + 1) % 3] * r.weights[(k + 2) % 3];
      if (product > 0) model->off_diagonal[neighbors.face_edges[r.face][k]].AddOuter(r.normal, half * product);
    }
  }
}

double MeanSquare(const std::vector<FitResidual>& residuals) {
  double mean = 0;
  for (const FitResidual& r : residuals) mean += r.weight * r.residual * r.residual;
  return mean;
}

template <typename Function>
void ForBlocks(size_t count, const Function& function) {
  tbb::parallel_for(tbb::blocked_range<size_t>(0, (count + kBlockSize - 1) / kBlockSize, 1), [&](const tbb::blocked_range<size_t>& range) {
    for (size_t block = range.begin(); block != range.end(); ++block) {
      function(block * kBlockSize, std::min(count, (block + 1) * kBlockSize));
    }
  });
}

}  // namespace

Vec3d Symmetric3::Solve(const Vec3d& b) const {
  const double c00 = yy * zz - yz * yz, c01 = xz * yz - xy * zz, c02 = xy * yz - xz * yy;
  const double det = xx * c00 + xy * c01 + xz * c02;
  if (!(std::fabs(det) > 0)) return {};
  const double c11 = xx * zz - xz * xz, c12 = xy * xz - xx * yz, c22 = xx * yy - xy * xy;
  return Vec3d{c00 * b.x + c01 * b.y + c02 * b.z, c01 * b.x + c11 * b.y + c12 * b.z, c02 * b.x + c12 * b.y + c22 * b.z} * (1 / det);
}

FitTarget::FitTarget(const TriangleMesh& mesh, size_t num_samples, double farthest)
    : mesh_(mesh), tree_(mesh), diagonal_(BoundingBoxDiagonal(mesh)), farthest_(farthest) {
  Resample(num_samples);
}

void FitTarget::Resample(size_t num_samples) {
  if (num_samples == num_samples_) return;
  num_samples_ = num_samples;
  samples_.clear();
  for (const AreaSample& s : SampleSpread(mesh_, tree_.faces_in_tree_order(), static_cast<double>(num_samples))) {
    samples_.push_back({Vec3Cast<float>(PointOn(mesh_, s.face, s.weights)), s.share});
  }
}

DistanceModel FitTarget::ModelAt(const TriangleMesh& mesh, const MeshNeighbors& neighbors) const {
  DistanceModel model;
  model.gradient.resize(mesh.positions.size());
  model.diagonal.resize(mesh.positions.size());
  model.off_diagonal.resize(neighbors.edges.size());
  const TriangleTree tree(mesh);
  Add(Forward(mesh, tree), mesh, neighbors, &model.forward, &model);
  const std::vector<AreaSample> own = SampleEveryFace(mesh, tree.faces_in_tree_order(), static_cast<double>(num_samples_));
  if (own.empty()) {
    model.backward = diagonal_ * diagonal_;
    return model;
  }
  Add(Backward(mesh, own), mesh, neighbors, &model.backward, &model);
  return model;
}

double FitTarget::DistortionAt(const TriangleMesh& mesh) const {
  const TriangleTree tree(mesh);
  const std::vector<AreaSample> own = SampleSpread(mesh, tree.faces_in_tree_order(), static_cast<double>(num_samples_));
  if (own.empty()) return diagonal_ * diagonal_;
  return std::max(MeanSquare(Forward(mesh, tree)), MeanSquare(Backward(mesh, own)));
}

std::vector<FitTarget::Hit> FitTarget::HitsOn(const TriangleMesh& mesh) const {
  const std::vector<FitResidual> residuals = Forward(mesh, TriangleTree(mesh));
  std::vector<Hit> hits;
  hits.reserve(samples_.size());
  for (size_t i = 0; i < samples_.size(); ++i) {
    hits.push_back({samples_[i].position, samples_[i].share, residuals[i].face, residuals[i].residual * residuals[i].residual});
  }
  return hits;
}

double FitTarget::SquaredDistance(const Vec3f& point, uint32_t* hint) const {
  const ClosestPointResult closest = tree_.ClosestPointNear(point, *hint);
  *hint = closest.point.face;
  return static_cast<double>(closest.squared_distance);
}

double FitTarget::Excess(const Vec3f& point) const {
  const double most = farthest_ * farthest_;
  if (farthest_ == 0 || tree_.IsNear(point, static_cast<float>(most))) return 0;
  return static_cast<double>(tree_.ClosestPoint(point).squared_distance) / most;
}

std::vector<FitResidual> FitTarget::Forward(const TriangleMesh& mesh, const TriangleTree& tree) const {
  std::vector<FitResidual> result(samples_.size());
  ForBlocks(samples_.size(), [&](size_t first, size_t last) {
    uint32_t hint = SurfacePoint::kNone;
    for (size_t i = first; i < last; ++i) {
      const SurfacePoint closest = tree.ClosestPointNear(samples_[i].position, hint).point;
      hint = closest.face;
      if (closest.face == SurfacePoint::kNone) continue;
      const Vec3d weights{closest.barycentric[0], closest.barycentric[1], closest.barycentric[2]};
      const Vec3d p = Vec3Cast<double>(samples_[i].position), q = PointOn(mesh, closest.face, weights);
      const Vec3d normal = DirectionBetween(q, p, kTiny * diagonal_, mesh, closest.face);
      result[i] = {closest.face, weights, normal, Dot(normal, q - p), samples_[i].share};
    }
  });
  return result;
}

std::vector<FitResidual> FitTarget::Backward(const TriangleMesh& mesh, const std::vector<AreaSample>& samples) const {
  std::vector<FitResidual> result(samples.size());
  ForBlocks(samples.size(), [&](size_t first, size_t last) {
    uint32_t hint = SurfacePoint::kNone;
    for (size_t i = first; i < last; ++i) {
      const Vec3d q = PointOn(mesh, samples[i].face, samples[i].weights);
      const SurfacePoint closest = tree_.ClosestPointNear(Vec3Cast<float>(q), hint).point;
      hint = closest.face;
      if (closest.face == SurfacePoint::kNone) continue;
      const Vec3d p = Vec3Cast<double>(closest.position);
      const Vec3d normal = DirectionBetween(q, p, kTiny * diagonal_, mesh_, closest.face);
      result[i] = {samples[i].face, samples[i].weights, normal, Dot(normal, q - p), samples[i].share};
    }
  });
  return result;
}

}  // namespace lacerta
