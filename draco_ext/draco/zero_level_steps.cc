#include "draco/zero_level_steps.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "draco/candidate_search.h"
#include "draco/decoded_distance.h"
#include "geometry/for_each_branch.h"
#include "remesh/rate_model.h"

namespace lacerta {
namespace {

using Coding = ZeroLevelCandidate::Coding;

double Square(double x) { return x * x; }

double WantedDistortion(const ResolvedTarget& target, const SurfaceDistanceMeter& meter) { return Square(DistanceOfPsnr(target.psnr, meter.diagonal())); }

// Of the squared distance, the part that the lattice adds goes with the square of the step.
double NextStep(double step, double distortion, double fit, double wanted) {
  const double added = distortion - fit, allowed = wanted - fit;
  const double ratio = added > 0 && allowed > 0 ? std::sqrt(allowed / added) : std::pow(wanted / distortion, 0.6);
  return step * std::clamp(ratio, 0.4, 2.5);
}

// The step against the present one that multiplies the bytes by `factor`: a bit of every coordinate for each doubling.
double StepRatioForBytes(double factor, double bytes, const ZeroLevelCandidate& candidate) {
  constexpr double kCoordinatesPerTriangle = 1.5;
  const double bits_per_triangle = 8 * bytes / static_cast<double>(candidate.num_triangles());
  return std::clamp(std::exp2(bits_per_triangle * (1 - factor) / kCoordinatesPerTriangle), 0.25, 4.0);
}

void Take(const Coding& coding, ZeroLevelTrial* trial) {
  trial->step = coding.step;
  trial->bytes = coding.bytes;
  trial->distortion = coding.distortion;
}

Status TryPsnr(double wanted, BaseCoding base_coding, ZeroLevelCandidate* candidate, ZeroLevelTrial* trial) {
  constexpr double kMostOfFit = 0.93, kFarOff = 1e9;
  if (candidate->fit_distortion() > kMostOfFit * wanted) {
    trial->score = kFarOff * (candidate->fit_distortion() / wanted);
    trial->step = RateModel::StepFor((1 - kMostOfFit) * wanted);
    return Status();
  }
  candidate->FitForRate(wanted - candidate->fit_distortion(), 1);
  double step = RateModel::StepFor(std::max(wanted - candidate->fit_distortion(), (1 - kMostOfFit) * wanted));
  constexpr int kSteps = 3;
  double db = 0;
  for (int i = 0; i < kSteps; ++i) {
    LACERTA_ASSIGN_OR_RETURN(const Coding coding, candidate->Code(step, 1, CodingEffort::kQuick, base_coding));
    Take(coding, trial);
    db = 10 * std::log10(coding.distortion / wanted);
    if (std::fabs(db) < 0.3) break;
    step = NextStep(step, coding.distortion, candidate->fit_distortion(), wanted);
  }
  // Still a little off the target, where a dB is worth 6 % of the bytes.
  trial->score = std::log(static_cast<double>(trial->bytes)) + 0.06 * std::clamp(db, -10.0, 10.0);
  trial->meets = true;
  return Status();
}

Status TryRate(double bytes, double least_distortion, BaseCoding base_coding, ZeroLevelCandidate* candidate, ZeroLevelTrial* trial) {
  const double fit = std::max(candidate->fit_distortion(), least_distortion);
  candidate->FitForRate(fit, 1);
  double step = RateModel::StepFor(fit);
  constexpr int kSteps = 5;
  for (int i = 0; i < kSteps; ++i) {
    LACERTA_ASSIGN_OR_RETURN(const Coding coding, candidate->Code(step, 1, CodingEffort::kQuick, base_coding));
    const double excess = static_cast<double>(coding.bytes) / bytes;
    const bool fits = excess <= 1;
    if (i == 0 || fits || !trial->meets) Take(coding, trial);
    trial->meets = trial->meets || fits;
    if (excess > 0.98 && excess <= 1) break;
    step *= StepRatioForBytes(1 / excess * 0.99, bytes, *candidate);
  }
  trial->score = std::log(trial->distortion) + (trial->meets ? 0 : 1e3 * static_cast<double>(trial->bytes) / bytes);
  return Status();
}

// What is tried after i steps, near the one that seems right: of many tries two at a time, to both sides of it; of few a single one, since each is to learn
// from the last.
std::vector<double> StepsNear(double step, int i, bool in_pairs) {
  constexpr double kFirst = 0.03, kNarrow = 0.006, kWide = 0.015, kJitter = 0.02;  // shares of the step
  if (!in_pairs) return {i == 0 ? step : step * (1 + kJitter * ((i - 1) % 3 - 1))};
  const double spread = i == 0 ? kFirst : i % 4 == 2 ? kWide : kNarrow;
  return {step * (1 + spread), step * (1 - spread)};
}

// What the codings of one mesh led to so far.
class StepSearch {
 public:
  StepSearch(const ResolvedTarget& target, const SurfaceDistanceMeter& meter, const ZeroLevelCandidate& candidate)
      : target_(target), meter_(meter), candidate_(candidate), wanted_(WantedDistortion(target, meter)) {}

  // Measures a coding in full where it may be the best, and returns a step to try next.
  double Take(Coding coding) {
    const double distortion = bias_ * coding.distortion;
    if (MayBeBest(coding)) Measure(std::move(coding.coded), coding.distortion);
    if (target_.is_rate) return coding.step * StepRatioForBytes(0.995 * target_.bytes / static_cast<double>(coding.bytes), target_.bytes, candidate_);
    const double cautious = std::max(distortion, bias_ * coding.distortion) * 1.005;
    if (cautious <= wanted_ && coding.step > met_.step) met_ = {coding.step, cautious};
    if (cautious > wanted_ && (missed_.step == 0 || coding.step < missed_.step)) missed_ = {coding.step, cautious};
    const bool is_between = 0 < met_.step && met_.step < missed_.step;
    return is_between ? StepBetween() : NextStep(coding.step, cautious, candidate_.fit_distortion(), wanted_);
  }

  bool meets_target() const { return best_.meets_target; }
  // At any step.
  bool IsOutOfReach() const { return !target_.is_rate && !meets_target() && bias_ * candidate_.fit_distortion() > wanted_; }

  FinishedZeroLevel Best() {
    best_.measurements = measurements_;
    return {std::move(best_), bias_};
  }

 private:
  struct TriedStep {
    double step = 0, distortion = 0;
  };

  bool MayBeBest(const Coding& coding) const {
    if (measurements_ == 0) return true;
    if (measurements_ >= CandidateSearch::kMostMeasurements && best_.meets_target) return false;
    const double distortion = bias_ * coding.distortion;
    if (target_.is_rate) return static_cast<double>(coding.bytes) <= target_.bytes && (best_distortion_ == 0 || distortion < best_distortion_);
    return (!best_.meets_target || coding.bytes < best_.stream.size()) && distortion < 1.01 * wanted_;
  }

  // by_samples: the squared distance of it.
  void Measure(CodedZeroLevel coded, double by_samples) {
    ZeroLevelStream stream = MeasuredZeroLevel(std::move(coded), meter_, target_);
    const double expected = bias_ * by_samples;
    if (by_samples > 0) bias_ = Square(stream.distance) / by_samples;
    if (++measurements_ > 1 && !IsBetter(OutcomeOf(stream), OutcomeOf(best_), target_)) return;
    best_ = std::move(stream);
    best_distortion_ = expected;
  }

  // Where the squared distance, taken for a power of the step, is what is wanted.
  double StepBetween() const {
    const double share = std::log(wanted_ / met_.distortion) / std::log(missed_.distortion / met_.distortion);
    constexpr double kMiddle = 0.5;  // where nothing is known of the power: no distortion at all, or equal ones
    return met_.step * std::pow(missed_.step / met_.step, std::isfinite(share) ? std::clamp(share, 0.1, 0.9) : kMiddle);
  }

  const ResolvedTarget& target_;
  const SurfaceDistanceMeter& meter_;
  const ZeroLevelCandidate& candidate_;
  const double wanted_;  // squared distance at a PSNR
  double bias_ = 1;
  ZeroLevelStream best_;
  double best_distortion_ = 0;
  int measurements_ = 0;
  TriedStep met_, missed_;  // the largest step at the target, the smallest beyond it
};

}  // namespace

ZeroLevelStream MeasuredZeroLevel(CodedZeroLevel coded, const SurfaceDistanceMeter& meter, const ResolvedTarget& target,
                                  const SurfaceDistanceOptions& samples) {
  ZeroLevelStream result;
  result.stream = std::move(coded.stream);
  result.coding = coded.coding;
  result.mesh = std::move(coded.mesh);
  result.distance = DecodedDistance(meter, result.mesh, samples);
  result.psnr = Psnr(result.distance, meter.diagonal());
  result.meets_target = target.is_rate ? static_cast<double>(result.stream.size()) <= target.bytes : result.psnr >= target.psnr;
  return result;
}

StatusOr<ZeroLevelTrial> TrySteps(const ResolvedTarget& target, const SurfaceDistanceMeter& meter, double bias, ZeroLevelCandidate* candidate) {
  ZeroLevelTrial trial;
  LACERTA_RETURN_IF_ERROR(target.is_rate ? TryRate(target.bytes, 1e-14 * Square(meter.diagonal()), target.base_coding, candidate, &trial)
                                         : TryPsnr(WantedDistortion(target, meter) / bias, target.base_coding, candidate, &trial));
  trial.num_triangles = candidate->num_triangles();
  trial.fit_distortion = candidate->fit_distortion();
  return trial;
}

// Rounding makes bytes and distance jump a little with the step: several steps are tried near what seems right, more of them where that costs little, and
// judged by few samples first.
StatusOr<FinishedZeroLevel> FinishSteps(const ResolvedTarget& target, const SurfaceDistanceMeter& meter, const ZeroLevelCandidate& candidate, double step, double tries) {
  const size_t triangles = candidate.num_triangles();
  const bool is_small = triangles < 2000;
  const int usual_tries = is_small ? 8 : triangles < 5000 ? 6 : 4;
  const int num_tries = std::max(2, static_cast<int>(std::lround(tries * usual_tries)));
  const bool in_pairs = is_small && num_tries >= usual_tries;
  const int descent_rounds = triangles < 5000 ? 3 : 2;
  StepSearch search(target, meter, candidate);
  for (int i = 0; i < num_tries || (!search.meets_target() && i < 2 * num_tries);) {
    if (i > 1 && search.IsOutOfReach()) break;
    const std::vector<double> steps = StepsNear(step, i, in_pairs);
    std::vector<StatusOr<Coding>> codings(steps.size(), Coding());
    ForEachBranch(steps.size(), [&](size_t k) { codings[k] = candidate.Code(steps[k], descent_rounds, CodingEffort::kFull, target.base_coding); });
    for (StatusOr<Coding>& coding : codings) {
      LACERTA_RETURN_IF_ERROR(coding.status());
      step = search.Take(std::move(coding).value());
    }
    i += static_cast<int>(steps.size());
  }
  return search.Best();
}

}  // namespace lacerta
