#include "remesh/mesh_fit.h"

#include <algorithm>
#include <cmath>

#include "geometry/vertex_area_vectors.h"
#include "remesh/folds.h"
#include "remesh/retreat.h"

namespace lacerta {
namespace {

using Moves = std::vector<Vec3d>;

// The quadratic form that one round minimizes: the model, damped, and the bits as squares of the predictions' errors.
class RoundSystem {
 public:
  RoundSystem(const DistanceModel& model, const MeshNeighbors& neighbors, const RateModel& rate, const LinearPredictions& predictions, const TriangleMesh& mesh)
      : model_(model), neighbors_(neighbors), predictions_(predictions), diagonal_(model.diagonal), gradient_(model.gradient) {
    double mean_trace = 0;
    for (const Symmetric3& block : diagonal_) mean_trace += block.Trace();
    mean_trace /= static_cast<double>(diagonal_.size());
    for (size_t v = 0; v < diagonal_.size(); ++v) diagonal_[v].AddScaledIdentity(kDamping * (model.diagonal[v].Trace() + 0.01 * mean_trace));
    preconditioner_ = diagonal_;
    for (size_t i = 0; i < predictions.size(); ++i) {
      const Vec3d error = ErrorOf(i, [&](uint32_t v) { return Vec3Cast<double>(mesh.positions[v]); });
      const double weight = predictions.flaps() * rate.distortion_per_bit * rate.BitSlope(SquaredNorm(error));
      weights_.push_back(weight);
      for (const auto& [v, factor] : predictions[i]) {
        preconditioner_[v].AddScaledIdentity(weight * Square(factor));
        gradient_[v] += error * (weight * static_cast<double>(factor));
      }
    }
  }

  // Conjugate gradients from zero.
  Moves Solve() const {
    constexpr int kIterations = 25;
    Moves moves(gradient_.size()), residual(gradient_.size()), direction(gradient_.size());
    for (size_t v = 0; v < residual.size(); ++v) residual[v] = -gradient_[v];
    double energy = 0, first_energy = 0;
    for (int i = 0; i < kIterations; ++i) {
      double next_energy = 0;
      Moves conditioned(residual.size());
      for (size_t v = 0; v < residual.size(); ++v) {
        conditioned[v] = preconditioner_[v].Solve(residual[v]);
        next_energy += Dot(conditioned[v], residual[v]);
      }
      if (i == 0) first_energy = next_energy;
      if (!(next_energy > 1e-6 * first_energy)) break;
      const double keep = i == 0 ? 0 : next_energy / energy;
      energy = next_energy;
      for (size_t v = 0; v < direction.size(); ++v) direction[v] = conditioned[v] + direction[v] * keep;
      const Moves product = Multiply(direction);
      double curvature = 0;
      for (size_t v = 0; v < direction.size(); ++v) curvature += Dot(direction[v], product[v]);
      if (!(curvature > 0)) break;
      const double length = energy / curvature;
      for (size_t v = 0; v < moves.size(); ++v) {
        moves[v] += direction[v] * length;
        residual[v] -= product[v] * length;
      }
    }
    return moves;
  }

 private:
  static constexpr double kDamping = 0.02;  // of the curvature; holds what no sample does

  static double Square(double x) { return x * x; }

  template <typename At>
  Vec3d ErrorOf(size_t prediction, const At& at) const {
    Vec3d error;
    for (const auto& [v, factor] : predictions_[prediction]) error += at(v) * static_cast<double>(factor);
    return error;
  }

  Moves Multiply(const Moves& x) const {
    Moves result(x.size());
    for (size_t v = 0; v < x.size(); ++v) result[v] = diagonal_[v] * x[v];
    for (size_t e = 0; e < neighbors_.edges.size(); ++e) {
      const auto [u, v] = neighbors_.edges[e];
      result[u] += model_.off_diagonal[e] * x[v];
      result[v] += model_.off_diagonal[e] * x[u];
    }
    for (size_t i = 0; i < predictions_.size(); ++i) {
      const Vec3d error = ErrorOf(i, [&](uint32_t v) { return x[v]; }) * weights_[i];
      for (const auto& [v, factor] : predictions_[i]) result[v] += error * static_cast<double>(factor);
    }
    return result;
  }

  const DistanceModel& model_;
  const MeshNeighbors& neighbors_;
  const LinearPredictions& predictions_;
  std::vector<Symmetric3> diagonal_, preconditioner_;
  Moves gradient_;
  std::vector<double> weights_;  // of predictions
};

// Puts back vertices that went too far from the input.
void UndoExcess(const FitTarget& target, const std::vector<Vec3f>& before, TriangleMesh* mesh) {
  for (size_t v = 0; v < before.size(); ++v) {
    const double excess = target.Excess(mesh->positions[v]);
    if (excess > 0 && excess > target.Excess(before[v])) mesh->positions[v] = before[v];
  }
}

// Puts back vertices that left where they were `first`.
void UndoRetreat(const FitTarget& target, const std::vector<Vec3f>& first, const std::vector<Vec3f>& before, const MeshNeighbors& neighbors, TriangleMesh* mesh) {
  const auto position_of = [&](uint32_t v) { return Vec3Cast<double>(mesh->positions[v]); };
  for (uint32_t v = 0; v < before.size(); ++v) {
    if (HasRetreated(Vec3Cast<double>(first[v]), v, mesh->triangles, neighbors, target.most_retreat(), position_of)) mesh->positions[v] = before[v];
  }
}

// Puts back the vertices of triangles that turned over, or were folded onto a neighbor, until none is.
void UndoFlips(const std::vector<Vec3f>& before, const MeshNeighbors& neighbors, TriangleMesh* mesh) {
  constexpr int kMostPasses = 10;
  bool changed = true;
  for (int pass = 0; pass < kMostPasses && changed; ++pass) {
    changed = false;
    for (const Triangle& t : mesh->triangles) {
      const Vec3d old_normal = AreaVector(before, t), new_normal = AreaVector(mesh->positions, t);
      if (Dot(old_normal, new_normal) >= 0.3 * Norm(old_normal) * Norm(new_normal)) continue;
      for (const uint32_t v : t) {
        changed = changed || mesh->positions[v] != before[v];
        mesh->positions[v] = before[v];
      }
    }
    for (const auto& flap : neighbors.flaps) {
      if (!IsFolded(flap, mesh->positions) || IsFolded(flap, before)) continue;
      for (const uint32_t v : flap) mesh->positions[v] = before[v];
      changed = true;
    }
  }
  if (changed) mesh->positions = before;
}

}  // namespace

void FitToSurface(const FitTarget& target, const MeshNeighbors& neighbors, const RateModel& rate, int rounds, TriangleMesh* mesh) {
  const bool bits_matter = rate.distortion_per_bit > 0;
  FitToSurface(target, neighbors, rate, bits_matter ? LinearPredictions::OfFlaps(neighbors) : LinearPredictions(1), rounds, mesh);
}

void FitToSurface(const FitTarget& target, const MeshNeighbors& neighbors, const RateModel& rate, const LinearPredictions& predictions, int rounds,
                  TriangleMesh* mesh) {
  const std::vector<Vec3f> first = mesh->positions;
  for (int round = 0; round < rounds; ++round) {
    const DistanceModel model = target.ModelAt(*mesh, neighbors);
    const Moves moves = RoundSystem(model, neighbors, rate, predictions, *mesh).Solve();
    const std::vector<Vec3f> before = mesh->positions;
    for (size_t v = 0; v < moves.size(); ++v) mesh->positions[v] = Vec3Cast<float>(Vec3Cast<double>(before[v]) + moves[v]);
    UndoExcess(target, before, mesh);
    if (rate.distortion_per_bit > 0) UndoRetreat(target, first, before, neighbors, mesh);
    UndoFlips(before, neighbors, mesh);
  }
}

}  // namespace lacerta
