#include "remesh/mesh_fit.h"

#include <algorithm>
#include <cmath>

#include "geometry/vertex_area_vectors.h"
#include "remesh/folds.h"

namespace lacerta {
namespace {

using Moves = std::vector<Vec3d>;

// The quadratic form that one round minimizes: the model, damped, and the bits as squares of the flaps' errors.
class RoundSystem {
 public:
  RoundSystem(const DistanceModel& model, const MeshNeighbors& neighbors, const RateModel& rate, const TriangleMesh& mesh)
      : model_(model), neighbors_(neighbors), diagonal_(model.diagonal), gradient_(model.gradient) {
    double mean_trace = 0;
    for (const Symmetric3& block : diagonal_) mean_trace += block.Trace();
    mean_trace /= static_cast<double>(diagonal_.size());
    for (size_t v = 0; v < diagonal_.size(); ++v) diagonal_[v].AddScaledIdentity(kDamping * (model.diagonal[v].Trace() + 0.01 * mean_trace));
    preconditioner_ = diagonal_;
    if (!(rate.distortion_per_bit > 0)) return;
    for (const auto& [a, b, c, d] : neighbors.flaps) {
      const Vec3d r = Vec3Cast<double>(mesh.positions[a]) + Vec3Cast<double>(mesh.positions[b]) - Vec3Cast<double>(mesh.positions[c]) -
                      Vec3Cast<double>(mesh.positions[d]);
      const double weight = rate.distortion_per_bit * rate.BitSlope(SquaredNorm(r));
      flap_weights_.push_back(weight);
      for (const uint32_t v : {a, b, c, d}) preconditioner_[v].AddScaledIdentity(weight);
      gradient_[a] += r * weight;
      gradient_[b] += r * weight;
      gradient_[c] -= r * weight;
      gradient_[d] -= r * weight;
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

  Moves Multiply(const Moves& x) const {
    Moves result(x.size());
    for (size_t v = 0; v < x.size(); ++v) result[v] = diagonal_[v] * x[v];
    for (size_t e = 0; e < neighbors_.edges.size(); ++e) {
      const auto [u, v] = neighbors_.edges[e];
      result[u] += model_.off_diagonal[e] * x[v];
      result[v] += model_.off_diagonal[e] * x[u];
    }
    for (size_t i = 0; i < flap_weights_.size(); ++i) {
      const auto& [a, b, c, d] = neighbors_.flaps[i];
      const Vec3d r = (x[a] + x[b] - x[c] - x[d]) * flap_weights_[i];
      result[a] += r;
      result[b] += r;
      result[c] -= r;
      result[d] -= r;
    }
    return result;
  }

  const DistanceModel& model_;
  const MeshNeighbors& neighbors_;
  std::vector<Symmetric3> diagonal_, preconditioner_;
  Moves gradient_;
  std::vector<double> flap_weights_;
};

// Puts back vertices that went too far from the input.
void UndoExcess(const FitTarget& target, const std::vector<Vec3f>& before, TriangleMesh* mesh) {
  for (size_t v = 0; v < before.size(); ++v) {
    const double excess = target.Excess(mesh->positions[v]);
    if (excess > 0 && excess > target.Excess(before[v])) mesh->positions[v] = before[v];
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

// About what Draco's coder spends, with a third of a vertex's bits in each of the three flaps that a vertex has on average.
constexpr double kErrorScale = 4.0 / 3, kBitsScale = 0.5;

RateModel RateModel::For(double lattice_distortion, size_t num_vertices) {
  // D ~ 4^-b in the b bits of each coordinate: the slope of D over all bits.
  constexpr double kLn2 = 0.6931471805599453;
  return {StepFor(lattice_distortion), 2 * kLn2 * lattice_distortion / (3 * static_cast<double>(num_vertices))};
}

double RateModel::StepFor(double lattice_distortion) {
  // Rounding alone errs by step / sqrt(12) along the normal; the descent leaves an eighth of its square.
  constexpr double kSquaredStep = 12 * 8;
  return std::sqrt(kSquaredStep * lattice_distortion);
}

double RateModel::BitsOfFlap(double r2) const { return kBitsScale * std::log2(1 + kErrorScale * r2 / (step * step)); }

double RateModel::BitSlope(double r2) const {
  constexpr double kLn2 = 0.6931471805599453;
  return kBitsScale / kLn2 * kErrorScale / (step * step + kErrorScale * r2);
}

void FitToSurface(const FitTarget& target, const MeshNeighbors& neighbors, const RateModel& rate, int rounds, TriangleMesh* mesh) {
  for (int round = 0; round < rounds; ++round) {
    const DistanceModel model = target.ModelAt(*mesh, neighbors);
    const Moves moves = RoundSystem(model, neighbors, rate, *mesh).Solve();
    const std::vector<Vec3f> before = mesh->positions;
    for (size_t v = 0; v < moves.size(); ++v) mesh->positions[v] = Vec3Cast<float>(Vec3Cast<double>(before[v]) + moves[v]);
    UndoExcess(target, before, mesh);
    UndoFlips(before, neighbors, mesh);
  }
}

}  // namespace lacerta
