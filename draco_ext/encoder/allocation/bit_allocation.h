// Bit allocation over the coefficient sets of a normal mesh: [Payan & Antonini 2004] Sec. IV, (10)-(13).
//
// Minimizes D = sum w_k sigma_k^2 D_k(q_k / sigma_k) subject to sum a_k R_k(q_k / sigma_k) = target. At the optimum all
// coded sets share one multiplier lambda: h_k = dD_k / dR_k = -lambda a_k / (w_k sigma_k^2). Given lambda, the table
// [q; ln(-h)] of each set's alpha yields its step and [R; ln(-h)] its rate; bisection finds the lambda whose rate is
// the target.
//
// Departs from the paper: a set may be a mixture of zeros and a generalized Gaussian (SetStatistics::active); sets
// without samples or with sigma == 0 are left out of the system; a set whose best step is worse than not coding it
// (alpha > 2 at low rate, where the curve is not convex) is not coded.
#ifndef LACERTA_ENCODER_ALLOCATION_BIT_ALLOCATION_H_
#define LACERTA_ENCODER_ALLOCATION_BIT_ALLOCATION_H_

#include <cstddef>
#include <vector>

#include "common/coefficient_sets.h"
#include "encoder/allocation/rate_distortion_table.h"
#include "encoder/allocation/set_statistics.h"
#include "lacerta/mesh.h"
#include "lacerta/status.h"

namespace lacerta {

// The defaults are the paper.
struct AllocationOptions {
  // Exponent on the energy of a coefficient, E = w / (3 a): 1 minimizes the open-loop error; 0 gives equal high-rate
  // steps to all levels. A closed loop, which corrects coarse errors at finer levels, does best between 0.2 and 0.4.
  // Range 0..2.
  double weight_exponent = 1.0;
  // The step of a tangential set is at least this many times the step of the normal set of its level (where that one is
  // not coded: the step its slope would give at high rate). 0 switches the floor off. 1.5 keeps tiny tangential sets
  // from eating bits.
  double min_tangential_ratio = 0.0;
};

struct BitAllocation {
  std::vector<double> steps;    // per set, model units; +inf = not coded
  std::vector<double> rates;    // per set, predicted bits per sample
  double lambda = 0.0;          // squared model units per bit per sample (with weight_exponent 1)
  double predicted_rate = 0.0;  // sum a_k R_k, bits per sample (one of the 3 #V coordinates of the finest mesh)
  // Mean squared vertex error of the finest mesh, squared model units, with the weights as they are (no exponent).
  double predicted_distortion = 0.0;
};

// The allocation problem of one mesh with its tables, to be solved for as many targets as wanted.
class BitAllocator {
 public:
  // Fails with kInvalidArgument where a statistic or an option is out of range.
  static StatusOr<BitAllocator> Create(Span<SetStatistics> sets, const AllocationOptions& options);

  // Steps at a given multiplier lambda > 0. The rate falls as lambda grows.
  BitAllocation ForSlope(double lambda) const;

  // The allocation whose rate is nearest below target_bits_per_sample > 0. It is the target up to 1e-6 of it, except
  // where a set with alpha > 2 is dropped at once, and except where the target is out of reach: beyond the finest
  // tabulated steps (2^-24 sigma) the finest allocation is returned. Compare predicted_rate. Fails with
  // kInvalidArgument on a target that is not positive and finite.
  StatusOr<BitAllocation> ForRate(double target_bits_per_sample) const;

 private:
  // A set that can be coded.
  struct Problem {
    size_t index = 0;  // among the sets
    SetStatistics set;
    double log_gain = 0.0;  // ln(w sigma^2 / a) with the exponent applied: ln(-h) = ln(lambda) - log_gain
    RateDistortionTable table;
  };

  BitAllocator(size_t num_sets, const AllocationOptions& options) : num_sets_(num_sets), options_(options) {}

  // Step of one problem in units of sigma, or +inf, by its own slope alone.
  static double FreeStep(const Problem& problem, double log_slope);
  // The least step that options_ admit for a tangential set, model units.
  double TangentialFloor(const Problem& tangential, double lambda, const std::vector<double>& free_steps) const;

  size_t num_sets_;
  AllocationOptions options_;
  std::vector<Problem> problems_;
};

// One allocation, tables included: under 50 ms for any mesh.
StatusOr<BitAllocation> AllocateBits(Span<SetStatistics> sets, double target_bits_per_sample,
                                     const AllocationOptions& options = {});
StatusOr<BitAllocation> AllocateForSlope(Span<SetStatistics> sets, double lambda,
                                         const AllocationOptions& options = {});

// One step for all three coordinates of the base, whose lattice is cubic: the geometric mean of the steps of those that
// are coded, or +inf where none is.
double CommonBaseStep(Span<SetStatistics> sets, const BitAllocation& allocation);

// The steps of levels 1 .. num_levels as a stream holds them: rounded (RoundStep), 0 where a set is not coded or not
// there, without bias. sets may come in any order.
std::vector<LevelSteps> StepsByLevel(Span<SetStatistics> sets, const BitAllocation& allocation, int num_levels);

}  // namespace lacerta

#endif  // LACERTA_ENCODER_ALLOCATION_BIT_ALLOCATION_H_
