#include "remesh/surface_fit.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "common/subdivision.h"
#include "geometry/triangle_points.h"
#include "geometry/triangle_tree.h"
#include "geometry/vertex_area_vectors.h"
#include "remesh/conjugate_gradients.h"
#include "remesh/reversal.h"

namespace lacerta {
namespace {

// What a point of the input says of the vertices of the nearest triangle of the remesh: `gap` is to be undone by moves d_k of its
// corners along their normals, sum slopes[k] * d_k = gap.
struct Sample {
  Triangle corners{};
  std::array<float, 3> slopes{};
  float gap = 0;
};

double DoubledArea(const TriangleMesh& mesh, uint32_t face) { return Norm(AreaVector(mesh.positions, mesh.triangles[face])); }

// Walks through points spread evenly over the area of a mesh: one face after the other gets its share, in a low-discrepancy sequence.
class PointWalk {
 public:
  // faces: of the mesh, in the order of the walk. Keeps references to both.
  PointWalk(const TriangleMesh& mesh, const std::vector<uint32_t>& faces, double points_per_area)
      : mesh_(&mesh), faces_(&faces), points_per_area_(points_per_area) {}

  // Whether there is one more; it is on face() then, at weights().
  bool Next() {
    for (; !(due_ >= 1); due_ += points_per_area_ * DoubledArea(*mesh_, (*faces_)[next_++])) {
      if (next_ == faces_->size()) return false;
    }
    due_ -= 1;
    ++num_points_;
    return true;
  }

  uint32_t face() const { return (*faces_)[next_ - 1]; }
  Vec3d weights() const { return TrianglePoint(num_points_ - 1, 0); }

 private:
  const TriangleMesh* mesh_;
  const std::vector<uint32_t>* faces_;
  double points_per_area_;
  double due_ = 0;
  size_t next_ = 0;  // in faces_
  uint64_t num_points_ = 0;
};

// hint: the face of the remesh nearest to the point before, for the next one as well.
Sample SampleAt(const InputSurface& surface, uint32_t face, const Vec3d& weights, const TriangleMesh& remesh, const TriangleTree& tree,
                const std::vector<Vec3f>& normals, uint32_t* hint) {
  constexpr double kLeastCosine = 0.5;  // between the two surfaces: else the nearest triangle is on another sheet
  const Vec3f position = surface.PositionAt(face, weights);
  const SurfacePoint nearest = tree.ClosestPointNear(position, *hint).point;
  *hint = nearest.face;
  if (nearest.face == kNone) return {};
  const Triangle& corners = remesh.triangles[nearest.face];
  Vec3d p[3];
  for (int k = 0; k < 3; ++k) p[k] = Vec3Cast<double>(remesh.positions[corners[k]]);
  const Vec3d normal = Normalized(Cross(p[1] - p[0], p[2] - p[0]));
  if (Dot(normal, Vec3Cast<double>(surface.NormalAt(face, weights))) < kLeastCosine) return {};
  Sample sample;
  sample.corners = corners;
  sample.gap = static_cast<float>(Dot(Vec3Cast<double>(position - nearest.position), normal));
  for (int k = 0; k < 3; ++k) {
    sample.slopes[k] = nearest.barycentric[k] * static_cast<float>(Dot(normal, Vec3Cast<double>(normals[corners[k]])));
  }
  return sample;
}

// Samples of about `count` points of the input, in an order in which neighbors are near each other: what is near one is near the next.
std::vector<Sample> TakeSamples(const InputSurface& surface, double count, const TriangleMesh& remesh, const std::vector<Vec3f>& normals) {
  constexpr size_t kBlockSize = 512;  // fixed, so that hints do not depend on the threads
  const TriangleMesh& input = surface.mesh();
  double area = 0;
  for (uint32_t f = 0; f < input.triangles.size(); ++f) area += DoubledArea(input, f);
  PointWalk walk(input, surface.tree().faces_in_tree_order(), area > 0 ? count / area : 0);
  std::vector<PointWalk> block_starts;
  size_t num_points = 0;
  for (PointWalk before = walk; walk.Next(); before = walk, ++num_points) {
    if (num_points % kBlockSize == 0) block_starts.push_back(before);
  }
  const TriangleTree tree(remesh);
  std::vector<Sample> samples(num_points);
  tbb::parallel_for(size_t{0}, block_starts.size(), [&](size_t block) {
    PointWalk point = block_starts[block];
    uint32_t hint = kNone;
    for (size_t i = block * kBlockSize; i < std::min(num_points, (block + 1) * kBlockSize) && point.Next(); ++i) {
      samples[i] = SampleAt(surface, point.face(), point.weights(), remesh, tree, normals, &hint);
    }
  });
  return samples;
}

// The normal equations of the samples, (sum s s' + stiffness) d = sum gap s.
class NormalEquations {
 public:
  NormalEquations(const std::vector<Sample>& samples, double stiffness) : samples_(samples), stiffness_(stiffness) {}

  std::vector<double> Apply(const std::vector<double>& d) const {
    std::vector<double> result(d.size());
    for (size_t v = 0; v < d.size(); ++v) result[v] = stiffness_ * d[v];
    for (const Sample& s : samples_) {
      double along = 0;
      for (int k = 0; k < 3; ++k) along += double{s.slopes[k]} * d[s.corners[k]];
      for (int k = 0; k < 3; ++k) result[s.corners[k]] += double{s.slopes[k]} * along;
    }
    return result;
  }

  std::vector<double> RightSide(size_t num_vertices) const {
    std::vector<double> result(num_vertices, 0.0);
    for (const Sample& s : samples_) {
      for (int k = 0; k < 3; ++k) result[s.corners[k]] += double{s.slopes[k]} * double{s.gap};
    }
    return result;
  }

 private:
  const std::vector<Sample>& samples_;
  const double stiffness_;
};

// Base vertices where a cut is to stay closed: 1 for those with another one at the same place. Empty where there is no cut.
std::vector<uint8_t> CopiedVertices(const BaseTags& tags) {
  std::vector<uint8_t> copied(tags.joined.size(), 0);
  for (size_t v = 0; v < copied.size(); ++v) {
    if (tags.joined[v] != v) copied[v] = copied[tags.joined[v]] = 1;
  }
  return copied;
}

// Whether a triangle that looked where the input looks is turned over by a move of its corners.
bool IsTurnedOver(const InputSurface& surface, const Triangle& t, const std::vector<Vec3f>& before, const std::vector<Vec3f>& after,
                  const std::vector<Vec3f>& normals) {
  const auto at = [&](const std::vector<Vec3f>& positions) -> std::array<Vec3f, 3> { return {positions[t[0]], positions[t[1]], positions[t[2]]}; };
  const Vec3f old_normal = AreaNormal(at(before)), normal = AreaNormal(at(after));
  const Vec3f facing = normals[t[0]] + normals[t[1]] + normals[t[2]];
  const float agreement = Dot(normal, facing);
  if (agreement < 0 && Dot(old_normal, facing) >= 0) return true;
  constexpr float kSafeCosine = 0.8f;  // triangles that agree more are not looked up on the input
  if (agreement >= kSafeCosine * Norm(normal) * Norm(facing)) return false;
  return IsReversed(surface, at(after)) && !IsReversed(surface, at(before));
}

// Moves the vertices of `mesh` along their normals, but less far, in the end not at all, at triangles that would be turned over by
// it.
void MoveUnlessTurned(const InputSurface& surface, const std::vector<double>& moves, const std::vector<Vec3f>& normals, TriangleMesh* mesh) {
  constexpr int kRounds = 6;
  const std::vector<Vec3f> before = mesh->positions;
  std::vector<uint8_t> halvings(moves.size(), 0);
  for (int round = 0; round <= kRounds; ++round) {
    for (size_t v = 0; v < moves.size(); ++v) {
      const double share = halvings[v] < kRounds ? std::ldexp(1.0, -halvings[v]) : 0.0;
      mesh->positions[v] = before[v] + normals[v] * static_cast<float>(moves[v] * share);
    }
    std::vector<uint8_t> turned_triangle(mesh->triangles.size());
    tbb::parallel_for(size_t{0}, turned_triangle.size(), [&](size_t f) {
      turned_triangle[f] = IsTurnedOver(surface, mesh->triangles[f], before, mesh->positions, normals);
    });
    std::vector<uint8_t> turned(moves.size(), 0);
    for (size_t f = 0; f < turned_triangle.size(); ++f) {
      if (!turned_triangle[f]) continue;
      for (const uint32_t v : mesh->triangles[f]) turned[v] = 1;
    }
    if (std::find(turned.begin(), turned.end(), 1) == turned.end()) return;
    for (size_t v = 0; v < moves.size(); ++v) halvings[v] = static_cast<uint8_t>(halvings[v] + turned[v]);
  }
}

// Those of the finest level.
std::vector<Triangle> FinestTriangles(const SemiRegularMesh& mesh) {
  Topology topology = BuildTopology(mesh.num_base_vertices, mesh.base_triangles, mesh.tags).value();
  for (int level = 1; level < mesh.num_levels; ++level) topology = Refine(topology);
  return mesh.num_levels > 0 ? RefineTriangles(topology) : std::move(topology.triangles);
}

}  // namespace

void FitToInput(const InputSurface& surface, const SurfaceFitOptions& options, NormalMesh* remesh) {
  SemiRegularMesh& mesh = remesh->mesh;
  TriangleMesh finest{mesh.positions, FinestTriangles(mesh)};
  const double num_samples = std::min(options.samples_per_vertex * static_cast<double>(finest.positions.size()),
                                      options.samples_per_input_vertex * static_cast<double>(surface.mesh().positions.size()));
  const std::vector<Sample> samples = TakeSamples(surface, num_samples, finest, remesh->surface_normals);
  const NormalEquations equations(samples, options.stiffness);
  std::vector<double> moves = ConjugateGradients(equations.RightSide(mesh.positions.size()), options.iterations, [&](const std::vector<double>& x) { return equations.Apply(x); });
  const std::vector<uint8_t> pinned = CopiedVertices(mesh.tags);
  for (size_t v = 0; v < pinned.size(); ++v) {
    if (pinned[v]) moves[v] = 0;
  }
  MoveUnlessTurned(surface, moves, remesh->surface_normals, &finest);
  mesh.positions = std::move(finest.positions);
}

}  // namespace lacerta
