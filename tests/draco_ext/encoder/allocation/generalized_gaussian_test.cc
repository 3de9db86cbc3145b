#include "encoder/allocation/generalized_gaussian.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace lacerta {
namespace {

// Quantile of the density, by bisection on its distribution function.
double Quantile(double alpha, double probability) {
  const double b = std::sqrt(std::tgamma(3 / alpha) / std::tgamma(1 / alpha));
  const double side = std::fabs(2 * probability - 1);
  double low = 0.0, high = 1e4;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (low + high);
    (RegularizedIncompleteGamma(1 / alpha, std::pow(b * middle, alpha)).lower < side ? low : high) = middle;
  }
  return probability < 0.5 ? -low : low;
}

std::vector<float> Samples(double alpha, double sigma, int count) {
  std::vector<float> samples;
  for (int i = 0; i < count; ++i) samples.push_back(static_cast<float>(sigma * Quantile(alpha, (i + 0.5) / count)));
  return samples;
}

TEST(IncompleteGammaTest, HasClosedForms) {
  for (const double z : {1e-6, 0.01, 0.3, 1.0, 1.9, 2.1, 5.0, 12.0, 40.0}) {
    SCOPED_TRACE(z);
    const IncompleteGamma one = RegularizedIncompleteGamma(1.0, z);  // P = 1 - e^-z
    EXPECT_NEAR(one.lower, -std::expm1(-z), 1e-13 * -std::expm1(-z));
    EXPECT_NEAR(one.upper, std::exp(-z), 1e-13 * std::exp(-z));
    const IncompleteGamma half = RegularizedIncompleteGamma(0.5, z);  // P = erf(sqrt z)
    EXPECT_NEAR(half.lower, std::erf(std::sqrt(z)), 1e-13 * std::erf(std::sqrt(z)));
    EXPECT_NEAR(half.upper, std::erfc(std::sqrt(z)), 1e-12 * std::erfc(std::sqrt(z)) + 1e-15);
    const IncompleteGamma three = RegularizedIncompleteGamma(3.0, z);  // Q = e^-z (1 + z + z^2 / 2)
    const double q3 = std::exp(-z) * (1 + z + z * z / 2);
    EXPECT_NEAR(three.upper, q3, 1e-12 * q3);
    EXPECT_NEAR(three.lower + three.upper, 1.0, 1e-14);
  }
  EXPECT_EQ(RegularizedIncompleteGamma(2.0, 0.0).lower, 0.0);
  EXPECT_EQ(RegularizedIncompleteGamma(2.0, 0.0).upper, 1.0);
  EXPECT_EQ(RegularizedIncompleteGamma(2.0, 1e6).lower, 1.0);
}

TEST(GeneralizedGaussianTest, DensityIsLaplacianAndGaussian) {
  for (const double x : {0.0, 0.3, -1.2, 4.0}) {
    EXPECT_NEAR(GeneralizedGaussianDensity(1, x), std::exp(-std::sqrt(2.0) * std::fabs(x)) / std::sqrt(2.0), 1e-13);
    EXPECT_NEAR(GeneralizedGaussianDensity(2, x), std::exp(-x * x / 2) / std::sqrt(2 * 3.14159265358979323846), 1e-13);
  }
}

TEST(GeneralizedGaussianTest, DensityIntegratesToVarianceOne) {
  for (const double alpha : {0.5, 0.7, 1.0, 1.7, 3.0}) {
    double mass = 0.0, variance = 0.0;
    constexpr double kStep = 1e-3;
    for (double u = -12.0 + kStep / 2; u < 7.0; u += kStep) {  // x = e^u
      const double x = std::exp(u), p = 2 * GeneralizedGaussianDensity(alpha, x) * x * kStep;
      mass += p;
      variance += p * x * x;
    }
    EXPECT_NEAR(mass, 1.0, 1e-4) << alpha;
    EXPECT_NEAR(variance, 1.0, 1e-4) << alpha;
  }
}

TEST(GeneralizedGaussianTest, MomentRatioHasKnownValues) {
  EXPECT_NEAR(MomentRatio(0.3), 0.1501, 5e-5);
  EXPECT_NEAR(MomentRatio(0.5), 0.3000, 5e-5);
  EXPECT_NEAR(MomentRatio(0.7), 0.4025, 5e-5);
  EXPECT_NEAR(MomentRatio(1.0), 0.5, 1e-12);
  EXPECT_NEAR(MomentRatio(1.5), 0.5889, 5e-5);
  EXPECT_NEAR(MomentRatio(2.0), 2 / 3.14159265358979323846, 1e-12);
}

TEST(FitTest, RecoversShapeAndScale) {
  for (const double alpha : {0.5, 0.7, 1.0, 1.5, 2.0, 3.0}) {
    SCOPED_TRACE(alpha);
    const GeneralizedGaussianFit fit = FitGeneralizedGaussian(Samples(alpha, 0.01, 8000), Centering::kZero);
    EXPECT_NEAR(fit.sigma, 0.01, 0.01 * 0.01);
    EXPECT_NEAR(fit.alpha, alpha, 0.02 * alpha);
    EXPECT_EQ(fit.mean, 0.0);
  }
}

TEST(FitTest, CentersOnlyWhenAsked) {
  std::vector<float> samples = Samples(1.0, 1.0, 4000);
  for (float& x : samples) x += 5.0f;
  const GeneralizedGaussianFit centered = FitGeneralizedGaussian(samples, Centering::kMean);
  EXPECT_NEAR(centered.mean, 5.0, 1e-4);
  EXPECT_NEAR(centered.sigma, 1.0, 0.01);
  EXPECT_NEAR(centered.alpha, 1.0, 0.02);
  EXPECT_NEAR(FitGeneralizedGaussian(samples, Centering::kZero).sigma, std::sqrt(26.0), 0.01);
}

TEST(FitTest, ClampsShapeAndGuardsDegenerateSets) {
  std::vector<float> outlier(100000, 0.0f);
  outlier[5] = 1.0f;
  const GeneralizedGaussianFit peaked = FitGeneralizedGaussian(outlier, Centering::kZero);
  EXPECT_NEAR(peaked.alpha, kMinAlpha, 1e-9);
  EXPECT_NEAR(peaked.sigma, std::sqrt(1e-5), 1e-9);
  EXPECT_NEAR(FitGeneralizedGaussian(std::vector<float>{-1, 1, -1, 1}, Centering::kZero).alpha, kMaxAlpha, 1e-9);
  for (const Centering centering : {Centering::kZero, Centering::kMean}) {
    const GeneralizedGaussianFit empty = FitGeneralizedGaussian(std::vector<float>{}, centering);
    EXPECT_EQ(empty.sigma, 0.0);
    EXPECT_EQ(empty.alpha, 1.0);
    EXPECT_EQ(FitGeneralizedGaussian(std::vector<float>(9, 0.0f), centering).sigma, 0.0);
  }
  EXPECT_EQ(FitGeneralizedGaussian(std::vector<float>(1001, 0.1f), Centering::kMean).sigma, 0.0);
}

struct Known {
  double alpha, q, distortion, rate, slope;
};

TEST(UniformQuantizerTest, HasKnownValues) {
  const std::vector<Known> table = {{0.5, 0.5, 0.017246, 2.52385, 0.02333}, {0.5, 1, 0.056562, 1.64716, 0.07712},
                                    {0.5, 2, 0.160406, 0.90083, 0.23355},   {0.7, 1, 0.065750, 1.86575, 0.08667},
                                    {1, 0.5, 0.019934, 2.96577, 0.02731},   {1, 1, 0.072297, 2.01421, 0.09613},
                                    {1, 2, 0.226579, 1.12699, 0.28082},     {1, 4, 0.563521, 0.38498, 0.71401},
                                    {2, 0.5, 0.020408, 3.06197, 0.02829},   {2, 1, 0.076915, 2.10483, 0.10659},
                                    {2, 2, 0.253507, 1.24120, 0.34367}};
  for (const Known& known : table) {
    SCOPED_TRACE(::testing::Message() << "alpha " << known.alpha << " q " << known.q);
    const QuantizerPoint point = EvaluateUniformQuantizer(known.alpha, known.q);
    EXPECT_NEAR(point.distortion, known.distortion, 0.51e-6);
    EXPECT_NEAR(point.rate, known.rate, 0.51e-5);
    EXPECT_NEAR(point.slope, known.slope, 0.51e-5);
  }
}

TEST(UniformQuantizerTest, LaplacianHasAClosedForm) {
  // All bins but the zero bin of a Laplacian are geometric: P_m = (1 - r) r^(m-1) s with s = P(x > q / 2), r =
  // exp(-sqrt 2 q).
  for (const double q : {0.02, 0.3, 1.0, 3.0, 9.0}) {
    const double c = std::sqrt(2.0), s = 0.5 * std::exp(-c * q / 2), r = std::exp(-c * q), p0 = 1 - 2 * s;
    const double rate = -p0 * std::log2(p0) - 2 * s * (std::log2((1 - r) * s) + std::log2(r) * r / (1 - r));
    EXPECT_NEAR(EvaluateUniformQuantizer(1.0, q).rate, rate, 1e-5 * rate) << q;
  }
}

TEST(UniformQuantizerTest, SlopeIsTheDerivative) {
  for (const double alpha : {0.2, 0.4, 0.7, 1.0, 2.0, 4.0}) {
    for (double q = 1e-4; q < 5; q *= 3) {
      const double step = 1e-4 * q;
      const QuantizerPoint below = EvaluateUniformQuantizer(alpha, q - step),
                           above = EvaluateUniformQuantizer(alpha, q + step);
      const double numeric = -(above.distortion - below.distortion) / (above.rate - below.rate);
      EXPECT_NEAR(EvaluateUniformQuantizer(alpha, q).slope, numeric, 1e-5 * numeric) << alpha << " " << q;
    }
  }
}

TEST(UniformQuantizerTest, MixtureWithZerosMatchesDirectSums) {
  // A share of zeros beside a Laplacian: variance 1 in all, so the Laplacian has variance 1 / active.
  for (const double active : {0.003, 0.1, 0.6}) {
    for (const double q : {0.3, 1.0, 4.0, 12.0}) {
      SCOPED_TRACE(::testing::Message() << "active " << active << " q " << q);
      const double c = std::sqrt(2.0 * active);  // of the density c / 2 exp(-c |x|)
      double mass0 = 1 - active * std::exp(-c * q / 2), rate = -mass0 * std::log2(mass0), outer_second = 0.0;
      for (int m = 1; m < 20000; ++m) {
        const double u = (m - 0.5) * q, v = (m + 0.5) * q, eu = std::exp(-c * u), ev = std::exp(-c * v);
        const double mass = 0.5 * active * (eu - ev);
        if (mass < 1e-18) break;
        const double first = 0.5 * active * ((u + 1 / c) * eu - (v + 1 / c) * ev);
        rate -= 2 * mass * std::log2(mass);
        outer_second += 2 * first * first / mass;
      }
      const QuantizerPoint point = EvaluateUniformQuantizer(1.0, q, active);
      EXPECT_NEAR(point.rate, rate, 1e-4 * rate);
      EXPECT_NEAR(point.distortion, 1 - outer_second, 1e-4 * point.distortion);
      const double step = 1e-4 * q;
      const QuantizerPoint below = EvaluateUniformQuantizer(1.0, q - step, active),
                           above = EvaluateUniformQuantizer(1.0, q + step, active);
      EXPECT_NEAR(point.slope, -(above.distortion - below.distortion) / (above.rate - below.rate), 1e-5 * point.slope);
    }
  }
}

TEST(UniformQuantizerTest, ApproachesTheHighRateLimit) {
  const double ln2 = std::log(2.0);
  for (const double alpha : {0.5, 0.7, 1.0, 2.0, 4.0}) {
    for (const double q : {1e-3, 1e-5, 1e-7}) {
      const QuantizerPoint point = EvaluateUniformQuantizer(alpha, q);
      EXPECT_NEAR(point.distortion / (q * q / 12), 1.0, 1e-4) << alpha << " " << q;
      EXPECT_NEAR(point.slope / (2 * ln2 * q * q / 12), 1.0, 1e-4) << alpha << " " << q;
      EXPECT_NEAR(EvaluateUniformQuantizer(alpha, q / 2).rate - point.rate, 1.0, 1e-4);
    }
  }
  // Gaussian: R = 1/2 log2(2 pi e) - log2 q.
  EXPECT_NEAR(EvaluateUniformQuantizer(2.0, 1e-3).rate,
              0.5 * std::log2(2 * 3.14159265358979323846 * std::exp(1.0)) - std::log2(1e-3), 1e-5);
}

}  // namespace
}  // namespace lacerta
