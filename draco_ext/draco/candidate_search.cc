#include "draco/candidate_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "draco/decoded_distance.h"
#include "draco/for_each_candidate.h"

namespace lacerta {
namespace {

// Typical slopes of the rate-distortion curve, to extrapolate from a single point; the search corrects them.
constexpr double kPsnrPerLogLambda = -2.9;  // dB per unit of ln(lambda)
constexpr double kLogBytesPerLogLambda = -0.32;
constexpr double kLogBytesPerDecibel = kLogBytesPerLogLambda / kPsnrPerLogLambda;
constexpr double kFirstLambda = 1.2e-4;  // of the squared distance aimed at, per bit, at kFirstPsnr
constexpr double kFirstPsnr = 75;        // below, a bit brings more
constexpr double kFirstGrowth = 0.077;   // of ln(lambda) beside the squared distance, per dB
constexpr double kUsualPsnr = 70;        // where to begin when only the rate is given

// What counts as met: [psnr, psnr + 0.3) and (0.98, 1] of the bytes, with a margin for the noise of the measure.
constexpr double kPsnrMargin = 0.03, kPsnrSlack = 0.2, kPsnrNear = 0.07;
constexpr double kBytesSlack = 0.018;
// What is aimed at lies inside of that, so that jumps of the curve hardly ever skip it.
constexpr double kPsnrAim = 0.045, kBytesAim = 0.005;
constexpr int kScoreTries = 2;
// Near to what the remesh is off by bytes grow faster than extrapolation foresees: ln(bytes) for each dB less between the remesh and the target.
constexpr double kEnoughHeadroom = 3.3, kLogBytesPerHeadroom = 0.12;
constexpr int kMostDraws = 4, kSettlePasses = 2;  // passes: from a stream near the goal to one at it
constexpr double kComparable = 0.7;  // dB from the goal: from farther off, extrapolation favors what hardly can reach it
constexpr double kNearEnough = 0.4;  // dB: typical slopes will do
constexpr int kMeetTries = 16, kEstimatedTries = 6, kSettlingTries = 11;
constexpr double kDefect = 0.3;      // dB that a stream may measure less than estimated: usual ones are within 0.1, the others have vertices astray that planes do not show
constexpr double kStepChange = 1.5;  // between slopes of steps that are tried

}  // namespace

double UsualLambda(double psnr, double diagonal) {
  constexpr double kLowest = 50, kHighest = 85;  // dB that this was seen at
  const double distance = DistanceOfPsnr(psnr, diagonal);
  return kFirstLambda * distance * distance * std::exp(kFirstGrowth * (kFirstPsnr - std::clamp(psnr, kLowest, kHighest)));
}

CandidateSearch::CandidateSearch(const NormalMeshCandidate& candidate, double remesh_psnr, const SurfaceDistanceMeter& meter,
                                 const ResolvedTarget& target, EncodeMode mode, const SearchEffort& effort)
    : candidate_(candidate), remesh_psnr_(remesh_psnr), meter_(meter), target_(target), mode_(mode), effort_(effort) {
  start_ = {std::log(UsualLambda(target_.is_rate ? kUsualPsnr : target_.psnr, meter_.diagonal())), kLogBytesPerDecibel};
}

double CandidateSearch::Goal() const {
  if (target_.is_rate) return std::log(target_.bytes) - kBytesAim;
  const double psnr = target_.psnr + kPsnrAim - offset_.value_or(0);
  return values_are_measured_ ? psnr : CodingPsnr(psnr);
}

double CandidateSearch::CodingPsnr(double psnr) const {
  constexpr double kLeastShare = 0.03;  // of the squared distance, where the remesh alone is as far as that
  const double distance = DistanceOfPsnr(psnr, meter_.diagonal()), remesh_distance = DistanceOfPsnr(remesh_psnr_, meter_.diagonal());
  const double rest = distance * distance - remesh_distance * remesh_distance;
  return Psnr(std::sqrt(std::max(rest, kLeastShare * distance * distance)), meter_.diagonal());
}

double CandidateSearch::TypicalSlope() const { return target_.is_rate ? kLogBytesPerLogLambda : kPsnrPerLogLambda; }

StatusOr<CandidateSearch::Attempt> CandidateSearch::Code(const StepChoice& steps, double log_lambda, int passes, int quality_layers, const CodedSurface* from) const {
  Attempt attempt;
  const double lambda = std::exp(log_lambda);
  LACERTA_ASSIGN_OR_RETURN(attempt.stream, candidate_.Code({lambda, lambda * steps.details, lambda * steps.base, last_detailed_, passes, quality_layers}, mode_, from));
  const double estimate = EstimatePsnr(attempt.stream);
  attempt.psnr = estimate + offset_.value_or(0);
  attempt.value = target_.is_rate ? std::log(static_cast<double>(attempt.stream.size())) : CodingPsnr(estimate);
  attempt.log_lambda = log_lambda;
  return attempt;
}

StatusOr<CandidateSearch::Attempt> CandidateSearch::Try(double log_lambda, int passes, int quality_layers, const CodedSurface* from) {
  LACERTA_ASSIGN_OR_RETURN(Attempt attempt, Code(steps_, log_lambda, passes, quality_layers, from));
  if (!offset_) {
    constexpr uint64_t kRoughSamples = 50'000;
    const double estimate = attempt.psnr;
    attempt.psnr = MeasurePsnr(attempt, kRoughSamples);
    offset_ = attempt.psnr - estimate;
  }
  values_[log_lambda] = attempt.value;
  return attempt;
}

double CandidateSearch::EstimatePsnr(const CodedStream& stream) const {
  const double remesh_distance = DistanceOfPsnr(remesh_psnr_, meter_.diagonal());
  return Psnr(std::sqrt(stream.plane_distortion + remesh_distance * remesh_distance), meter_.diagonal());
}

double CandidateSearch::MeasurePsnr(const Attempt& attempt, uint64_t num_samples) {
  ++measurements_;
  return DecodedPsnr(meter_, attempt.stream.FinestMesh(), num_samples);
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
  if (values_.empty()) return start_.log_lambda;
  const auto [above, below] = AroundGoal();
  if (IsBracket({above, below})) {
    const double width = below->first - above->first;
    const double share = (above->second - Goal()) / (above->second - below->second);
    return above->first + width * std::clamp(share, 0.08, 0.92);
  }
  const bool all_above = above != values_.end();
  const auto nearest = all_above ? above : below;
  double slope = TypicalSlope();
  // Descents that go on from a stream change less than new ones.
  if (const auto next = all_above ? (above == values_.begin() ? values_.end() : std::prev(above)) : std::next(below); next != values_.end()) {
    constexpr double kFlattest = 0.2;
    const double seen = (next->second - nearest->second) / (next->first - nearest->first);
    slope = std::clamp(seen, slope, kFlattest * slope);
  }
  const double step = (Goal() - nearest->second) / slope;
  // Beyond all attempts: somewhat farther than it seems, so that the goal gets bracketed.
  return nearest->first + std::clamp(1.1 * step, -4.0, 4.0) + (step < 0 ? -0.02 : 0.02);
}

// The curve jumps over the goal between two slopes that are as good as the same.
bool CandidateSearch::JumpsOverGoal() const {
  constexpr double kSame = 0.02;  // of ln(lambda): 0.06 dB on a smooth curve
  const Bracket bracket = AroundGoal();
  return values_are_measured_ && IsBracket(bracket) && bracket.below->first - bracket.above->first < kSame;
}

// A finer slope no longer raises the PSNR: the remesh itself is the limit.
bool CandidateSearch::CannotReach() const {
  if (values_.size() < 2 || (values_are_measured_ && values_.size() < 3)) return false;
  const auto first = values_.begin(), second = std::next(first);
  const double apart = values_are_measured_ ? 0.1 : 1.0;  // nearer, and noise decides
  return first->second < Goal() && second->first - first->first > apart && (first->second - second->second) < 0.15 * (second->first - first->first);
}

double CandidateSearch::Miss(const Attempt& attempt) const {
  return std::fabs(Goal() - attempt.value) / (target_.is_rate ? start_.log_bytes_per_decibel : 1.0);
}

double CandidateSearch::Merit(const Attempt& attempt) const {
  const double miss = Goal() - attempt.value;
  return target_.is_rate ? -(attempt.psnr + miss / start_.log_bytes_per_decibel)
                         : std::log(static_cast<double>(attempt.stream.size())) + start_.log_bytes_per_decibel * miss;
}

// Noisy surfaces take two to three times the bits of smooth ones for a dB more.
void CandidateSearch::LearnSlope(const Attempt& a, const Attempt& b) {
  constexpr double kApart = 0.5;  // dB: nearer, and noise decides
  constexpr double kFlattest = 0.05, kSteepest = 0.5;
  const double decibels = CodingPsnr(a.psnr) - CodingPsnr(b.psnr);
  if (std::fabs(decibels) < kApart) return;
  const double log_bytes = std::log(static_cast<double>(a.stream.size()) / static_cast<double>(b.stream.size()));
  start_.log_bytes_per_decibel = std::clamp(log_bytes / decibels, kFlattest, kSteepest);
}

StatusOr<double> CandidateSearch::Score() {
  std::optional<Attempt> nearest;
  for (int i = 0; i < kScoreTries; ++i) {
    const double log_lambda = NextGuess();
    const int before = std::exchange(last_detailed_, candidate_.LastDetailed(std::exp(log_lambda)));
    LACERTA_ASSIGN_OR_RETURN(Attempt attempt, Try(log_lambda, effort_.score_passes, 1));
    if (nearest && last_detailed_ == before) LearnSlope(*nearest, attempt);  // else they are not of one curve
    if (!nearest || std::fabs(Miss(attempt)) < std::fabs(Miss(*nearest))) nearest = std::move(attempt);
    if (std::fabs(Miss(*nearest)) < kNearEnough) break;
  }
  start_.log_lambda = nearest->log_lambda + (Goal() - nearest->value) / TypicalSlope();
  const double headroom = target_.is_rate ? kEnoughHeadroom : remesh_psnr_ - target_.psnr;
  return Merit(*nearest) + kLogBytesPerHeadroom * std::max(0.0, kEnoughHeadroom - headroom);
}

StatusOr<CandidateSearch::Attempt> CandidateSearch::NearGoal(StatusOr<Attempt> attempt, const StepChoice& steps) const {
  if (!attempt.ok() || Miss(attempt.value()) <= kComparable) return attempt;
  const double log_lambda = attempt.value().log_lambda + (Goal() - attempt.value().value) / TypicalSlope();
  StatusOr<Attempt> other = Code(steps, log_lambda, effort_.suit_passes, 1);
  return !other.ok() || Miss(other.value()) < Miss(attempt.value()) ? std::move(other) : std::move(attempt);
}

// The law of the steps holds for surfaces on the whole; what suits this one is found by trying, one choice after the other, around the
// slope that the target is thought to need.
void CandidateSearch::SuitSteps() {
  double least = std::numeric_limits<double>::infinity();
  const auto keep_if_better = [&](const StepChoice& choice, const StatusOr<Attempt>& attempt) {
    if (!attempt.ok() || !(Merit(attempt.value()) < least)) return false;
    least = Merit(attempt.value());
    start_.log_lambda = attempt.value().log_lambda + (Goal() - attempt.value().value) / TypicalSlope();
    steps_ = choice;
    return true;
  };
  const auto code = [&](const StepChoice& choice) { return NearGoal(Code(choice, start_.log_lambda, effort_.suit_passes, 1), choice); };
  const auto changed = [&](double StepChoice::*slope, bool is_finer) {
    StepChoice choice = steps_;
    if (is_finer) {
      choice.*slope /= kStepChange;
    } else {
      choice.*slope *= kStepChange;
    }
    return choice;
  };
  const auto climb = [&](double StepChoice::*slope, bool finer_first) {
    const std::array<bool, 2> directions = {finer_first, !finer_first};
    const std::array<StepChoice, 2> choices = {changed(slope, directions[0]), changed(slope, directions[1])};
    std::vector<StatusOr<Attempt>> attempts(choices.size(), InternalError("not tried"));
    ForEachCandidate(static_cast<double>(candidate_.normal_mesh().mesh.positions.size()), choices.size(), [&](size_t i) { attempts[i] = code(choices[i]); });
    for (size_t i = 0; i < choices.size(); ++i) {
      if (!keep_if_better(choices[i], attempts[i])) continue;
      for (StepChoice next = changed(slope, directions[i]); keep_if_better(next, code(next)); next = changed(slope, directions[i])) {
      }
      return;
    }
  };
  keep_if_better(StepChoice(steps_), NearGoal(Try(start_.log_lambda, effort_.suit_passes, 1), steps_));
  climb(&StepChoice::base, true);
  climb(&StepChoice::details, false);
}

// The best of a few codings near the goal, rather finer than that. Which coefficients a descent ends with is up to chance: slopes that hardly
// differ give streams that lie a percent of the bytes above or below the curve. From one of them the descent goes on to a slightly coarser one
// along the curve, while a finer one takes more bytes that way.
StatusOr<CandidateSearch::Attempt> CandidateSearch::Draw() {
  constexpr double kFiner = 0.04;  // of ln(lambda): 0.12 dB
  const auto is_better = [&](const Attempt& a, const Attempt& b) {
    if (std::max(Miss(a), Miss(b)) > kComparable) return Miss(a) < Miss(b);
    const bool a_fine = a.value >= Goal(), b_fine = b.value >= Goal();
    return a_fine != b_fine ? a_fine : Merit(a) < Merit(b);
  };
  std::optional<Attempt> best;
  for (int i = 0; i < effort_.draws || (i < kMostDraws && Miss(*best) > kComparable); ++i) {
    if (CannotReach()) break;
    StatusOr<Attempt> tried = Try(NextGuess() - kFiner, effort_.meet_passes, target_.quality_layers);
    if (!tried.ok() && best) break;  // so coarse a lattice cannot carry the base: what there is must do
    LACERTA_ASSIGN_OR_RETURN(Attempt attempt, std::move(tried));
    if (!best || is_better(attempt, *best)) best = std::move(attempt);
  }
  return *std::move(best);
}

// What the descent may go on from to the goal; none where that is too far off.
std::optional<CodedSurface> CandidateSearch::SettleFrom(const Attempt& drawn) const {
  if (mode_ == EncodeMode::kPaper || candidate_.normal_mesh().keeps_vertices || Miss(drawn) > kComparable) return std::nullopt;
  return drawn.stream.coded;
}

StatusOr<CandidateSearch::Attempt> CandidateSearch::Settle(const std::optional<CodedSurface>& from) {
  return Try(NextGuess(), from ? kSettlePasses : effort_.meet_passes, target_.quality_layers, from ? &*from : nullptr);
}

StatusOr<MeasuredStream> CandidateSearch::Meet() {
  last_detailed_ = candidate_.LastDetailed(std::exp(start_.log_lambda));
  if (effort_.suit_passes > 0 && mode_ != EncodeMode::kPaper) SuitSteps();
  for (;; ++last_detailed_) {
    values_.clear();  // those of fewer passes, or of other levels
    values_are_measured_ = false;
    LACERTA_ASSIGN_OR_RETURN(Attempt drawn, Draw());
    values_ = {{drawn.log_lambda, drawn.value}};
    if (target_.is_rate) return MeetRate(std::move(drawn));
    LACERTA_ASSIGN_OR_RETURN(MeasuredStream met, MeetQuality(std::move(drawn)));
    // What is dropped with the finest level may be what is missing.
    if (met.meets_target || last_detailed_ >= candidate_.num_levels()) return met;
  }
}

StatusOr<MeasuredStream> CandidateSearch::MeetRate(Attempt drawn) {
  const auto excess = [&](const Attempt& a) { return a.value - std::log(target_.bytes); };
  const std::optional<CodedSurface> from = SettleFrom(drawn);
  Attempt best = std::move(drawn);
  for (int i = 0; i < kMeetTries && !(excess(best) <= 0 && excess(best) >= -kBytesSlack); ++i) {
    StatusOr<Attempt> tried = Settle(from);
    if (!tried.ok()) break;  // so coarse a lattice cannot carry the base: what there is must do
    Attempt attempt = std::move(tried).value();
    const bool keeps = excess(attempt) <= 0, kept = excess(best) <= 0;
    if (keeps == kept ? std::fabs(excess(attempt)) < std::fabs(excess(best)) : keeps) best = std::move(attempt);
  }
  const bool meets_target = excess(best) <= 0;
  return MeasuredStream{std::move(best.stream), best.psnr, meets_target, measurements_};
}

StatusOr<MeasuredStream> CandidateSearch::MeetQuality(Attempt drawn) {
  constexpr uint64_t kSamples = 200'000;
  const auto excess = [&](const Attempt& a) { return a.psnr - target_.psnr; };
  // Safely over the target, then just so, then under it.
  const auto rank = [&](const Attempt& a) {
    return excess(a) >= kPsnrMargin && excess(a) <= kPsnrSlack ? 2 : excess(a) >= 0 ? 1 : 0;
  };
  std::optional<Attempt> best;
  const auto measure = [&](Attempt attempt) {
    attempt.psnr = MeasurePsnr(attempt, kSamples);
    const double psnr = attempt.psnr;
    const auto is_better = [&](const Attempt& a, const Attempt& b) {
      if (rank(a) != rank(b)) return rank(a) > rank(b);
      return rank(a) == 2 ? a.stream.size() < b.stream.size() : std::fabs(excess(a)) < std::fabs(excess(b));
    };
    if (!best || is_better(attempt, *best)) best = std::move(attempt);
    return psnr;
  };
  const auto is_done = [&] { return best && rank(*best) == 2; };

  std::optional<CodedSurface> from = SettleFrom(drawn);
  StatusOr<Attempt> attempt = std::move(drawn);
  std::map<double, double> measured;  // dB by ln(lambda)
  std::optional<Attempt> unmeasured;
  for (int i = 0; i < kEstimatedTries && !(is_done() && excess(*best) <= kPsnrNear) && !CannotReach() && measurements_ < kMostMeasurements; ++i) {
    if (i > 0) attempt = Settle(from);
    if (!attempt.ok()) break;  // NOLINT(bugprone-use-after-move): of the last round; this one has its own
    const double log_lambda = attempt.value().log_lambda, estimate = EstimatePsnr(attempt.value().stream);
    if (rank(attempt.value()) < 2) {  // by the estimate
      unmeasured = std::move(attempt).value();
      continue;
    }
    measured[log_lambda] = measure(std::move(attempt).value());
    const double offset = measured[log_lambda] - estimate;
    if (offset < *offset_ - kDefect) from.reset();  // descents from there would keep it
    offset_ = offset;
    unmeasured.reset();
  }
  if (unmeasured && !is_done()) {
    const double log_lambda = unmeasured->log_lambda;
    measured[log_lambda] = measure(std::move(*unmeasured));
  }

  // Where the curve jumps, estimates do not lead to the target; measuring may.
  values_ = measured;
  values_are_measured_ = true;
  offset_ = 0;
  for (int i = kEstimatedTries; i < kMeetTries && !is_done() && !CannotReach() && !(excess(*best) >= 0 && JumpsOverGoal()); ++i) {
    StatusOr<Attempt> tried = Settle(i < kSettlingTries ? from : std::nullopt);
    if (!tried.ok()) break;
    const double log_lambda = tried.value().log_lambda;
    values_[log_lambda] = measure(std::move(tried).value());
  }
  const bool meets_target = excess(*best) >= 0;
  return MeasuredStream{std::move(best->stream), best->psnr, meets_target, measurements_};
}

}  // namespace lacerta
