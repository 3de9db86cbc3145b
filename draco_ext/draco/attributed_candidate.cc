#include "draco/attributed_candidate.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "draco/candidate_search.h"
#include "remesh/level_attributes.h"

namespace lacerta {
namespace {

constexpr uint64_t kRoughSamples = 20'000;

double Square(double x) { return x * x; }

// The precisions of one candidate, corrected from attempt to attempt.
class PrecisionSearch {
 public:
  PrecisionSearch(const AttributedNormalMesh& mesh, const SurfaceErrors& remesh, const SurfaceErrorMeter& meter, const ErrorTargets& targets,
                  const MeetOptions& options)
      : mesh_(mesh), remesh_(remesh), meter_(meter), targets_(targets), options_(options) {
    precision_.lambda = UsualLambda(Psnr(targets.distance, meter.diagonal()), meter.diagonal());
    for (size_t a = 0; a < mesh.attributes.size(); ++a) {
      precision_.errors.push_back(std::sqrt(Allowed(remesh.attributes[a].rms_99, targets.attributes[a])) / UnitOf(a));
    }
  }

  // Until the targets are met, with little left of them.
  Status FirstTries() {
    for (int i = 0; i < options_.first_tries; ++i) {
      LACERTA_RETURN_IF_ERROR(Try());
      const AttributedStreamOptions before = precision_;
      CorrectErrors(CorrectLambda());
      if (last_.ratio <= 1 && IsLike(before, precision_)) break;
      if (last_.ratio > 1 && 2 * (i + 1) >= options_.first_tries && IsLike(before, precision_)) Finer();
    }
    return Status();
  }

  // Whether more precise positions make more of room for attributes than they cost.
  Status FinerTries() {
    if (!best_ || best_->ratio > 1) return Status();
    constexpr double kStep = 1.6;  // between slopes, 2 dB
    precision_ = best_precision_;
    last_ = *best_;
    double lambda = precision_.lambda / kStep;
    for (int i = 0; i < options_.finer_tries; ++i) {
      CorrectErrors(lambda);
      const size_t least = best_->stream.size();
      LACERTA_RETURN_IF_ERROR(Try());
      if (last_.ratio <= 1 && best_->stream.size() < least) {
        lambda /= kStep;
      } else if (last_.stream.size() >= least) {
        break;
      }
    }
    return Status();
  }

  StatusOr<AttributedTrial> Best() {
    if (!best_) return InvalidArgument("no attempt was allowed");
    return std::move(*best_);
  }

 private:
  static constexpr double kAim = 0.985;  // of the targets

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

  // Coarse or fine enough for the distance, and for sliding to leave attributes half of what they may be off.
  double CorrectLambda() const {
    constexpr double kMostSlide = 0.5;
    double change = Allowed(remesh_.distance, targets_.distance) / Added(last_.errors.distance, remesh_.distance, targets_.distance);
    for (size_t a = 0; a < precision_.errors.size(); ++a) {
      const double slide = SlideOf(a), allowed = Allowed(remesh_.attributes[a].rms_99, targets_.attributes[a]);
      if (slide > kMostSlide * allowed) change = std::min(change, kMostSlide * allowed / slide);
    }
    return precision_.lambda * std::clamp(change, 0.05, 20.0);
  }

  // To meet the targets at another lambda, whose squared errors go with it.
  void CorrectErrors(double lambda) {
    for (size_t a = 0; a < precision_.errors.size(); ++a) {
      const double remesh = remesh_.attributes[a].rms_99, target = targets_.attributes[a], slide = SlideOf(a);
      const double own = std::max(Added(last_.errors.attributes[a].rms_99, remesh, target) - slide, 0.01 * Square(target));
      const double left = Allowed(remesh, target) - slide * lambda / precision_.lambda;
      precision_.errors[a] *= std::sqrt(std::clamp(left / own, 0.1, 10.0));
    }
    precision_.lambda = lambda;
  }

  void Finer() {
    constexpr double kFiner = 0.8;
    precision_.lambda *= kFiner * kFiner;
    for (double& error : precision_.errors) error *= kFiner;
  }

  static bool IsLike(const AttributedStreamOptions& a, const AttributedStreamOptions& b) {
    constexpr double kSame = 1.06;
    const auto is_like = [](double x, double y) { return x <= kSame * y && y <= kSame * x; };
    bool result = is_like(std::sqrt(a.lambda), std::sqrt(b.lambda));
    for (size_t i = 0; i < a.errors.size(); ++i) result = result && is_like(a.errors[i], b.errors[i]);
    return result;
  }

  Status Try() {
    LACERTA_ASSIGN_OR_RETURN(last_.stream, EncodeAttributedStream(mesh_, precision_));
    LACERTA_ASSIGN_OR_RETURN(last_.errors, meter_.Measure(FinestLevel(last_.stream.decoded), options_.num_samples));
    last_.ratio = WorstRatio(last_.errors, targets_);
    const auto is_better = [&](const AttributedTrial& other) {
      if (last_.ratio <= 1 && other.ratio <= 1) return last_.stream.size() < other.stream.size();
      return last_.ratio < other.ratio;
    };
    if (!best_ || is_better(*best_)) {
      best_ = last_;
      best_precision_ = precision_;
    }
    if (best_->ratio <= 1) return Status();
    // Bytes go about as one over the errors; so the one farthest within its target bounds what can be saved.
    double least = last_.errors.distance / targets_.distance;
    for (size_t a = 0; a < precision_.errors.size(); ++a) least = std::min(least, last_.errors.attributes[a].rms_99 / targets_.attributes[a]);
    const double needed = static_cast<double>(last_.stream.size()) * std::min(least, 1.0);
    if (needed < static_cast<double>(options_.most_bytes)) return Status();
    return Unsupported("about " + std::to_string(std::lround(needed)) + " bytes or more would be needed");
  }

  const AttributedNormalMesh& mesh_;
  const SurfaceErrors& remesh_;
  const SurfaceErrorMeter& meter_;
  const ErrorTargets& targets_;
  const MeetOptions& options_;
  AttributedStreamOptions precision_, best_precision_;
  AttributedTrial last_;
  std::optional<AttributedTrial> best_;
};

}  // namespace

StatusOr<AttributedCandidate> AttributedCandidate::Create(const AttributedSurface& input, uint32_t num_base_vertices, int num_levels) {
  AttributedRemeshOptions options;
  options.num_base_vertices = num_base_vertices;
  options.num_levels = num_levels;
  LACERTA_ASSIGN_OR_RETURN(AttributedNormalMesh mesh, RemeshAttributed(input.parts, input.surface, input.history, options));
  AttributedSemiRegularMesh levels = mesh.Semiregular();
  FitLevelAttributes(input.original, &levels);
  LACERTA_ASSIGN_OR_RETURN(SurfaceErrors errors, input.meter.Measure(FinestLevel(levels), kRoughSamples));
  mesh.attributes = std::move(levels.attributes);
  return AttributedCandidate(input, std::move(mesh), std::move(errors));
}

bool AttributedCandidate::CanMeet(const ErrorTargets& targets) const {
  constexpr double kLeastLeft = 0.93;  // of a target: the rest would cost more than a finer remesh
  return WorstRatio(errors_, targets) < kLeastLeft;
}

StatusOr<AttributedTrial> AttributedCandidate::Meet(const ErrorTargets& targets, const MeetOptions& options) const {
  PrecisionSearch search(mesh_, errors_, input_.meter, targets, options);
  LACERTA_RETURN_IF_ERROR(search.FirstTries());
  LACERTA_RETURN_IF_ERROR(search.FinerTries());
  return search.Best();
}

}  // namespace lacerta
