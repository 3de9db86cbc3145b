#include "remesh/simplify_to_errors.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "geometry/group_surface.h"
#include "geometry/root_bracket.h"
#include "remesh/attribute_fit.h"
#include "remesh/attributed_simplify.h"
#include "remesh/curve_fit.h"
#include "remesh/deviation_samples.h"

namespace lacerta {
namespace {

constexpr int kFitRounds = 2;
constexpr double kRadiansPerDegree = 0.017453292519943295;

// One unit of AttributeError in units of the attribute.
double ErrorUnit(const MeshAttribute& attribute, double texture_size) {
  if (attribute.kind == AttributeKind::kTextureCoordinates) return 1 / texture_size;
  const bool is_direction = IsDirection(attribute.kind);
  return is_direction && attribute.components >= 3 ? kRadiansPerDegree : 1;
}

double LimitWeight(double weight) { return std::clamp(weight, 1e-9, 1e3); }

// Whatever is allowed, the shape has to be kept as far as attributes are compared at closest points.
double ShapeTarget(const SurfaceErrorMeter& meter, const ErrorTargets& targets) {
  constexpr double kFarthest = 1e-3;
  return std::min(targets.distance, kFarthest * meter.diagonal());
}

// Of distances that are allowed in the mean. Small parts of large scenes may be far off for their size.
SimplificationBounds BoundsOf(const SurfaceErrorMeter& meter, const ErrorTargets& targets) {
  constexpr double kCharts = 2, kAnywhereOfSmall = 4;
  const double shape = ShapeTarget(meter, targets);
  const bool is_bounded = targets.distance < meter.diagonal();
  return {kCharts * shape, is_bounded ? std::max(kFarthestOverMean * shape, kAnywhereOfSmall * targets.distance) : 0};
}

struct Trial {
  AttributedMesh mesh;
  SurfaceErrors errors;
  double ratio = 0;
};

class Search {
 public:
  Search(const AttributedMesh& original, const SurfaceErrorMeter& meter, const ErrorTargets& targets, const SimplifyToErrorsOptions& options)
      : meter_(meter), targets_(targets), options_(options),
        num_fit_samples_(SamplesToTell(original.surface.triangles.size(), std::clamp<uint64_t>(original.surface.triangles.size(), 10'000, 100'000))),
        num_search_samples_(SamplesToTell(original.surface.triangles.size(), options.num_search_samples)),
        fit_target_(original.surface, num_fit_samples_), surface_(original) {}

  // The surface of that size, moved to where it is closest to the original.
  AttributedMesh Fitted(const AttributedSimplification& sequence, uint32_t num_triangles) const {
    AttributedMesh mesh = sequence.MeshWith(num_triangles);
    if (mesh.surface.triangles.size() == sequence.num_input_triangles()) return mesh;
    FitBesideCurves(fit_target_, kFitRounds, &mesh);
    AttributeFitOptions fit;
    fit.num_samples = num_fit_samples_;
    fit.diagonal = meter_.diagonal();
    FitAttributes(surface_, fit, &mesh);
    if (options_.finish) options_.finish(&mesh);
    return mesh;
  }

  // What is known of a sequence.
  struct Found {
    RootBracket ratios;                   // logarithms of errors over targets, over those of sizes: up to 0 triangles are enough
    std::optional<Trial> smallest;        // that meets the targets; nothing where none does
    std::optional<SurfaceErrors> missed;  // of the largest that does not

    // The size that just meets them, as far as it can be told.
    double Next() const {
      constexpr double kPower = 0.7;  // of a ratio, by which sizes are off about
      constexpr double kMargin = 1.01;
      if (ratios.IsKnown()) return std::exp(ratios.Next());
      const RootBracket::Point &enough = ratios.below(), &too_few = ratios.above(), &known = smallest ? enough : too_few;
      const double next = known.x + kPower * known.y;
      return kMargin * std::exp(too_few.x < next && next < enough.x ? next : (too_few.x + enough.x) / 2);
    }
  };

  // most: triangles.
  Found Unknown(const AttributedSimplification& sequence, double most) const {
    const double too_few = std::max(sequence.fewest_triangles(), 1u) - 0.5;
    return {RootBracket({std::log(std::max(most, too_few) + 0.5), RootBracket::kUnknown}, {std::log(too_few), RootBracket::kUnknown}), {}, {}};
  }

  // Looks for the smallest surface of the sequence, by the samples of the search, until errors come to good_enough of the targets. guess: its size.
  Status FindSmallest(const AttributedSimplification& sequence, double guess, double good_enough, Found* found) const {
    constexpr int kMaxTrials = 7;
    constexpr double kCloseEnough = 1.02, kTiny = 1e-6;
    double next = guess;
    for (int i = 0; i < kMaxTrials; ++i) {
      const double too_few = std::exp(found->ratios.above().x), enough = std::exp(found->ratios.below().x);
      // Sizes between the two, which may themselves be halfway between sizes.
      const double fewest = std::floor(too_few + 0.25) + 1, most = std::ceil(enough - 0.25) - 1;
      if (fewest > most || enough <= kCloseEnough * too_few) break;
      const auto size = static_cast<uint32_t>(std::clamp(next, fewest, most));
      LACERTA_ASSIGN_OR_RETURN(Trial trial, Measured(Fitted(sequence, size), num_search_samples_));
      const double ratio = trial.ratio, num_triangles = std::min<double>(size, static_cast<double>(trial.mesh.surface.triangles.size()));
      found->ratios.Narrow({std::log(ratio <= 1 ? num_triangles : size), std::log(std::max(ratio, kTiny))});
      if (ratio <= 1) {
        found->smallest = std::move(trial);
        if (ratio >= good_enough) break;
      } else {
        found->missed = std::move(trial.errors);
      }
      next = found->Next();
    }
    return Status();
  }

  // Few samples may have been too kind: what counts is measured with more, and given more triangles until it holds.
  Status Confirm(const AttributedSimplification& sequence, Trial* trial) const {
    LACERTA_ASSIGN_OR_RETURN(*trial, Measured(std::move(trial->mesh), options_.num_samples));
    if (trial->ratio <= 1) return Status();
    constexpr double kMostGrowth = 1.2;  // at a time: errors may jump
    for (double margin = 1.01; trial->ratio > 1; margin *= 1.01) {
      const auto triangles = static_cast<double>(trial->mesh.surface.triangles.size());
      const double size = std::max(triangles * std::min(trial->ratio, kMostGrowth) * margin, triangles + 1);
      const uint32_t all = sequence.num_input_triangles();
      const uint32_t wanted = size < all ? static_cast<uint32_t>(size) : all;
      LACERTA_ASSIGN_OR_RETURN(*trial, Measured(Fitted(sequence, wanted), options_.num_samples));
      if (wanted == all) break;
    }
    return Status();
  }

  StatusOr<Trial> Measured(AttributedMesh mesh, uint64_t num_samples) const {
    Trial trial;
    LACERTA_ASSIGN_OR_RETURN(trial.errors, meter_.Measure(mesh, num_samples));
    ErrorTargets others = targets_;
    others.turned = std::numeric_limits<double>::infinity();
    // What is turned is a handful of samples: more of them where nothing else is against it.
    if (num_samples < options_.num_samples && trial.errors.turned > targets_.turned && WorstRatio(trial.errors, others) <= 1) {
      LACERTA_ASSIGN_OR_RETURN(trial.errors, meter_.Measure(mesh, options_.num_samples));
    }
    trial.ratio = WorstRatio(trial.errors, targets_);
    trial.mesh = std::move(mesh);
    return trial;
  }

  // More for what is nearer to its target than the positions, less for what is farther, at the size that is nearest to the targets.
  void Reweight(const Found& found, std::vector<double>* weights) const {
    constexpr double kLeast = 0.05;
    const auto off = [&](const SurfaceErrors& errors) { return std::fabs(std::log(std::max(WorstRatio(errors, targets_), 1e-9))); };
    const SurfaceErrors& met = found.smallest->errors;
    const SurfaceErrors& nearest = found.missed && off(*found.missed) < off(met) ? *found.missed : met;
    const double position = std::max(nearest.distance / ShapeTarget(meter_, targets_), kLeast);
    for (size_t a = 0; a < weights->size(); ++a) {
      const double own = std::max(AttributeRatio(nearest, targets_, a), kLeast);
      (*weights)[a] = LimitWeight((*weights)[a] * own / position);
    }
  }

 private:
  const SurfaceErrorMeter& meter_;
  const ErrorTargets& targets_;
  const SimplifyToErrorsOptions& options_;
  const size_t num_fit_samples_;
  const uint64_t num_search_samples_;
  FitTarget fit_target_;
  GroupSurface surface_;
};

Status CheckTargets(const AttributedMesh& mesh, const ErrorTargets& targets) {
  if (targets.attributes.size() != mesh.attributes.size()) return InvalidArgument("there is not one target for each attribute");
  if (!targets.everywhere.empty() && targets.everywhere.size() != mesh.attributes.size()) return InvalidArgument("there is not one target everywhere for each attribute");
  if (!(targets.turned > 0)) return InvalidArgument("the target of the turned area must be above 0");
  if (!(targets.distance > 0)) return InvalidArgument("the target of the distance must be above 0");
  for (size_t a = 0; a < targets.attributes.size(); ++a) {
    if (!(targets.attributes[a] > 0) || (!targets.everywhere.empty() && !(targets.everywhere[a] > 0))) return InvalidArgument(mesh.attributes[a].name + ": its target must be above 0");
  }
  return Status();
}

}  // namespace

uint64_t SamplesToTell(size_t num_triangles, uint64_t most) {
  constexpr uint64_t kFewest = 2000, kPerTriangle = 16;
  return std::min(most, std::max(kFewest, kPerTriangle * num_triangles));
}

// Costs of collapses are sums over the area, targets means over the part of it that has the attribute.
std::vector<double> WeightsOfTargets(const AttributedMesh& mesh, const SurfaceErrorMeter& meter, const ErrorTargets& targets) {
  const std::vector<double> shares = AttributeShares(mesh);
  std::vector<double> weights;
  for (size_t a = 0; a < mesh.attributes.size(); ++a) {
    const double allowed = targets.attributes[a] * ErrorUnit(mesh.attributes[a], meter.texture_size());
    weights.push_back(LimitWeight(ShapeTarget(meter, targets) / meter.diagonal() / allowed / std::sqrt(shares[a])));
  }
  return weights;
}

StatusOr<SimplifiedSurface> SimplifyToErrors(const AttributedMesh& original, const SurfaceErrorMeter& meter, const ErrorTargets& targets,
                                             const SimplifyToErrorsOptions& options) {
  LACERTA_RETURN_IF_ERROR(CheckTargets(original, targets));
  const Search search(original, meter, targets, options);
  constexpr double kWorthwhile = 0.98;  // of the size, for another weighting
  const SimplificationBounds bounds = BoundsOf(meter, targets);
  std::vector<double> weights = WeightsOfTargets(original, meter, targets);
  constexpr double kRough = 0.85, kGood = 0.97;  // of the targets: while weights are looked for, and in the end
  std::optional<Search::Found> best;
  std::unique_ptr<const AttributedSimplification> best_sequence;
  std::vector<double> best_weights;
  const auto all = static_cast<double>(original.surface.triangles.size());
  double guess = 0.3 * all, most = all;
  // Far above the size that is wanted, weights hardly matter: further sequences begin there.
  constexpr double kHeadStart = 4, kWorthIt = 0.7;  // of that size; of the input
  std::optional<AttributedMesh> start;
  for (int i = 0; i < std::max(options.num_weightings, 1); ++i) {
    auto sequence = std::make_unique<const AttributedSimplification>(start ? *start : original, weights, std::vector<uint8_t>(), bounds);
    Search::Found found = search.Unknown(*sequence, most);
    LACERTA_RETURN_IF_ERROR(search.FindSmallest(*sequence, guess, kRough, &found));
    if (!found.smallest) break;
    best_weights = weights;
    search.Reweight(found, &weights);
    // The next weights have to show at once that they are better.
    guess = most = kWorthwhile * std::min(found.Next(), static_cast<double>(found.smallest->mesh.surface.triangles.size()));
    if (const double size = kHeadStart * guess; !start && size < kWorthIt * all) start = sequence->MeshWith(static_cast<uint32_t>(size));
    best = std::move(found);
    best_sequence = std::move(sequence);
  }
  Trial trial;
  if (!best) {
    LACERTA_ASSIGN_OR_RETURN(trial, search.Measured(original, options.num_samples));
  } else {
    if (best->smallest->ratio < kGood) LACERTA_RETURN_IF_ERROR(search.FindSmallest(*best_sequence, best->Next(), kGood, &*best));
    trial = std::move(*best->smallest);
    LACERTA_RETURN_IF_ERROR(search.Confirm(*best_sequence, &trial));
    if (trial.ratio > 1 && best_sequence->num_input_triangles() < original.surface.triangles.size()) {  // where it began is not enough
      LACERTA_RETURN_IF_ERROR(search.Confirm(AttributedSimplification(original, best_weights, {}, bounds), &trial));
    }
  }
  return SimplifiedSurface{std::move(trial.mesh), std::move(trial.errors), trial.ratio <= 1};
}

}  // namespace lacerta
