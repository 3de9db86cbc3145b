#include "baselines/loop_wavelet.h"

#include <Eigen/IterativeLinearSolvers>
#include <algorithm>
#include <cmath>

namespace lacerta::baselines {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kTolerance = 1e-10;  // of the solvers, far below any step
constexpr int kMostIterations = 500;

// Weight of each neighbor of an inner vertex [Loop 1987].
double NeighborWeight(int valence) {
  const double c = 0.375 + 0.25 * std::cos(2 * kPi / valence);
  return (0.625 - c * c) / valence;
}

Eigen::MatrixX3d ToMatrix(const Vec3f* values, size_t count) {
  Eigen::MatrixX3d m(count, 3);
  for (size_t i = 0; i < count; ++i) m.row(static_cast<Eigen::Index>(i)) << values[i].x, values[i].y, values[i].z;
  return m;
}

void Append(const Eigen::MatrixX3d& m, std::vector<Vec3f>* values) {
  for (Eigen::Index i = 0; i < m.rows(); ++i) values->push_back(Vec3Cast<float>(Vec3d{m(i, 0), m(i, 1), m(i, 2)}));
}

}  // namespace

LoopWavelet::LoopWavelet(const Topology& t)
    : old_(t.num_vertices, t.num_vertices), new_(t.num_edges(), t.num_vertices) {
  std::vector<Eigen::Triplet<double>> old_entries, new_entries;
  std::vector<double> own(t.num_vertices, 1.0);
  for (uint32_t e = 0; e < t.num_edges(); ++e) {
    const bool border = t.is_border(e);
    for (int end = 0; end < 2; ++end) {
      const uint32_t v = t.edges[e][end], other = t.edges[e][1 - end];
      new_entries.emplace_back(e, v, border ? 0.5 : 0.375);
      // A vertex on the border follows its two neighbors there; a corner stays.
      if (t.role[v] == CurveRole::kCorner || (t.role[v] == CurveRole::kCurve && !border)) continue;
      const double weight = t.role[v] == CurveRole::kCurve ? 0.125 : NeighborWeight(t.valence[v]);
      old_entries.emplace_back(v, other, weight);
      own[v] -= weight;
    }
    if (border) continue;
    for (const uint32_t f : t.edge_faces[e]) new_entries.emplace_back(e, OppositeVertex(t, f, e), 0.125);
  }
  for (uint32_t v = 0; v < t.num_vertices; ++v) old_entries.emplace_back(v, v, own[v]);
  old_.setFromTriplets(old_entries.begin(), old_entries.end());
  new_.setFromTriplets(new_entries.begin(), new_entries.end());
  old_transposed_ = old_.transpose();
  new_transposed_ = new_.transpose();
}

StatusOr<LoopWavelet::Bands> LoopWavelet::Analyze(const std::vector<Vec3f>& fine) const {
  const auto num_old = static_cast<size_t>(old_.rows());
  const Eigen::MatrixX3d x_old = ToMatrix(fine.data(), num_old),
                         x_new = ToMatrix(fine.data() + num_old, fine.size() - num_old);
  const Matrix normal = Matrix(old_transposed_ * old_) + Matrix(new_transposed_ * new_);
  Eigen::ConjugateGradient<Matrix, Eigen::Lower | Eigen::Upper> solver(normal);
  solver.setTolerance(kTolerance);
  solver.setMaxIterations(kMostIterations);
  const Eigen::MatrixX3d c = solver.solveWithGuess(old_transposed_ * x_old + new_transposed_ * x_new, x_old);
  if (solver.info() != Eigen::Success) return InternalError("the least-squares fit of a Loop surface did not converge");
  Bands bands;
  Append(c, &bands.coarse);
  Append(x_new - new_ * c, &bands.detail);
  return bands;
}

StatusOr<Eigen::MatrixX3d> LoopWavelet::OldPartOfDetails(const Eigen::MatrixX3d& detail) const {
  Eigen::BiCGSTAB<Matrix> solver(old_transposed_);
  solver.setTolerance(kTolerance);
  solver.setMaxIterations(kMostIterations);
  const Eigen::MatrixX3d right = new_transposed_ * detail;
  const Eigen::MatrixX3d old = solver.solve(right);
  if (solver.info() != Eigen::Success) return InternalError("Loop wavelets did not converge");
  return Eigen::MatrixX3d(-old);
}

StatusOr<std::vector<Vec3f>> LoopWavelet::Synthesize(const Bands& bands) const {
  const Eigen::MatrixX3d c = ToMatrix(bands.coarse.data(), bands.coarse.size());
  const Eigen::MatrixX3d d = ToMatrix(bands.detail.data(), bands.detail.size());
  LACERTA_ASSIGN_OR_RETURN(const Eigen::MatrixX3d old, OldPartOfDetails(d));
  std::vector<Vec3f> fine;
  Append(old_ * c + old, &fine);
  Append(new_ * c + d, &fine);
  return fine;
}

std::vector<Vec3f> LoopWavelet::Subdivide(const std::vector<Vec3f>& coarse) const {
  const Eigen::MatrixX3d c = ToMatrix(coarse.data(), coarse.size());
  std::vector<Vec3f> fine;
  Append(old_ * c, &fine);
  Append(new_ * c, &fine);
  return fine;
}

}  // namespace lacerta::baselines
