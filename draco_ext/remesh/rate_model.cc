#include "remesh/rate_model.h"

#include <cmath>

namespace lacerta {
namespace {

// About what Draco's coder spends, with a third of a vertex's bits in each of the three flaps that a vertex has on average.
constexpr double kErrorScale = 4.0 / 3, kBitsScale = 0.5;

}  // namespace

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

LinearPredictions LinearPredictions::OfFlaps(const MeshNeighbors& neighbors) {
  LinearPredictions result(1);
  for (const auto& [a, b, c, d] : neighbors.flaps) {
    result.Add(a, 1);
    result.Add(b, 1);
    result.Add(c, -1);
    result.Add(d, -1);
    result.EndPrediction();
  }
  return result;
}

}  // namespace lacerta
