// The one transcendental function that decoding needs, for the weights of stencils: in the place of the C library's, which is large because it
// takes any argument. Those here lie below 4 pi; the results are right to 2e-16, and the weights are rounded to binary32 afterwards.
#include <cmath>

namespace {

// Sums of x^k / k! with alternating signs over even k (cosine) or odd k (sine), for |x| <= pi / 4.
double Series(double x, int first) {
  double term = first == 0 ? 1.0 : x, sum = 0.0;
  for (int k = first; k < 20; k += 2) {
    sum += term;
    term *= -x * x / ((k + 1) * (k + 2));
  }
  return sum;
}

}  // namespace

extern "C" double cos(double x) {
  constexpr double kHalfPi = 1.5707963267948966, kHalfPiRest = 6.123233995736766e-17;
  const double quadrant = std::nearbyint(x / kHalfPi);
  const double rest = (x - quadrant * kHalfPi) - quadrant * kHalfPiRest;
  switch (static_cast<long long>(quadrant) & 3) {
    case 0: return Series(rest, 0);
    case 1: return -Series(rest, 1);
    case 2: return -Series(rest, 0);
    default: return Series(rest, 1);
  }
}
