// The generalized Gaussian (GGD) as a model of one coefficient set, and the uniform quantizer on it.
//
//   p(x) = a exp(-|b x|^alpha),  b = sqrt(G(3/alpha) / G(1/alpha)),  a = b alpha / (2 G(1/alpha))
//
// has variance 1 and mean 0. alpha = 1 is the Laplacian and 2 the Gaussian; wavelet details lie mostly between 0.4
// and 1. [Payan & Antonini 2004] Sec. IV; rate and distortion after [Parisot, Antonini, Barlaud 2003].
//
// Goes beyond the paper where samples are exactly zero, as nearly all tangential parts of a normal mesh are: no GGD is
// that peaked, and with the smallest alpha the rate of such a set came out ten to forty times too high. A set is then a
// mixture: a share `active` of the samples follows the GGD, the rest is zero. active = 1 is the paper.
#ifndef LACERTA_ENCODER_ALLOCATION_GENERALIZED_GAUSSIAN_H_
#define LACERTA_ENCODER_ALLOCATION_GENERALIZED_GAUSSIAN_H_

#include "lacerta/mesh.h"

namespace lacerta {

// Range of shapes that the model admits. Below, a set of a few outliers among zeros would be taken for a density that
// no finite sum of bins describes; above, the density is a box and alpha no longer matters.
inline constexpr double kMinAlpha = 0.2;
inline constexpr double kMaxAlpha = 4.0;

// Regularized incomplete gamma functions P (lower) and Q = 1 - P (upper), each with small relative error where it is
// the small one of the two. s > 0, z >= 0. Series below z = s + 1, continued fraction above [Abramowitz &
// Stegun 6.5.29, 6.5.31].
struct IncompleteGamma {
  double lower = 0.0, upper = 1.0;
};
IncompleteGamma RegularizedIncompleteGamma(double s, double z);

// Density of unit variance and shape alpha > 0 at x.
double GeneralizedGaussianDensity(double alpha, double x);

// (E|x|)^2 / E[x^2] of the shape: 0.5 for alpha = 1, 2/pi for alpha = 2. Increases with alpha.
double MomentRatio(double alpha);

// Shape and scale of samples by moments, more robust than kurtosis on short sets.
struct GeneralizedGaussianFit {
  double mean = 0.0;
  double sigma = 0.0;  // standard deviation about `mean`; 0 for an empty or constant set
  double alpha = 1.0;  // in [kMinAlpha, kMaxAlpha]; 1 where sigma is 0
};
enum class Centering {
  kZero,  // the mean is taken to be zero: details, whose quantizer is centered there
  kMean,  // the mean is measured: base positions, whose origin means nothing
};
// samples: finite values, any number.
GeneralizedGaussianFit FitGeneralizedGaussian(Span<float> samples, Centering centering);

// The uniform quantizer of step q (bin m reaches from (m - 1/2) q to (m + 1/2) q, values become their bin's centroid)
// on the mixture of shape alpha and share `active` that has variance 1.
struct QuantizerPoint {
  double distortion = 0.0;  // mean squared error, 0..1
  double rate = 0.0;        // entropy of the bin index, bits per sample
  double slope = 0.0;       // -h = -(dD/dq) / (dR/dq) > 0
};
// alpha in [kMinAlpha, kMaxAlpha]; active in (0, 1]; q sqrt(active) from 1e-8 to where P(|x| > q/2) is about 1e-12. The
// derivatives are exact; bins beyond the first 24 are summed as the integral that they approach there.
QuantizerPoint EvaluateUniformQuantizer(double alpha, double q, double active = 1.0);

}  // namespace lacerta

#endif  // LACERTA_ENCODER_ALLOCATION_GENERALIZED_GAUSSIAN_H_
