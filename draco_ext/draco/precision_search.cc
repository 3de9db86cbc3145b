#include "draco/precision_search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "draco/candidate_search.h"
#include "remesh/level_wedges.h"

namespace lacerta {
namespace {

double Square(double x) { return x * x; }

// What errors asked for an attribute led to so far: found ones jump where another prediction or number of levels comes to be the cheapest.
struct ErrorLimits {
  double met = 0, missed = std::numeric_limits<double>::infinity();

  // The next error to ask for, given the last one, what it led to, and the one that seems right.
  double Between(double last, double next, bool is_met) {
    constexpr double kNoGap = 1.03;
    (is_met ? met : missed) = last;
    if (met >= missed) (is_met ? missed : met) = is_met ? std::numeric_limits<double>::infinity() : 0;  // of other positions
    if (is_met && missed < kNoGap * met) return last;
    if (next > met && next < missed) return next;
    return next >= missed && met > 0 ? std::sqrt(met * missed) : next >= missed ? missed / kNoGap : next;
  }
};

// The precisions of one candidate, corrected from attempt to attempt.
class PrecisionSearch {
 public:
  PrecisionSearch(const AttributedNormalMesh& mesh, const SurfaceErrors& remesh, const AttributedSurface& input,
                  const ErrorTargets& targets, const MeetOptions& options)
      : mesh_(mesh), remesh_(remesh), input_(input), meter_(input.meter), targets_(targets), options_(options) {
    limits_.resize(mesh.attributes.size());
    precision_.lambda = UsualLambda(Psnr(targets.distance, meter_.diagonal()), meter_.diagonal());
    precision_.joints = input.meaning.joints;
    precision_.factors = input.meaning.factors;
    precision_.beside = input.meaning.beside;
    precision_.refit = [&original = input.original](AttributedSemiRegularMesh* decoded) { FitLevelAttributes(original, decoded); };
    for (size_t a = 0; a < mesh.attributes.size(); ++a) {
      precision_.errors.push_back(std::sqrt(Allowed(remesh.attributes[a].rms_99, targets.attributes[a])) / UnitOf(a));
    }
  }

  // Until the targets are met by few samples, with little left of them.
  Status FirstTries() {
    for (int i = 0; i < options_.first_tries; ++i) {
      const bool was_met = best_ && best_->ratio <= 1;
      LACERTA_RETURN_IF_ERROR(Try(RoughSamples()));
      if (IsHopeless() || (was_met && last_.stream.size() > best_->stream.size())) break;
      constexpr double kBelow = 0.8;
      const double last_lambda = precision_.lambda;
      const std::vector<double> last_errors = precision_.errors;
      if (SlidesTooFar()) most_lambda_ = std::min(most_lambda_, kBelow * last_lambda);
      CorrectErrors(CorrectLambda());
      if (precision_.lambda == last_lambda && precision_.errors == last_errors) break;
    }
    return Status();
  }

  // Whether more precise positions make more of room for attributes than they cost.
  Status FinerTries() {
    if (best_->ratio > 1 || IsHopeless()) return Status();
    constexpr double kStep = 1.6;  // between slopes, 2 dB
    constexpr double kHopeless = 1.02;
    precision_ = best_precision_;
    last_ = *best_;
    for (int i = 0; i < options_.finer_tries && Slides(); ++i) {
      CorrectErrors(precision_.lambda / kStep);
      const size_t least = best_->stream.size();
      LACERTA_RETURN_IF_ERROR(Try(RoughSamples()));
      if (static_cast<double>(last_.stream.size()) > kHopeless * static_cast<double>(least)) break;
    }
    return Status();
  }

  // Few samples may have been too kind.
  Status Confirm() {
    constexpr int kTries = 4;
    if (IsHopeless()) return Status();
    precision_ = best_precision_;
    last_ = std::move(*best_);
    best_.reset();
    LACERTA_RETURN_IF_ERROR(Measure(options_.num_samples));
    for (int i = 0; i < kTries && best_->ratio > 1 && !IsHopeless(); ++i) {
      CorrectErrors(CorrectLambda());
      LACERTA_RETURN_IF_ERROR(Try(options_.num_samples));
    }
    return Status();
  }

  AttributedTrial Best() {
    best_->remesh_distance = remesh_.distance;
    best_->measurements = measurements_;
    return std::move(*best_);
  }

 private:
  static constexpr double kAim = 0.98;  // of the targets

  // What the remesh leaves to quantization, squared. Errors add up as squares.
  static double Allowed(double remesh, double target) { return Square(kAim * target) - Square(std::min(remesh, 0.93 * target)); }

  // What of the present error, squared, is not the remesh's.
  static double Added(double found, double remesh, double target) {
    return std::max(Square(found) - Square(std::min(remesh, 0.93 * target)), 0.01 * Square(target));
  }

  // Of errors in SurfaceErrors, per unit of those that the stream has.
  double UnitOf(size_t a) const { return mesh_.attributes[a].kind == AttributeKind::kTextureCoordinates ? meter_.texture_size() : 1.0; }

  // What sliding positions add to the error of an attribute, squared: what neither remesh nor residuals are to blame for.
  double SlideOf(size_t a) const {
    const double added = Added(last_.errors.attributes[a].rms_99, remesh_.attributes[a].rms_99, targets_.attributes[a]);
    return std::max(added - Square(last_.stream.errors[a] * UnitOf(a)), 0.0);
  }

  bool Slides() const {
    constexpr double kLeastShare = 0.15;
    for (size_t a = 0; a < precision_.errors.size(); ++a) {
      if (SlideShare(a) > kLeastShare) return true;
    }
    return false;
  }

  // Close enough: every change of one precision makes another stream, whose other errors jump a little.
  static bool IsNear(double found, double target) { return found <= target && found > 0.95 * target; }

  static constexpr double kMostSlide = 0.5;  // of what an attribute may be off, squared

  double SlideShare(size_t a) const { return SlideOf(a) / Allowed(remesh_.attributes[a].rms_99, targets_.attributes[a]); }

  bool SlidesTooFar() const {
    for (size_t a = 0; a < precision_.errors.size(); ++a) {
      if (SlideShare(a) > kMostSlide) return true;
    }
    return false;
  }

  // Coarse or fine enough for the distance, and for positions not to slide too far.
  double CorrectLambda() const {
    constexpr double kOtherTurned = 0.92, kLeastTurned = 0.6;  // which triangles turn is chance, in part
    double change = IsNear(last_.errors.distance, targets_.distance)
                        ? 1
                        : Allowed(remesh_.distance, targets_.distance) / Added(last_.errors.distance, remesh_.distance, targets_.distance);
    if (last_.errors.MostTurned() > targets_.turned) change = std::min(change, std::clamp(targets_.turned / last_.errors.MostTurned(), kLeastTurned, kOtherTurned));
    for (size_t a = 0; a < precision_.errors.size(); ++a) {
      constexpr double kMuch = 0.2;
      if (SlideShare(a) > kMuch) change = std::min(change, std::min(kMostSlide / SlideShare(a), 1.0));
    }
    return std::min(precision_.lambda * std::clamp(change, 0.05, 20.0), most_lambda_);
  }

  // To meet the targets at another lambda, whose squared errors go with it.
  void CorrectErrors(double lambda) {
    for (size_t a = 0; a < precision_.errors.size(); ++a) {
      const double remesh = remesh_.attributes[a].rms_99, target = targets_.attributes[a], found = last_.errors.attributes[a].rms_99;
      const double slide = SlideOf(a), more_slide = slide * (lambda / precision_.lambda - 1);
      if (IsNear(std::sqrt(std::max(Square(found) + more_slide, 0.0)), target)) continue;
      if (found <= target && last_.stream.residual_bytes[a] == 0) continue;
      const double own = std::max(Added(found, remesh, target) - slide, 0.01 * Square(target));
      const double left = Allowed(remesh, target) - slide - more_slide;
      precision_.errors[a] = limits_[a].Between(precision_.errors[a], precision_.errors[a] * std::sqrt(std::clamp(left / own, 0.1, 10.0)), found <= target);
    }
    precision_.lambda = lambda;
  }

  uint64_t RoughSamples() const {
    constexpr uint64_t kShare = 4;
    return std::max<uint64_t>(options_.num_samples / kShare, 1);
  }

  Status Try(uint64_t num_samples) {
    LACERTA_ASSIGN_OR_RETURN(last_.stream, EncodeAttributedStream(mesh_, precision_));
    return Measure(num_samples);
  }

  // Keeps it where it is better than the best.
  Status Measure(uint64_t num_samples) {
    LACERTA_ASSIGN_OR_RETURN(last_.errors, input_.Measure(FinestLevel(last_.stream.decoded), num_samples));
    ++measurements_;
    last_.ratio = WorstRatio(last_.errors, targets_);
    last_.least_bytes = LeastBytes();
    const auto is_better = [&](const AttributedTrial& other) {
      if (last_.ratio <= 1 && other.ratio <= 1) return last_.stream.size() < other.stream.size();
      return last_.ratio < other.ratio;
    };
    if (!best_ || is_better(*best_)) {
      best_ = last_;
      best_precision_ = precision_;
    }
    return Status();
  }

  // Bytes above the base go about as one over the errors that they are spent on, those of the base as their logarithm.
  double LeastBytes() const {
    constexpr double kOfBase = 0.9;
    const auto saved = [](size_t bytes, double found, double target) {
      constexpr double kLeastRatio = 0.5;
      return static_cast<double>(bytes) * (1 - std::clamp(found / target, kLeastRatio, 1.0));
    };
    const AttributedStream& stream = last_.stream;
    size_t position_bytes = stream.refinement.size(), base_bytes = 0;
    for (const Bytes& base : stream.bases) base_bytes += base.size();
    for (const size_t bytes : stream.residual_bytes) position_bytes -= std::min(bytes, position_bytes);
    double least = static_cast<double>(stream.size()) - (1 - kOfBase) * static_cast<double>(base_bytes);
    least -= saved(position_bytes, last_.errors.distance, targets_.distance);
    for (size_t a = 0; a < stream.residual_bytes.size(); ++a) {
      least -= saved(stream.residual_bytes[a], last_.errors.attributes[a].rms_99, targets_.attributes[a]);
    }
    return least;
  }

  bool IsHopeless() const { return last_.least_bytes >= static_cast<double>(options_.most_bytes); }

  const AttributedNormalMesh& mesh_;
  const SurfaceErrors& remesh_;
  const AttributedSurface& input_;
  const SurfaceErrorMeter& meter_;
  const ErrorTargets& targets_;
  const MeetOptions& options_;
  AttributedStreamOptions precision_, best_precision_;
  std::vector<ErrorLimits> limits_;
  double most_lambda_ = std::numeric_limits<double>::infinity();  // beyond, positions slide too far
  AttributedTrial last_;
  int measurements_ = 0;
  std::optional<AttributedTrial> best_;
};

}  // namespace

StatusOr<AttributedTrial> SearchPrecisions(const AttributedNormalMesh& mesh, const SurfaceErrors& remesh, const AttributedSurface& input,
                                           const ErrorTargets& targets, const MeetOptions& options) {
  if (options.first_tries < 1) return InvalidArgument("no attempt was allowed");
  PrecisionSearch search(mesh, remesh, input, targets, options);
  LACERTA_RETURN_IF_ERROR(search.FirstTries());
  LACERTA_RETURN_IF_ERROR(search.FinerTries());
  LACERTA_RETURN_IF_ERROR(search.Confirm());
  return search.Best();
}

}  // namespace lacerta
