#include "draco/candidate_search.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <string>
#include <utility>

#include "draco/decoded_distance.h"

namespace lacerta {
namespace {

// Typical slopes of the rate-distortion curve, to extrapolate from a single point; the search corrects them.
constexpr double kPsnrPerLogLambda = -2.9;  // dB per unit of ln(lambda)
constexpr double kLogBytesPerLogLambda = -0.32;
constexpr double kLogBytesPerDecibel = kLogBytesPerLogLambda / kPsnrPerLogLambda;
constexpr double kFirstLambda = 1.2e-4;  // of the squared distance aimed at, per bit
constexpr double kUsualPsnr = 70;        // where to begin when only the rate is given

// What counts as met: [psnr, psnr + 0.3) and (0.98, 1] of the bytes, with a margin for the noise of the measure.
constexpr double kPsnrMargin = 0.03, kPsnrSlack = 0.24, kFirstPsnrSlack = 0.12;
constexpr double kBytesSlack = 0.018;
// What is aimed at lies inside of that, so that jumps of the curve hardly ever skip it.
constexpr double kPsnrAim = 0.06, kBytesAim = 0.005;
constexpr int kScoreTries = 2;
constexpr double kNearEnough = 0.4;  // dB: typical slopes will do
constexpr int kMeetTries = 16, kEstimatedTries = 6;

}  // namespace

double UsualLambda(double psnr, double diagonal) {
  const double distance = DistanceOfPsnr(psnr, diagonal);
  return kFirstLambda * distance * distance;
}

CandidateSearch::CandidateSearch(const NormalMeshCandidate& candidate, double remesh_psnr, const SurfaceDistanceMeter& meter,
                                 const ResolvedTarget& target, EncodeMode mode, const SearchEffort& effort)
    : candidate_(candidate), remesh_psnr_(remesh_psnr), meter_(meter), target_(target), mode_(mode), effort_(effort) {
  start_ = std::log(UsualLambda(target_.is_rate ? kUsualPsnr : target_.psnr, meter_.diagonal()));
}

double CandidateSearch::Goal() const {
  return target_.is_rate ? std::log(target_.bytes) - kBytesAim : target_.psnr + kPsnrAim - offset_.value_or(0);
}

double CandidateSearch::TypicalSlope() const { return target_.is_rate ? kLogBytesPerLogLambda : kPsnrPerLogLambda; }

StatusOr<CandidateSearch::Attempt> CandidateSearch::Try(double log_lambda, int passes) {
  Attempt attempt;
  LACERTA_ASSIGN_OR_RETURN(attempt.stream, candidate_.Code({std::exp(kept_steps_.value_or(log_lambda)), std::exp(log_lambda), passes}, mode_));
  const double estimate = EstimatePsnr(attempt.stream);
  if (!offset_) {
    constexpr uint64_t kRoughSamples = 50'000;
    offset_ = MeasurePsnr(attempt, kRoughSamples) - estimate;
  }
  attempt.psnr = estimate + *offset_;
  attempt.value = target_.is_rate ? std::log(static_cast<double>(attempt.stream.size())) : estimate;
  values_[log_lambda] = attempt.value;
  return attempt;
}

double CandidateSearch::EstimatePsnr(const CodedStream& stream) const {
  const double remesh_distance = DistanceOfPsnr(remesh_psnr_, meter_.diagonal());
  return Psnr(std::sqrt(stream.plane_distortion + remesh_distance * remesh_distance), meter_.diagonal());
}

double CandidateSearch::MeasurePsnr(const Attempt& attempt, uint64_t num_samples) {
  ++measurements_;
  return Psnr(DecodedDistance(meter_, attempt.stream.FinestMesh(), SurfaceDistanceOptions::RmsOnly(num_samples)), meter_.diagonal());
}

CandidateSearch::Bracket CandidateSearch::AroundGoal() const {
  Bracket bracket{values_.end(), values_.end()};
  for (auto it = values_.begin(); it != values_.end(); ++it) {
    if (it->second >= Goal()) bracket.above = it;
    if (it->second < Goal() && bracket.below == values_.end()) bracket.below = it;
  }
  return bracket;
}

bool CandidateSearch::IsBracket(const Bracket& b) const {
  return b.above != values_.end() && b.below != values_.end() && b.below->first > b.above->first;
}

// The next ln(lambda) to try: between the two attempts around the goal, or beyond the nearest one.
double CandidateSearch::NextGuess() const {
  if (values_.empty()) return start_;
  const auto [above, below] = AroundGoal();
  if (IsBracket({above, below})) {
    const double width = below->first - above->first;
    const double share = (above->second - Goal()) / (above->second - below->second);
    return above->first + width * std::clamp(share, 0.08, 0.92);
  }
  const auto nearest = above != values_.end() ? above : below;
  const double step = (Goal() - nearest->second) / TypicalSlope();
  // Beyond all attempts: somewhat farther than it seems, so that the goal gets bracketed.
  return nearest->first + std::clamp(1.1 * step, -4.0, 4.0) + (step < 0 ? -0.02 : 0.02);
}

// Where the attempts on both sides of the goal are hardly apart in lambda and still miss it, the steps jump between them: those of
// the finer side are kept, and the descent makes up the rest.
void CandidateSearch::KeepStepsAtJump() {
  constexpr double kHardlyApart = 0.06;
  if (kept_steps_ || mode_ == EncodeMode::kPaper) return;
  const Bracket bracket = AroundGoal();
  if (!IsBracket(bracket) || bracket.below->first - bracket.above->first > kHardlyApart) return;
  const std::pair<double, double> finer = *bracket.above;
  kept_steps_ = finer.first;
  values_ = {{finer.first, finer.second}};
}

// A finer slope no longer raises the PSNR: the remesh itself is the limit.
bool CandidateSearch::CannotReach() const {
  if (target_.is_rate || kept_steps_ || values_.size() < 3) return false;
  const auto first = values_.begin(), second = std::next(first);
  constexpr double kApart = 0.1;  // nearer, and noise decides
  return first->second < Goal() && second->first - first->first > kApart && (first->second - second->second) < 0.15 * (second->first - first->first);
}

StatusOr<double> CandidateSearch::Score() {
  double score = std::numeric_limits<double>::infinity();
  double least_miss = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kScoreTries; ++i) {
    const double log_lambda = NextGuess();
    LACERTA_ASSIGN_OR_RETURN(const Attempt attempt, Try(log_lambda, effort_.score_passes));
    const double miss = Goal() - attempt.value;
    if (std::fabs(miss) >= least_miss) continue;
    least_miss = std::fabs(miss);
    start_ = log_lambda + miss / TypicalSlope();
    const double log_bytes = std::log(static_cast<double>(attempt.stream.size()));
    score = target_.is_rate ? -(attempt.psnr + miss / kLogBytesPerDecibel) : log_bytes + kLogBytesPerDecibel * miss;
    if (least_miss < kNearEnough * (target_.is_rate ? -kLogBytesPerDecibel : 1.0)) break;
  }
  return score;
}

StatusOr<MeasuredStream> CandidateSearch::Meet() {
  values_.clear();  // those of the scores: fewer passes
  constexpr uint64_t kSamples = 200'000;
  const double low = target_.is_rate ? -kBytesSlack : kPsnrMargin, high = target_.is_rate ? 0 : kPsnrSlack;  // beyond the target
  const auto excess = [&](const Attempt& a) { return target_.is_rate ? a.value - std::log(target_.bytes) : a.psnr - target_.psnr; };
  const auto keeps_promise = [&](const Attempt& a) { return target_.is_rate ? excess(a) <= 0 : excess(a) >= 0; };
  double high_enough = target_.is_rate ? high : kFirstPsnrSlack;  // estimates lead near enough, in a few tries
  const auto is_met = [&](const Attempt& a) { return excess(a) >= low && excess(a) <= high_enough; };
  std::optional<Attempt> best, unmeasured;
  std::map<double, double> measured;  // dB by ln(lambda), where the steps went with it
  // Safely beyond the target, then just so, then on its wrong side.
  const auto rank = [&](const Attempt& a) { return excess(a) >= low && excess(a) <= high ? 2 : keeps_promise(a) ? 1 : 0; };
  const auto consider = [&](Attempt attempt) {
    const bool nearer = best && std::fabs(excess(attempt)) < std::fabs(excess(*best));
    if (!best || (rank(attempt) == rank(*best) ? nearer : rank(attempt) > rank(*best))) best = std::move(attempt);
  };
  double last = start_;
  for (int i = 0; i < kMeetTries && !CannotReach() && !(best && is_met(*best)); ++i) {
    if (measurements_ >= kMostMeasurements && best && rank(*best) == 2) break;
    const bool by_estimate = i < kEstimatedTries;
    double log_lambda = NextGuess();
    if (i == kEstimatedTries && !target_.is_rate) {  // estimates will not do: from here on values are measured
      high_enough = high;
      if (best && is_met(*best)) break;
      start_ = last;
      values_ = measured;
      kept_steps_.reset();
      offset_ = 0;
      log_lambda = NextGuess();
    }
    last = log_lambda;
    StatusOr<Attempt> tried = Try(log_lambda, effort_.meet_passes);
    if (!tried.ok() && (best || unmeasured)) break;  // so coarse a lattice cannot carry the base: what there is must do
    LACERTA_ASSIGN_OR_RETURN(Attempt attempt, std::move(tried));
    if (!target_.is_rate) {
      if (by_estimate && !is_met(attempt)) {
        unmeasured = std::move(attempt);
        KeepStepsAtJump();
        continue;
      }
      attempt.psnr = MeasurePsnr(attempt, kSamples);
      if (!kept_steps_) measured[log_lambda] = attempt.psnr;
      if (by_estimate) offset_ = attempt.psnr - attempt.value;
      if (!by_estimate) attempt.value = values_[log_lambda] = attempt.psnr;
      unmeasured.reset();
    }
    consider(std::move(attempt));
    KeepStepsAtJump();
  }
  if (unmeasured && !(best && is_met(*best))) {  // out of tries: the last one may be the nearest
    unmeasured->psnr = MeasurePsnr(*unmeasured, kSamples);
    consider(std::move(*unmeasured));
  }
  MeasuredStream result;
  result.meets_target = keeps_promise(*best);
  result.psnr = best->psnr;
  result.measurements = measurements_;
  result.stream = std::move(best->stream);
  return result;
}

}  // namespace lacerta
