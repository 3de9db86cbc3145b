#include "encoder/allocation/generalized_gaussian.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace lacerta {
namespace {

constexpr double kLn2 = 0.69314718055994530942;
constexpr int kNumExactBins = 24;  // on either side of the zero bin

// sum over n of z^n / ((s + 1) ... (s + n)), which is P(s, z) s G(s) / (z^s e^-z).
double LowerSeries(double s, double z) {
  double term = 1.0, sum = 1.0;
  for (int n = 1; n < 500 && term > sum * 1e-17; ++n) {
    term *= z / (s + n);
    sum += term;
  }
  return sum;
}

// The continued fraction of Q(s, z) G(s) / (z^s e^-z), evaluated forwards by the modified method of Lentz.
double UpperFraction(double s, double z) {
  constexpr double kTiny = 1e-300;
  double b = z + 1.0 - s;
  double c = 1.0 / kTiny;
  double d = 1.0 / b;
  double value = d;
  for (int n = 1; n < 500; ++n) {
    const double a = -n * (n - s);
    b += 2.0;
    d = a * d + b;
    c = b + a / c;
    d = 1.0 / (std::fabs(d) < kTiny ? kTiny : d);
    if (std::fabs(c) < kTiny) c = kTiny;
    value *= c * d;
    if (std::fabs(c * d - 1.0) < 1e-16) break;
  }
  return value;
}

IncompleteGamma IncompleteGammaWith(double s, double z, double gamma_of_s) {
  if (z <= 0.0) return {0.0, 1.0};
  const double scale = std::exp(s * std::log(z) - z) / gamma_of_s;
  if (z < s + 1.0) {
    const double lower = std::min(1.0, scale * LowerSeries(s, z) / s);
    return {lower, 1.0 - lower};
  }
  const double upper = std::min(1.0, scale * UpperFraction(s, z));
  return {1.0 - upper, upper};
}

// Constants of one shape.
struct Shape {
  explicit Shape(double shape)
      : alpha(shape),
        gamma{std::tgamma(1.0 / shape), std::tgamma(2.0 / shape), std::tgamma(3.0 / shape)},
        b(std::sqrt(gamma[2] / gamma[0])),
        a(b * shape / (2.0 * gamma[0])),
        moment_scale{0.5, gamma[1] / (2.0 * b * gamma[0]), 0.5} {}

  double alpha;
  std::array<double, 3> gamma;         // G(1/alpha), G(2/alpha), G(3/alpha)
  double b, a;                         // of the density
  std::array<double, 3> moment_scale;  // int_0^inf x^k p for k = 0, 1, 2
};

// The density and the partial moments at one bin border x >= 0.
struct Border {
  Border(const Shape& shape, double at)
      : x(at), z(std::pow(shape.b * at, shape.alpha)), density(shape.a * std::exp(-z)) {
    for (int k = 0; k < 3; ++k) moments[k] = IncompleteGammaWith((k + 1) / shape.alpha, z, shape.gamma[k]);
  }

  double x, z, density;
  std::array<IncompleteGamma, 3> moments;
};

// int x^k p between two borders, from whichever end keeps the difference exact.
double MomentBetween(const Shape& shape, const Border& from, const Border& to, int k) {
  const IncompleteGamma& f = from.moments[k];
  const IncompleteGamma& t = to.moments[k];
  return shape.moment_scale[k] * (f.lower < 0.5 ? t.lower - f.lower : f.upper - t.upper);
}

// D, R and their derivatives with respect to q.
struct Sums {
  double d = 0.0, d_prime = 0.0, r = 0.0, r_prime = 0.0;
};

void AddZeroBin(const Shape& shape, const Border& border, double active, Sums* sums) {
  const double mass = 1.0 - active + active * 2.0 * shape.moment_scale[0] * border.moments[0].lower;
  const double mass_prime = active * border.density;  // two ends, each moving by 1/2 per unit of q
  sums->d += active * 2.0 * shape.moment_scale[2] * border.moments[2].lower;
  sums->d_prime += active * border.x * border.x * border.density;
  if (mass <= 0.0) return;
  sums->r -= mass * std::log2(mass);
  sums->r_prime -= mass_prime * (std::log2(mass) + 1.0 / kLn2);
}

// Bins m and -m. The error of a bin is S - M^2 / P with its moments P, M, S; a border u = (m +- 1/2) q moves by u / q.
void AddBinPair(const Shape& shape, const Border& from, const Border& to, double q, Sums* sums) {
  const double mass = MomentBetween(shape, from, to, 0);
  if (mass <= 0.0) return;
  const double centroid = MomentBetween(shape, from, to, 1) / mass;
  const double flow_in = to.density * to.x / q, flow_out = from.density * from.x / q;
  const double mass_prime = flow_in - flow_out;
  const double to_offset = to.x - centroid, from_offset = from.x - centroid;
  sums->d += 2.0 * (MomentBetween(shape, from, to, 2) - centroid * centroid * mass);
  sums->d_prime += 2.0 * (flow_in * to_offset * to_offset - flow_out * from_offset * from_offset);
  sums->r -= 2.0 * mass * std::log2(mass);
  sums->r_prime -= 2.0 * mass_prime * (std::log2(mass) + 1.0 / kLn2);
}

// All bins beyond `from` on both sides: the density is nearly linear across each of them, so that the error is q^2 / 12
// and the entropy is -int p log2(p q).
void AddTails(const Shape& shape, const Border& from, double q, Sums* sums) {
  const double mass = shape.moment_scale[0] * from.moments[0].upper;
  if (mass <= 0.0) return;
  const double s = 1.0 / shape.alpha;
  const double mean_exponent = s * mass + std::pow(from.z, s) * std::exp(-from.z) / (2.0 * shape.gamma[0]);  // int p z
  const double log_peak = std::log2(shape.a * q);
  const double flow_out = from.density * from.x / q;
  sums->d += 2.0 * mass * q * q / 12.0;
  sums->d_prime += 2.0 * (mass * q / 6.0 - flow_out * q * q / 12.0);
  sums->r += 2.0 * (mean_exponent / kLn2 - log_peak * mass);
  sums->r_prime += 2.0 * (flow_out * (log_peak - from.z / kLn2) - mass / (q * kLn2));
}

}  // namespace

IncompleteGamma RegularizedIncompleteGamma(double s, double z) { return IncompleteGammaWith(s, z, std::tgamma(s)); }

double GeneralizedGaussianDensity(double alpha, double x) {
  const Shape shape(alpha);
  return shape.a * std::exp(-std::pow(shape.b * std::fabs(x), alpha));
}

double MomentRatio(double alpha) {
  const double g2 = std::tgamma(2.0 / alpha);
  return g2 * g2 / (std::tgamma(1.0 / alpha) * std::tgamma(3.0 / alpha));
}

GeneralizedGaussianFit FitGeneralizedGaussian(Span<float> samples, Centering centering) {
  GeneralizedGaussianFit fit;
  if (samples.empty()) return fit;
  const double count = static_cast<double>(samples.size());
  if (centering == Centering::kMean) {
    for (const float x : samples) fit.mean += x;
    fit.mean /= count;
  }
  double absolute = 0.0, squared = 0.0;
  for (const float x : samples) {
    const double offset = x - fit.mean;
    absolute += std::fabs(offset);
    squared += offset * offset;
  }
  fit.sigma = std::sqrt(squared / count);
  // What rounding leaves of a constant set is no spread.
  if (fit.sigma <= std::fabs(fit.mean) * std::numeric_limits<float>::epsilon()) fit.sigma = 0.0;
  if (fit.sigma <= 0.0) return fit;
  const double ratio = absolute * absolute / (count * squared);
  double low = kMinAlpha, high = kMaxAlpha;
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (low + high);
    (MomentRatio(middle) < ratio ? low : high) = middle;
  }
  fit.alpha = 0.5 * (low + high);
  return fit;
}

QuantizerPoint EvaluateUniformQuantizer(double alpha, double q, double active) {
  constexpr double kNoMass = 1e-18;
  const Shape shape(alpha);
  const double active_q = q * std::sqrt(active);  // in units of the standard deviation of the active samples
  Sums outer;                                     // all bins but the zero bin, of the active samples alone
  Border from(shape, 0.5 * active_q);
  Sums sums;
  AddZeroBin(shape, from, active, &sums);
  const double outer_mass = 2.0 * shape.moment_scale[0] * from.moments[0].upper, outer_mass_prime = -from.density;
  for (int m = 1; m <= kNumExactBins && from.moments[0].upper > kNoMass; ++m) {
    const Border to(shape, (m + 0.5) * active_q);
    AddBinPair(shape, from, to, active_q, &outer);
    from = to;
  }
  AddTails(shape, from, active_q, &outer);
  // A bin of mass P among the active samples has active * P in all.
  sums.d += active * outer.d;
  sums.d_prime += active * outer.d_prime;
  sums.r += active * (outer.r - std::log2(active) * outer_mass);
  sums.r_prime += active * (outer.r_prime - std::log2(active) * outer_mass_prime);
  return {sums.d / active, sums.r, -sums.d_prime / (active * sums.r_prime)};
}

}  // namespace lacerta
