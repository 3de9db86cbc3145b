// Tables of rate and step against the slope of the rate-distortion curve: [Payan & Antonini 2004] Sec. IV, the tables
// [R; ln(-h)] and [q; ln(-h)] that make bit allocation a search over one number.
//
// Departs from the paper: a table is made for the very alpha of a set, in well under a millisecond, instead of being
// picked from a stored grid of shapes.
#ifndef LACERTA_ENCODER_ALLOCATION_RATE_DISTORTION_TABLE_H_
#define LACERTA_ENCODER_ALLOCATION_RATE_DISTORTION_TABLE_H_

#include "encoder/allocation/monotone_cubic.h"

namespace lacerta {

// The operational rate-distortion curve of the uniform quantizer on a generalized Gaussian of variance 1, mixed with
// zeros. Steps are in units of sigma, rates in bits per sample, distortions in units of sigma^2, slopes -h = -dD/dR.
class RateDistortionTable {
 public:
  // alpha is brought into [kMinAlpha, kMaxAlpha]; active: share in (0, 1] of the samples that are not exactly zero.
  explicit RateDistortionTable(double alpha, double active = 1.0);

  double alpha() const { return alpha_; }

  // ln(-h) from the finest tabulated step (2^-24) to the coarsest: the one that codes next to nothing or, for alpha >
  // 2, where the curve stops being convex.
  double min_log_slope() const { return rate_of_slope_.min_x(); }
  double max_log_slope() const { return rate_of_slope_.max_x(); }

  // Rate and step at ln(-h); values outside the table count as its nearer end.
  double RateAtSlope(double log_slope) const { return rate_of_slope_(log_slope); }
  double StepAtSlope(double log_slope) const;

  // Rate and distortion at a step > 0; +inf is a set that is not coded: rate 0, distortion 1.
  double RateAtStep(double step) const;
  double DistortionAtStep(double step) const;

 private:
  struct Knots;
  explicit RateDistortionTable(const Knots& knots);

  double alpha_;
  MonotoneCubic rate_of_slope_;      // [R; ln(-h)]
  MonotoneCubic log_step_of_slope_;  // [ln q; ln(-h)]
  MonotoneCubic rate_of_log_step_;
  MonotoneCubic log_distortion_of_log_step_;
};

}  // namespace lacerta

#endif  // LACERTA_ENCODER_ALLOCATION_RATE_DISTORTION_TABLE_H_
