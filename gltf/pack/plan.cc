#include "pack/plan.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>

#include "document/draco_primitive.h"
#include "geometry/for_each_branch.h"
#include "lacerta/surface_distance.h"
#include "pack/family_plan.h"
#include "pack/scene_budget.h"

namespace lacerta {
namespace {

// Attributes are let go with the positions below this quality; above it their own targets hold.
constexpr double kAttributesFrom = 70.0;  // dB

double Slack(double psnr) { return std::max(1.0, std::pow(10.0, (kAttributesFrom - psnr) / 20.0)); }

// A share of the area: a shape that may be farther off loses more of its folds.
double TurnedAt(double turned, double psnr) {
  constexpr double kMost = 0.01;
  return std::min(turned * Slack(psnr), std::max(turned, kMost));
}

// The plans of all families, and of what is no part of one, in the order of the sources.
std::vector<PrimitivePlan> InOrder(const PackedScene& scene, std::vector<std::vector<PrimitivePlan>> families) {
  std::vector<PrimitivePlan> plans(scene.sources.size());
  for (size_t i = 0; i < scene.sources.size(); ++i) {
    if (scene.family_of[i] == PackedScene::kNone) plans[i] = UntouchedPlan(scene, i);
  }
  for (size_t f = 0; f < families.size(); ++f) {
    for (size_t m = 0; m < families[f].size(); ++m) plans[scene.families.families[f].members[m]] = std::move(families[f][m]);
  }
  return plans;
}

uint64_t NumVertices(const PackedScene& scene, size_t family) {
  uint64_t count = 0;
  for (const size_t member : scene.families.families[family].members) count += scene.sources[member].primitive->num_vertices;
  return count;
}

// Calls work(family) -> Status for families in turn, several at a time as far as they are small together: memory goes with their vertices. One at a time
// where somebody follows the progress, which is that of one. Returns the first failure in their order.
template <typename Work>
Status ForEachFamily(const PackedScene& scene, const PackOptions& options, const std::vector<size_t>& families, const Work& work) {
  constexpr uint64_t kMostTogether = 250'000;
  for (size_t first = 0, end = 0; first < families.size(); first = end) {
    uint64_t together = 0;
    do together += NumVertices(scene, families[end++]);
    while (end < families.size() && !options.encode.progress && together + NumVertices(scene, families[end]) <= kMostTogether);
    std::vector<Status> done(end - first);
    ForEachBranch(done.size(), [&](size_t i) { done[i] = work(families[first + i]); });
    for (Status& status : done) LACERTA_RETURN_IF_ERROR(std::move(status));
  }
  return Status();
}

std::vector<size_t> AllFamilies(const PackedScene& scene) {
  std::vector<size_t> all(scene.families.families.size());
  std::iota(all.begin(), all.end(), size_t{0});
  return all;
}

StatusOr<std::vector<PrimitivePlan>> PlanAlike(const PackedScene& scene, PackOptions options) {
  options.attributes.turned = TurnedAt(options.attributes.turned, TargetPsnr(options.encode.target));
  std::vector<std::vector<PrimitivePlan>> families(scene.families.families.size());
  LACERTA_RETURN_IF_ERROR(ForEachFamily(scene, options, AllFamilies(scene), [&](size_t f) -> Status {
    LACERTA_ASSIGN_OR_RETURN(families[f], PlanFamily({&scene, &options, f}));
    return Status();
  }));
  return InOrder(scene, std::move(families));
}

// A distance in units of the world as a share of the scene's diagonal; other targets as they are.
StatusOr<EncodeTarget> AsShare(const EncodeTarget& target, double scene_diagonal) {
  if (target.kind != EncodeTarget::Kind::kDistance) return target;
  if (!(scene_diagonal > 0.0)) return InvalidArgument("a distance in units of the scene is asked for, but it shows no triangles");
  return EncodeTarget{EncodeTarget::Kind::kError, target.value / scene_diagonal};
}

// A budget means the whole file where more than one stream has to share it; a stream alone meets its own to 2 %.
bool IsSharedBudget(const PackedScene& scene, const PackOptions& options) {
  if (options.encode.target.kind != EncodeTarget::Kind::kBytes) return false;
  if (scene.sources.size() != 1 || !scene.sources[0].primitive.has_value()) return true;
  bool smooth = false;
  return !ReasonAgainstProgressive({&scene, &options, 0}, 0, &smooth).empty();
}

PackOptions OptionsAt(const PackOptions& options, double psnr) {
  PackOptions at = options;
  at.encode.target = {EncodeTarget::Kind::kPsnr, psnr};
  for (double* target : {&at.attributes.uv_texels, &at.attributes.normal_degrees, &at.attributes.color, &at.attributes.custom}) *target *= Slack(psnr);
  at.attributes.normal_degrees = std::min(at.attributes.normal_degrees, 30.0);
  at.attributes.turned = TurnedAt(at.attributes.turned, psnr);
  return at;
}

// A family at the qualities that were tried.
class TriedFamily {
 public:
  TriedFamily(const PackedScene& scene, const PackOptions& options, size_t index)
      : scene_(scene), options_(options), index_(index), weight_(scene.families.families[index].weight) {
    for (size_t step = 0; step < kQualitySteps; ++step) {
      const double error = FamilyError(scene.families, index, PsnrOfStep(step));
      curve_.expected.push_back(weight_ * error * error);
    }
  }

  Status Try(size_t step) {
    const PackOptions at = OptionsAt(options_, PsnrOfStep(step));
    LACERTA_ASSIGN_OR_RETURN(std::vector<PrimitivePlan> plans, PlanFamily({&scene_, &at, index_}));
    RatePoint point{step, 0.0, 0.0};
    for (const PrimitivePlan& plan : plans) {
      point.bytes += static_cast<double>(plan.report.bytes_after);
      point.error = std::max(point.error, weight_ * ErrorOf(plan.report) * ErrorOf(plan.report));
    }
    curve_.known.push_back(point);
    plans_.push_back(std::move(plans));
    return Status();
  }

  // The quality to try in the place of `step`; none where what would be learned is not worth it.
  std::optional<size_t> NextTrial(size_t step, double worthwhile) const {
    if (IsKnown(curve_, step)) return curve_.known.size() == 1 ? SecondTrial(worthwhile) : std::nullopt;
    constexpr double kJump = 0.25;  // ln(bytes) per dB: it has become a stream, say, and nobody knows where
    const RatePoint *below = nullptr, *above = nullptr;
    for (const RatePoint& point : curve_.known) {
      if (point.step <= step && (below == nullptr || point.step > below->step)) below = &point;
      if (point.step >= step && (above == nullptr || point.step < above->step)) above = &point;
    }
    const double bytes = ExpectedBytes(curve_, step);
    const RatePoint* nearest = below == nullptr || (above != nullptr && above->step - step < step - below->step) ? above : below;
    // NOLINTNEXTLINE(clang-analyzer-core.NonNullParamChecker): a curve knows a point from the start
    const size_t distance = std::max(nearest->step, step) - std::min(nearest->step, step);
    constexpr size_t kFar = 4;  // steps
    if (std::fabs(bytes - nearest->bytes) < worthwhile && (bytes < worthwhile || distance < kFar)) return std::nullopt;
    if (below == nullptr || above == nullptr) return step;
    const double rise = std::log(std::max(above->bytes, 1.0) / std::max(below->bytes, 1.0));
    const size_t middle = (below->step + above->step) / 2;
    const bool jumps = rise >= kJump * (PsnrOfStep(above->step) - PsnrOfStep(below->step));
    return jumps && !IsKnown(curve_, middle) ? middle : step;
  }

  const RateCurve& curve() const { return curve_; }
  std::vector<PrimitivePlan> Take(size_t known) { return std::move(plans_[known]); }

 private:
  // A single trial does not tell what a finer quality takes, and where that is little a budget that seems spent is not.
  std::optional<size_t> SecondTrial(double worthwhile) const {
    constexpr size_t kFiner = 4;  // steps
    if (curve_.known.front().bytes < worthwhile || !(curve_.known.front().error > 0.0)) return std::nullopt;
    size_t step = curve_.known.front().step;
    while (step < kQualitySteps && IsKnown(curve_, step)) ++step;
    return step + kFiner <= kQualitySteps ? std::optional(step + kFiner - 1) : std::nullopt;
  }

  // What is kept as it was is exact.
  static double ErrorOf(const PrimitiveReport& report) {
    if (report.storage == PrimitiveStorage::kUntouched) return 0.0;
    const bool of_levels = report.error == 0.0 && !report.encode.levels.empty();
    return of_levels ? report.encode.levels.back().error : report.error;
  }

  const PackedScene& scene_;
  const PackOptions& options_;
  const size_t index_;
  const double weight_;
  RateCurve curve_;
  std::vector<std::vector<PrimitivePlan>> plans_;  // parallel to curve_.known
};

std::vector<RateCurve> CurvesOf(const std::vector<TriedFamily>& families) {
  std::vector<RateCurve> curves;
  curves.reserve(families.size());
  for (const TriedFamily& family : families) curves.push_back(family.curve());
  return curves;
}

// Every family at one quality first; then, round by round, those whose share of the budget is expected to be another one.
StatusOr<std::vector<PrimitivePlan>> PlanForBytes(const PackedScene& scene, const PackOptions& options) {
  constexpr int kMostRounds = 6;
  constexpr size_t kFirstStep = 100;       // 70 dB
  constexpr double kWorthwhile = 0.005;    // of the budget, for another trial
  constexpr double kGoodEnough = 0.97;     // sizes and errors scatter by some percent between neighboring qualities
  double budget = options.encode.target.value;
  for (size_t i = 0; i < scene.sources.size(); ++i) {
    if (scene.family_of[i] == PackedScene::kNone) budget -= static_cast<double>(UntouchedPlan(scene, i).report.bytes_after);
  }
  std::vector<TriedFamily> families;
  for (const size_t f : AllFamilies(scene)) families.emplace_back(scene, options, f);
  LACERTA_RETURN_IF_ERROR(ForEachFamily(scene, options, AllFamilies(scene), [&](size_t f) { return families[f].Try(kFirstStep); }));
  const double worthwhile = kWorthwhile * budget;
  std::vector<size_t> chosen = ChooseKnown(CurvesOf(families), budget);
  for (int round = 0; round < kMostRounds; ++round) {
    const std::vector<RateCurve> curves = CurvesOf(families);
    const std::vector<size_t> shares = ShareBudget(curves, budget);
    double known_bytes = 0.0, known_error = 0.0, expected_error = 0.0;
    for (size_t f = 0; f < families.size(); ++f) {
      known_bytes += curves[f].known[chosen[f]].bytes;
      known_error += curves[f].known[chosen[f]].error;
      expected_error += ExpectedError(curves[f], shares[f]);
    }
    if (round > 0 && known_bytes <= budget && known_bytes >= kGoodEnough * budget && expected_error >= kGoodEnough * known_error) break;
    std::vector<size_t> tried, steps(families.size());
    for (size_t f = 0; f < families.size(); ++f) {
      const std::optional<size_t> next = families[f].NextTrial(shares[f], worthwhile);
      if (!next.has_value()) continue;
      tried.push_back(f);
      steps[f] = *next;
    }
    if (tried.empty()) break;
    LACERTA_RETURN_IF_ERROR(ForEachFamily(scene, options, tried, [&](size_t f) { return families[f].Try(steps[f]); }));
    chosen = ChooseKnown(CurvesOf(families), budget);
  }
  std::vector<std::vector<PrimitivePlan>> plans;
  for (size_t f = 0; f < families.size(); ++f) plans.push_back(families[f].Take(chosen[f]));
  return InOrder(scene, std::move(plans));
}

}  // namespace

void TakeStream(EncodedMesh encoded, const EncodeTarget& target, PrimitivePlan* plan) {
  const double diagonal = encoded.report.diagonal;
  PrimitiveReport& report = plan->report;
  report.storage = PrimitiveStorage::kProgressive;
  report.reason = encoded.report.reason;
  report.bytes_after = encoded.stream.size();
  report.encode = encoded.report;
  switch (target.kind) {
    case EncodeTarget::Kind::kPsnr:
      report.target_error = DistanceOfPsnr(target.value, diagonal);
      break;
    case EncodeTarget::Kind::kError:
      report.target_error = target.value * diagonal;
      break;
    case EncodeTarget::Kind::kDistance:
      report.target_error = target.value;
      break;
    case EncodeTarget::Kind::kBytes:
    case EncodeTarget::Kind::kBitsPerVertex:
      report.target_error = 0.0;
      break;
  }
  plan->progressive = std::move(encoded);
}

bool IsAllInDraco(const EncodedMesh& encoded, bool smooth_normals, const PackOptions& options) {
  const bool is_wanted = options.fallback == Fallback::kDraco && options.encode.levels != LevelChoice::kAlways;
  return is_wanted && encoded.part_sizes.size() == 1 && !smooth_normals;
}

Status TakeAsDracoIfThatIsAll(const PackOptions& options, PrimitivePlan* plan) {
  if (!plan->progressive || !IsAllInDraco(*plan->progressive, plan->smooth_normals, options)) return Status();
  Bytes& stream = plan->progressive->stream;
  LACERTA_ASSIGN_OR_RETURN(DracoShape shape, DecodeDracoShape(stream));
  plan->report.storage = PrimitiveStorage::kDraco;
  plan->report.error = plan->report.encode.levels.back().error;
  plan->draco = DracoEncoded{std::move(stream), std::move(shape.ids), std::move(shape.primitive), {}};
  plan->progressive.reset();
  return Status();
}

StatusOr<std::vector<PrimitivePlan>> PlanPrimitives(const GltfDocument& document, const PackOptions& options) {
  LACERTA_ASSIGN_OR_RETURN(const PackedScene scene, ReadPackedScene(document, {options.drop_unused, options.drop_tangents}));
  if (IsSharedBudget(scene, options)) return PlanForBytes(scene, options);
  PackOptions resolved = options;
  LACERTA_ASSIGN_OR_RETURN(resolved.encode.target, AsShare(options.encode.target, scene.families.scene_diagonal));
  return PlanAlike(scene, std::move(resolved));
}

}  // namespace lacerta
