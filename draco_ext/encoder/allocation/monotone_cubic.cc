#include "encoder/allocation/monotone_cubic.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace lacerta {

MonotoneCubic::MonotoneCubic(std::vector<double> xs, std::vector<double> ys) : xs_(std::move(xs)), ys_(std::move(ys)) {
  const size_t n = xs_.size();
  std::vector<double> secants(n - 1);
  for (size_t i = 0; i + 1 < n; ++i) secants[i] = (ys_[i + 1] - ys_[i]) / (xs_[i + 1] - xs_[i]);
  slopes_.assign(n, 0.0);
  slopes_.front() = secants.front();
  slopes_.back() = secants.back();
  for (size_t i = 1; i + 1 < n; ++i) {
    if (secants[i - 1] * secants[i] <= 0.0) continue;  // an extremum stays flat
    const double left = xs_[i] - xs_[i - 1], right = xs_[i + 1] - xs_[i];
    const double w1 = 2.0 * right + left, w2 = right + 2.0 * left;
    slopes_[i] = (w1 + w2) / (w1 / secants[i - 1] + w2 / secants[i]);  // weighted harmonic mean
  }
}

double MonotoneCubic::operator()(double x) const {
  x = std::clamp(x, min_x(), max_x());
  const auto above = std::upper_bound(xs_.begin() + 1, xs_.end() - 1, x);
  const size_t i = static_cast<size_t>(above - xs_.begin()) - 1;
  const double width = xs_[i + 1] - xs_[i];
  const double t = (x - xs_[i]) / width, u = 1.0 - t;
  return ys_[i] * u * u * (1.0 + 2.0 * t) + ys_[i + 1] * t * t * (1.0 + 2.0 * u) +
         width * t * u * (slopes_[i] * u - slopes_[i + 1] * t);
}

}  // namespace lacerta
