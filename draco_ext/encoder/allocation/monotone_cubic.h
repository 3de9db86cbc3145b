// A smooth curve through tabulated points that rises and falls only where they do.
#ifndef LACERTA_ENCODER_ALLOCATION_MONOTONE_CUBIC_H_
#define LACERTA_ENCODER_ALLOCATION_MONOTONE_CUBIC_H_

#include <vector>

namespace lacerta {

// Piecewise cubic Hermite interpolation with the slopes of [Fritsch, Butland 1984]: monotone wherever the points are.
class MonotoneCubic {
 public:
  // xs strictly increasing, ys of the same size >= 2; all finite.
  MonotoneCubic(std::vector<double> xs, std::vector<double> ys);

  // Value at x; x outside the table counts as its nearer end.
  double operator()(double x) const;

  double min_x() const { return xs_.front(); }
  double max_x() const { return xs_.back(); }

 private:
  std::vector<double> xs_, ys_, slopes_;
};

}  // namespace lacerta

#endif  // LACERTA_ENCODER_ALLOCATION_MONOTONE_CUBIC_H_
