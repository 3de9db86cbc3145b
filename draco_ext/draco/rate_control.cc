#include "draco/rate_control.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace lacerta {
namespace {

// Typical slopes of the rate-distortion curve, to extrapolate from a single point; the search corrects them.
constexpr double kPsnrPerLogLambda = -2.9;       // dB per unit of ln(lambda)
constexpr double kLogBytesPerLogLambda = -0.32;
constexpr double kLogBytesPerDecibel = kLogBytesPerLogLambda / kPsnrPerLogLambda;
constexpr double kFirstLambda = 1.2e-4;          // of the squared distance aimed at, per bit

// What counts as met: [psnr, psnr + 0.3) and (0.98, 1] of the bytes, less a margin for the noise of the measure.
constexpr double kPsnrMargin = 0.03, kPsnrSlack = 0.24;
constexpr double kBytesSlack = 0.018;
constexpr int kMaxTries = 14;

constexpr uint64_t kRoughSamples = 30'000;

// Base sizes tried: a ladder, walked from where streams of that quality have their base on typical surfaces.
constexpr double kFirstRung = 48, kRungRatio = 1.5;
uint32_t RungSize(int rung) { return static_cast<uint32_t>(std::lround(kFirstRung * std::pow(kRungRatio, rung))); }

// One coded attempt: the value is in the unit of the target, ln(bytes) or dB.
struct Attempt {
  double log_lambda = 0;
  CodedStream stream;
  double psnr = 0;
  double value = 0;
};

class CandidateSearch {
 public:
  CandidateSearch(const NormalMeshCandidate& candidate, const SurfaceDistanceMeter& meter, const ResolvedTarget& target,
                  EncodeMode mode)
      : candidate_(candidate), meter_(meter), target_(target), mode_(mode) {}

  // Codes near the target with a few attempts and estimates what the other quantity will be right at it: ln(bytes) at the PSNR,
  // or -PSNR at the bytes. Smaller is better. Infinite where the candidate cannot reach the PSNR.
  StatusOr<double> Score();
  // Attempts until the target is met; the best one that does not miss it, else the nearest.
  StatusOr<Attempt> Meet(bool* met);

 private:
  StatusOr<Attempt> Try(double log_lambda, uint64_t num_samples) const;
  double Goal() const { return target_.is_rate ? std::log(target_.bytes) : target_.psnr; }
  double TypicalSlope() const { return target_.is_rate ? kLogBytesPerLogLambda : kPsnrPerLogLambda; }
  double FirstGuess() const;
  double NextGuess() const;
  bool CannotReach() const;

  const NormalMeshCandidate& candidate_;
  const SurfaceDistanceMeter& meter_;
  const ResolvedTarget& target_;
  const EncodeMode mode_;
  std::map<double, double> values_;  // value by ln(lambda) of all attempts so far
};

StatusOr<Attempt> CandidateSearch::Try(double log_lambda, uint64_t num_samples) const {
  Attempt attempt;
  attempt.log_lambda = log_lambda;
  LACERTA_ASSIGN_OR_RETURN(attempt.stream, candidate_.Code(std::exp(log_lambda), mode_));
  if (num_samples > 0) {
    SurfaceDistanceOptions options;
    options.num_samples = num_samples;
    options.max_at_vertices = false;
    LACERTA_ASSIGN_OR_RETURN(const SurfaceDistance distance, meter_.Measure(attempt.stream.FinestMesh(), options));
    attempt.psnr = Psnr(distance.Rms(), meter_.diagonal());
  }
  attempt.value = target_.is_rate ? std::log(static_cast<double>(attempt.stream.size())) : attempt.psnr;
  return attempt;
}

double CandidateSearch::FirstGuess() const {
  constexpr double kUsualPsnr = 70;
  const double distance = DistanceOfPsnr(target_.is_rate ? kUsualPsnr : target_.psnr, meter_.diagonal());
  return std::log(kFirstLambda * distance * distance);
}

// The next ln(lambda) to try: between the two attempts around the goal, or beyond the nearest one.
double CandidateSearch::NextGuess() const {
  if (values_.empty()) return FirstGuess();
  const double goal = Goal();
  auto above = values_.end(), below = values_.end();  // of the goal; values fall as lambda grows
  for (auto it = values_.begin(); it != values_.end(); ++it) {
    if (it->second >= goal && (above == values_.end() || it->first > above->first)) above = it;
    if (it->second < goal && (below == values_.end() || it->first < below->first)) below = it;
  }
  if (above != values_.end() && below != values_.end() && below->first > above->first) {
    const double width = below->first - above->first;
    const double share = (above->second - goal) / (above->second - below->second);
    return above->first + width * std::clamp(share, 0.08, 0.92);
  }
  const auto nearest = above != values_.end() ? above : below;
  const double step = (goal - nearest->second) / TypicalSlope();
  // Beyond all attempts: somewhat farther than it seems, so that the goal gets bracketed.
  return nearest->first + std::clamp(1.1 * step, -4.0, 4.0) + (step < 0 ? -0.02 : 0.02);
}

// A finer slope no longer raises the PSNR: the remesh itself is the limit.
bool CandidateSearch::CannotReach() const {
  if (target_.is_rate || values_.size() < 3) return false;
  const auto first = values_.begin(), second = std::next(first);
  return first->second < Goal() && (first->second - second->second) < 0.15 * (second->first - first->first);
}

StatusOr<double> CandidateSearch::Score() {
  constexpr int kTries = 2;
  double score = std::numeric_limits<double>::infinity();
  double nearest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < kTries; ++i) {
    LACERTA_ASSIGN_OR_RETURN(const Attempt attempt, Try(NextGuess(), kRoughSamples));
    values_[attempt.log_lambda] = attempt.value;
    const double miss = Goal() - attempt.value;
    if (std::fabs(miss) >= nearest) continue;
    nearest = std::fabs(miss);
    const double log_bytes = std::log(static_cast<double>(attempt.stream.size()));
    score = target_.is_rate ? -(attempt.psnr + miss / kLogBytesPerDecibel) : log_bytes + kLogBytesPerDecibel * miss;
  }
  return score;
}

StatusOr<Attempt> CandidateSearch::Meet(bool* met) {
  const double low = target_.is_rate ? Goal() - kBytesSlack : Goal() + kPsnrMargin;
  const double high = target_.is_rate ? Goal() : Goal() + kPsnrSlack;
  std::optional<Attempt> best;
  const auto is_better = [&](const Attempt& a) {
    if (!best) return true;
    const auto keeps = [&](const Attempt& x) { return target_.is_rate ? x.value <= high : x.value >= low; };
    if (keeps(a) != keeps(*best)) return keeps(a);
    return std::fabs(a.value - Goal()) < std::fabs(best->value - Goal());
  };
  *met = false;
  for (int i = 0; i < kMaxTries && !*met && !CannotReach(); ++i) {
    LACERTA_ASSIGN_OR_RETURN(Attempt attempt, Try(NextGuess(), target_.is_rate ? 0 : SurfaceDistanceOptions().num_samples));
    values_[attempt.log_lambda] = attempt.value;
    *met = attempt.value >= low && attempt.value <= high;
    if (is_better(attempt)) best = std::move(attempt);
  }
  if (!best) return InternalError("rate control made no attempt");
  if (!target_.is_rate) *met = best->value >= target_.psnr;
  if (target_.is_rate) *met = best->value <= high;
  return std::move(*best);
}

int FirstRung(const ResolvedTarget& target, double num_input_vertices) {
  const double quality = target.is_rate ? 62 + 6 * std::log2(1 + 8 * 4 * target.bytes / num_input_vertices) : target.psnr;
  const double size = 180 * std::pow(2.0, (quality - 70) / 7);
  return std::max(0, static_cast<int>(std::lround(std::log(size / kFirstRung) / std::log(kRungRatio))));
}

}  // namespace

StatusOr<ResolvedTarget> ResolveTarget(const EncodeTarget& target, uint64_t num_input_vertices) {
  const auto check = [&](double low, double high, const char* what) {
    if (target.value >= low && target.value <= high) return Status();
    return InvalidArgument("target of " + std::to_string(target.value) + " " + what + " is not between " +
                           std::to_string(low) + " and " + std::to_string(high));
  };
  switch (target.kind) {
    case EncodeTarget::Kind::kBytes:
      LACERTA_RETURN_IF_ERROR(check(100, 1e12, "bytes"));
      return ResolvedTarget{true, target.value, 0};
    case EncodeTarget::Kind::kBitsPerVertex:
      LACERTA_RETURN_IF_ERROR(check(1e-3, 96, "bits per vertex"));
      return ResolvedTarget{true, target.value * static_cast<double>(num_input_vertices) / 8, 0};
    case EncodeTarget::Kind::kPsnr:
      LACERTA_RETURN_IF_ERROR(check(20, 140, "dB"));
      return ResolvedTarget{false, 0, target.value};
    case EncodeTarget::Kind::kError:
      LACERTA_RETURN_IF_ERROR(check(1e-7, 0.1, "of the diagonal"));
      return ResolvedTarget{false, 0, -20 * std::log10(target.value)};
  }
  return InvalidArgument("unknown kind of target");
}

StatusOr<MeasuredStream> CodeAtTarget(const InputSurface& surface, const CollapseHistory& history,
                                      const SurfaceDistanceMeter& meter, const ResolvedTarget& target, EncodeMode mode,
                                      const std::function<void(double, const char*)>& progress) {
  const auto num_input = static_cast<uint32_t>(surface.mesh().positions.size());
  const int last_rung = std::max(
      0, static_cast<int>(std::floor(std::log(std::max(1.0, num_input / 2.0 / kFirstRung)) / std::log(kRungRatio))));
  struct Rung {
    std::unique_ptr<NormalMeshCandidate> candidate;
    std::unique_ptr<CandidateSearch> search;
    double remesh_psnr = 0;
    double score = std::numeric_limits<double>::infinity();
  };
  std::map<int, Rung> rungs;
  const auto visit = [&](int r) -> StatusOr<double> {
    if (r < 0 || r > last_rung) return std::numeric_limits<double>::infinity();
    const auto found = rungs.find(r);
    if (found != rungs.end()) return found->second.score;
    if (progress) progress(std::min(0.8, 0.1 + 0.12 * static_cast<double>(rungs.size())), "choosing the base mesh");
    Rung rung;
    LACERTA_ASSIGN_OR_RETURN(NormalMeshCandidate candidate, NormalMeshCandidate::Create(surface, history, RungSize(r)));
    rung.candidate = std::make_unique<NormalMeshCandidate>(std::move(candidate));
    rung.search = std::make_unique<CandidateSearch>(*rung.candidate, meter, target, mode);
    SurfaceDistanceOptions options;
    options.num_samples = kRoughSamples;
    options.max_at_vertices = false;
    LACERTA_ASSIGN_OR_RETURN(const SurfaceDistance distance, meter.Measure(rung.candidate->RemeshedSurface(), options));
    rung.remesh_psnr = Psnr(distance.Rms(), meter.diagonal());
    constexpr double kHeadroom = 0.5;  // dB that quantization takes at least
    if (target.is_rate || rung.remesh_psnr > target.psnr + kHeadroom) {
      LACERTA_ASSIGN_OR_RETURN(rung.score, rung.search->Score());
    }
    return (rungs[r] = std::move(rung)).score;
  };

  // Up the ladder past remeshes that cannot reach the target, then downhill.
  int best = std::min(FirstRung(target, num_input), last_rung);
  double best_score = 0;
  for (;; ++best) {
    LACERTA_ASSIGN_OR_RETURN(best_score, visit(best));
    if (std::isfinite(best_score) || best == last_rung) break;
  }
  for (const int direction : {-1, 1}) {
    for (;;) {
      LACERTA_ASSIGN_OR_RETURN(const double score, visit(best + direction));
      if (!(score < best_score)) break;
      best_score = score;
      best += direction;
    }
  }
  if (!std::isfinite(best_score)) {  // nothing reaches it: the best remesh there is
    for (const auto& [r, rung] : rungs) {
      if (rung.remesh_psnr > rungs[best].remesh_psnr) best = r;
    }
  }
  if (progress) progress(0.85, "meeting the target");
  const Rung& chosen = rungs[best];
  MeasuredStream result;
  LACERTA_ASSIGN_OR_RETURN(Attempt attempt, chosen.search->Meet(&result.meets_target));
  result.stream = std::move(attempt.stream);
  result.psnr = attempt.psnr;
  result.remesh_psnr = chosen.remesh_psnr;
  result.normal_share = NormalShare(chosen.candidate->normal_mesh());
  return result;
}

}  // namespace lacerta
