// Two-channel filter bank of Loop subdivision on one level, for progressive geometry compression [Khodakovsky,
// Schroeder, Sweldens 2000, Sec. 3.1].
//
// Synthesis is x = P c + Q d with P the subdivision of [Loop 1987]. The paper takes Q as the quadrature mirror of P,
// which is orthogonal to P on the regular lattice, and analyses by solving the sparse system. Its filters at
// extraordinary vertices and borders are not published in closed form, so Q is here the exact orthogonal complement:
// with E the rows of P of old vertices and O those of new ones,
//   P = [E; O],   Q = [-E^-T O^T; I],   P^T Q = 0.
// Analysis: c minimizes |x - P c|^2, and d is what is left at the new vertices. Departs from the paper where its Q is
// local and only nearly orthogonal; for one number of coefficients ours leaves the least squared error per level that
// any Q does.
#ifndef LACERTA_TESTS_BASELINES_LOOP_WAVELET_H_
#define LACERTA_TESTS_BASELINES_LOOP_WAVELET_H_

#include <Eigen/SparseCore>
#include <vector>

#include "common/subdivision.h"
#include "lacerta/mesh.h"
#include "lacerta/status.h"

namespace lacerta::baselines {

class LoopWavelet {
 public:
  explicit LoopWavelet(const Topology& coarse);

  struct Bands {
    std::vector<Vec3f> coarse;  // #V of the coarse level: control points
    std::vector<Vec3f> detail;  // #E, in world coordinates
  };
  // fine: #V + #E. Fails with kInternal where a solver does not converge.
  StatusOr<Bands> Analyze(const std::vector<Vec3f>& fine) const;
  StatusOr<std::vector<Vec3f>> Synthesize(const Bands& bands) const;

  // P c: #V + #E.
  std::vector<Vec3f> Subdivide(const std::vector<Vec3f>& coarse) const;

 private:
  using Matrix = Eigen::SparseMatrix<double, Eigen::RowMajor>;
  // -E^-T O^T d: #V.
  StatusOr<Eigen::MatrixX3d> OldPartOfDetails(const Eigen::MatrixX3d& detail) const;

  Matrix old_, new_;  // E: #V x #V, O: #E x #V
  Matrix old_transposed_, new_transposed_;
};

}  // namespace lacerta::baselines

#endif  // LACERTA_TESTS_BASELINES_LOOP_WAVELET_H_
