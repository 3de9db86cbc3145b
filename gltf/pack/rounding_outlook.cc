#include "pack/rounding_outlook.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <string>
#include <utility>

namespace lacerta {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

double Square(double x) { return x * x; }

// How many levels finer a step is that is this many times smaller.
int LevelsFiner(double factor) { return static_cast<int>(std::ceil(kLevelsPerBit * std::log2(factor))); }

// Of colors and of application attributes, which the surface tells.
std::map<std::string, double> TargetsByName(const FamilyMeter& meter) {
  std::map<std::string, double> targets;
  if (!meter.status().ok()) return targets;
  const std::vector<MeshAttribute>& attributes = meter.original().attributes;
  for (size_t a = 0; a < attributes.size(); ++a) {
    if (attributes[a].kind == AttributeKind::kColor || meter.custom().count(attributes[a].name) > 0)
      targets.emplace(attributes[a].name, meter.targets().attributes[a]);
  }
  return targets;
}

}  // namespace

RoundingOutlook::RoundingOutlook(const std::vector<const Primitive*>& primitives, const FamilyMeter& meter, const SurfaceErrors* own_errors,
                                 const std::vector<double>& everywhere)
    : meter_(meter),
      attributes_(RoundedAttributesOf(primitives, meter.attribute_targets(), meter.texels_per_unit(), TargetsByName(meter))),
      forecast_(primitives, attributes_, meter.status().ok() ? meter.skin() : nullptr),
      indices_(attributes_.size()),
      own_attributes_(attributes_.size(), 0.0),
      least_attributes_(attributes_.size(), 1),
      unforeseen_(attributes_.size()) {
  correction_.attributes.assign(attributes_.size(), 1.0);
  for (const RoundedAttribute& attribute : attributes_) num_numbers_.push_back(attribute.num_numbers);
  if (!meter.status().ok()) return;
  targets_ = meter.TargetsWith(everywhere);
  if (meter.skin() != nullptr) poses_ = meter.IndexOf(kPosesName);
  num_positions_ = static_cast<double>(meter.original().surface.positions.size());
  for (size_t a = 0; a < attributes_.size(); ++a) {
    indices_[a] = meter.IndexOf(attributes_[a].name);
    if (!indices_[a].has_value()) continue;
    const MeshAttribute& welded = meter.original().attributes[*indices_[a]];  // vertices share values
    num_numbers_[a] = static_cast<double>(welded.num_values()) * (attributes_[a].octahedral ? 2 : welded.components);
  }
  if (own_errors == nullptr) return;
  own_distance_ = own_errors->distance / targets_.distance;
  own_turned_ = std::min(own_errors->against_normals, meter.attribute_targets().turned / 2);
  if (poses_.has_value()) own_poses_ = Ratio(*own_errors, *poses_);
  for (size_t a = 0; a < attributes_.size(); ++a) {
    if (indices_[a].has_value()) own_attributes_[a] = Ratio(*own_errors, *indices_[a]);
  }
}

double RoundingOutlook::Ratio(const SurfaceErrors& errors, size_t index) const {
  const double ratio = errors.attributes[index].rms_99 / targets_.attributes[index];
  if (targets_.everywhere.empty()) return ratio;
  return std::max(ratio, errors.attributes[index].rms / targets_.everywhere[index]);
}

double RoundingOutlook::RoomFor(size_t a, const RoundedPositions& positions) const {
  if (IsPosed(a)) return PoseRoom() - Square(positions.distance / meter_.error());
  return (1.0 - Square(own_attributes_[a])) / correction_.attributes[a] - Square(positions.slides[a] / attributes_[a].target);
}

// What rounding at a level is expected to add, as RoomFor tells it.
double RoundingOutlook::Added(size_t a, int level) {
  return Square(IsPosed(a) ? forecast_.Posed(a, level) / meter_.error() : forecast_.Rounded(a, level) / attributes_[a].target);
}

// The coarsest level at which an attribute is expected to meet its target on these positions; beyond kMostLevel: exact.
std::optional<int> RoundingOutlook::LevelFor(size_t a, const RoundedPositions& positions) {
  const RoundedAttribute& attribute = attributes_[a];
  const double room = RoomFor(a, positions);
  if (!(room >= 0.0)) return std::nullopt;
  const auto meets = [&](int level) { return Added(a, level) <= room; };
  int low = std::max(attribute.FirstLevel(), least_attributes_[a]) - 1;  // too coarse
  int high = kMostLevel + 1;
  while (high - low > 1) {
    const int middle = (low + high) / 2;
    (meets(attribute.AtOrAbove(middle)) ? high : low) = middle;
  }
  return high > kMostLevel ? high : attribute.AtOrAbove(high);
}

// What rounding may add to the error of the poses, relative to the target and squared: positions and weights.
double RoundingOutlook::PoseRoom() const { return poses_.has_value() ? (1.0 - Square(own_poses_)) / correction_.poses : kInfinity; }

std::vector<RoundingLevels> RoundingOutlook::Candidates() {
  constexpr int kStride = 2;
  constexpr int kPatience = 4;  // positions that cost more than the best
  constexpr size_t kKept = 4;
  std::vector<std::pair<double, RoundingLevels>> all;
  double least = kInfinity;
  int worse = 0;
  for (int p = FirstPositions(); p <= kMostLevel && worse < kPatience; p += kStride) {
    const RoundedPositions& positions = forecast_.Positions(p);
    if (positions.flipped + own_turned_ > meter_.attribute_targets().turned && p + kStride <= kMostLevel) continue;
    RoundingLevels levels{p, {}};
    double bits = num_positions_ * 3.0 * p / kLevelsPerBit;
    for (size_t a = 0; a < attributes_.size() && std::isfinite(bits); ++a) {
      const std::optional<int> level = LevelFor(a, positions);
      bits += level.has_value() ? num_numbers_[a] * *level / kLevelsPerBit : kInfinity;
      levels.attributes.push_back(level.value_or(0));
    }
    if (!std::isfinite(bits)) continue;
    worse = bits < least ? 0 : worse + 1;
    least = std::min(least, bits);
    all.emplace_back(bits, std::move(levels));
  }
  // How many bits entropy coding leaves of these is not known, so the coarsest positions stay whatever they seem to cost.
  if (!all.empty()) std::sort(all.begin() + 1, all.end());
  std::vector<RoundingLevels> result;
  for (size_t i = 0; i < std::min(all.size(), kKept); ++i) result.push_back(std::move(all[i].second));
  return result;
}

// The coarsest positions that are expected to be near enough.
int RoundingOutlook::FirstPositions() {
  const double room = std::min((1.0 - Square(own_distance_)) / correction_.distance, PoseRoom());
  const auto meets = [&](int level) { return Square(forecast_.Positions(level).distance / meter_.error()) <= room; };
  if (!(meter_.error() > 0.0) || !(room > 0.0)) return kMostLevel;
  int level = std::max(forecast_.StartLevel(meter_.error() * std::sqrt(room)), least_positions_);
  while (level < kMostLevel && !meets(level)) ++level;
  while (level > least_positions_ && meets(level - 1)) --level;
  return level;
}

bool RoundingOutlook::MayMeet(const RoundingLevels& levels, const RoundingLevels& best, const SurfaceErrors& errors_of_best) {
  constexpr double kMost = 1.05;  // of a squared target: forecasts err
  const RoundedPositions &positions = forecast_.Positions(levels.positions), &before = forecast_.Positions(best.positions);
  const double farther = (Square(positions.distance) - Square(before.distance)) / Square(targets_.distance);
  if (Square(errors_of_best.distance / targets_.distance) + correction_.distance * farther > kMost) return false;
  for (size_t a = 0; a < attributes_.size(); ++a) {
    if (!indices_[a].has_value()) continue;
    const double more = (Square(forecast_.Rounded(a, levels.attributes[a])) - Square(forecast_.Rounded(a, best.attributes[a])) +
                         Square(positions.slides[a]) - Square(before.slides[a])) / Square(attributes_[a].target);
    if (Square(Ratio(errors_of_best, *indices_[a])) + correction_.attributes[a] * more > kMost) return false;
  }
  if (!poses_.has_value()) return true;
  double more = farther;
  for (size_t a = 0; a < attributes_.size(); ++a) {
    if (IsPosed(a)) more += Added(a, levels.attributes[a]) - Added(a, best.attributes[a]);
  }
  return Square(Ratio(errors_of_best, *poses_)) + correction_.poses * more <= kMost;
}

bool RoundingOutlook::Learn(const StatusOr<SurfaceErrors>& errors, const RoundingLevels& levels, const std::vector<double>& rounded) {
  // A group has lost its area, or too much has turned: no forecast tells how much finer that has to be.
  if (!errors.ok() || errors.value().MostTurned() > targets_.turned) least_positions_ = levels.positions + ++num_turned_;
  if (!errors.ok()) return false;
  Correct(errors.value(), levels, rounded);
  const double exact = WorstExactRatio(errors.value());
  if (exact > 1.0) least_positions_ = std::max(least_positions_, levels.positions + LevelsFiner(exact));
  return WorstRatio(errors.value(), targets_) <= 1.0;
}

// What stays exact, integers of colors for one, slides along with rounded positions all the same.
double RoundingOutlook::WorstExactRatio(const SurfaceErrors& errors) const {
  double worst = 0.0;
  for (size_t index = 0; index < errors.attributes.size(); ++index) {
    const bool is_rounded = std::find(indices_.begin(), indices_.end(), index) != indices_.end() || poses_ == index;
    if (!is_rounded) worst = std::max(worst, Ratio(errors, index));
  }
  return worst;
}

// What was measured takes the place of what was expected.
void RoundingOutlook::Correct(const SurfaceErrors& errors, const RoundingLevels& levels, const std::vector<double>& rounded) {
  const RoundedPositions& positions = forecast_.Positions(levels.positions);
  const auto corrected = [](double measured, double own, double expected) {
    constexpr double kLeast = 0.2, kTiny = 1e-6;
    // Never quite as small as measured: what seems to add nothing is below the precision of the measure.
    return std::max(Square(measured) - Square(own), kLeast * Square(expected)) / std::max(Square(expected), kTiny);
  };
  // Where the forecast is far off, a factor is of no use: it may be one of next to nothing. But errors are in proportion to the step.
  constexpr double kUnforeseen = 3;
  const double distance = errors.distance / targets_.distance, expected_distance = positions.distance / targets_.distance;
  if (distance > std::max(1.0, kUnforeseen * expected_distance)) {  // flat surfaces shrink within their plane
    least_positions_ = std::max(least_positions_, levels.positions + LevelsFiner(distance));
    return;
  }
  correction_.distance = corrected(distance, own_distance_, expected_distance);
  if (poses_.has_value()) {
    double expected = Square(positions.distance / targets_.distance);
    for (size_t a = 0; a < attributes_.size(); ++a) {
      if (IsPosed(a)) expected += Added(a, levels.attributes[a]);
    }
    correction_.poses = corrected(Ratio(errors, *poses_), own_poses_, std::sqrt(expected));
  }
  for (size_t a = 0; a < attributes_.size(); ++a) {
    if (!indices_[a].has_value()) continue;
    const double target = attributes_[a].target, measured = Ratio(errors, *indices_[a]);
    const double expected = std::hypot(rounded[a] / target, positions.slides[a] / target);
    if (measured > std::max(1.0, kUnforeseen * expected)) {
      Blame(a, measured, levels);
      continue;
    }
    correction_.attributes[a] = corrected(measured, own_attributes_[a], expected);
  }
}

// An attribute errs by far more than forecast, for one of two reasons. Its values are off by more where the forecast has left out what errs; or they
// lie on the other side of an edge, over an area that shrinks with the step of the positions. What was made finer for it and has not mended it was not the reason.
void RoundingOutlook::Blame(size_t a, double measured, const RoundingLevels& levels) {
  constexpr double kMended = 0.8;
  constexpr int kMostDoublings = 5;
  std::optional<Unforeseen>& last = unforeseen_[a];
  const double most = forecast_.MostRounded(a, levels.attributes[a]) / attributes_[a].target;
  const bool is_mended = last.has_value() && measured < kMended * last->measured;
  const bool is_position = measured > most || (last.has_value() && last->is_position == is_mended);
  if (is_position && last.has_value() && !last->is_position) least_attributes_[a] = last->least_attribute;
  const int times = last.has_value() ? last->times + 1 : 0;
  last = Unforeseen{measured, is_position, least_attributes_[a], times};
  const int finer = std::max(LevelsFiner(is_position ? std::sqrt(measured) : measured), 1 << std::min(times, kMostDoublings));
  if (is_position) {
    least_positions_ = std::max(least_positions_, levels.positions + finer);
  } else {
    least_attributes_[a] = levels.attributes[a] + finer;
  }
}

}  // namespace lacerta
