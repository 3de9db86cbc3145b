#include "pack/rounded.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

#include "geometry/for_each_branch.h"
#include "pack/descents_within.h"
#include "pack/rounded_attributes.h"
#include "pack/rounding_forecast.h"

namespace lacerta {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

// How finely positions and every attribute are rounded.
struct Levels {
  int positions = 0;
  std::vector<int> attributes;
  bool operator<(const Levels& other) const {
    return positions != other.positions ? positions < other.positions : attributes < other.attributes;
  }
  bool IsAsFineAs(const Levels& other) const {  // in everything
    return positions >= other.positions && std::equal(attributes.begin(), attributes.end(), other.attributes.begin(), std::greater_equal<>());
  }
};

struct Trial {
  Levels levels;
  std::vector<double> rounded;  // forecast of what rounding does to each attribute, in the unit of its target
  RoundedFamily family;
  uint64_t bytes = 0;
  bool is_measured = false;
  bool met = false;  // if measured
  SurfaceErrors errors;  // if measured and nothing else was against it
};

// Of an attribute that errs by far more than forecast.
struct Unforeseen {
  double measured = 0.0;     // over its target
  bool is_position = false;  // what was made finer for it: positions, or the attribute
  int least_attribute = 1;   // before that
  int times = 0;             // that it was so before
};

// Measured over forecast, squared; of what is not yet measured 1.
struct Correction {
  double distance = 1.0;
  double poses = 1.0;
  std::vector<double> attributes;
};

double Square(double x) { return x * x; }

// How many levels finer a step is that is this many times smaller.
int LevelsFiner(double factor) { return static_cast<int>(std::ceil(kLevelsPerBit * std::log2(factor))); }

Status TooLarge(uint64_t bytes) { return Unsupported("compressed it would be larger (about " + std::to_string(bytes) + " bytes)"); }

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

// Has a part of an attribute, which a primitive calls `name`, coded at a level. Gives its bits.
int SetPrecision(const RoundedAttribute& attribute, const RoundedAttribute::Part& part, const std::string& name, int level, DracoPrecision* precision) {
  if (attribute.octahedral) return precision->normal_bits = level / kLevelsPerBit;
  const Lattice lattice = attribute.LatticeAt(part, level);
  precision->lattices[name] = lattice;
  return lattice.bits;
}

class FamilyRounder {
 public:
  FamilyRounder(const std::vector<const Primitive*>& primitives, const FamilyMeter& meter, const SurfaceErrors* own,
                const std::vector<double>& everywhere, const std::function<bool(const RoundedFamily&)>& is_usable)
      : primitives_(primitives), meter_(meter), is_usable_(is_usable),
        attributes_(RoundedAttributesOf(primitives, meter.attribute_targets(), meter.texels_per_unit(), TargetsByName(meter))),
        forecast_(primitives_, attributes_, meter.status().ok() ? meter.skin() : nullptr), own_attributes_(attributes_.size(), 0.0),
        indices_(attributes_.size()) {
    correction_.attributes.assign(attributes_.size(), 1.0);
    least_attributes_.assign(attributes_.size(), 1);
    unforeseen_.assign(attributes_.size(), std::nullopt);
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
    if (own == nullptr) return;
    own_distance_ = own->distance / targets_.distance;
    own_turned_ = std::min(own->against_normals, meter.attribute_targets().turned / 2);
    if (poses_.has_value()) own_poses_ = Ratio(*own, *poses_);
    for (size_t a = 0; a < attributes_.size(); ++a) {
      if (indices_[a].has_value()) own_attributes_[a] = Ratio(*own, *indices_[a]);
    }
  }

  StatusOr<RoundedFamily> Run(uint64_t most_bytes) {
    constexpr int kMostRounds = 10;
    constexpr double kHopeless = 1.5;  // of the bytes, whatever a measure would correct
    constexpr double kUnlikely = 1.1;  // of the bytes, for what follows takes a tenth off, or little more
    constexpr double kWorthwhile = 0.01;  // of the bytes, for another measure
    if (const uint64_t fewest = FewestBytes(most_bytes); fewest > most_bytes) return TooLarge(fewest);
    Trial* best = nullptr;
    for (int round = 0; round < kMostRounds; ++round) {
      LACERTA_ASSIGN_OR_RETURN(Trial* trial, Smallest(most_bytes));
      // What is decoded has all that was asked for and nothing smaller is expected: done.
      if (trial == nullptr || trial->is_measured) break;
      if (static_cast<double>(trial->bytes) > kHopeless * static_cast<double>(most_bytes)) return TooLarge(trial->bytes);
      if (best != nullptr && static_cast<double>(trial->bytes) > (1.0 - kWorthwhile) * static_cast<double>(best->bytes)) break;
      Measure(trial);
      if (trial->met) best = trial;
    }
    if (best == nullptr) return Unsupported("rounding misses the errors at every precision");
    if (static_cast<double>(best->bytes) > kUnlikely * static_cast<double>(most_bytes)) return TooLarge(best->bytes);
    if (!meter_.status().ok()) return Shrunk(std::move(*best));
    LACERTA_ASSIGN_OR_RETURN(best, Coarsened(best));
    LACERTA_ASSIGN_OR_RETURN(Trial descended, Descended(*best));
    return Shrunk(std::move(descended));
  }

 private:
  double Ratio(const SurfaceErrors& errors, size_t index) const {
    const double ratio = errors.attributes[index].rms_99 / targets_.attributes[index];
    if (targets_.everywhere.empty()) return ratio;
    return std::max(ratio, errors.attributes[index].rms / targets_.everywhere[index]);
  }

  // Whether an attribute is held to what poses show of it.
  bool IsPosed(size_t a) const { return poses_.has_value() && !attributes_[a].is_shown; }

  // What rounding may add to the error of an attribute on these positions, relative to its target and squared.
  double RoomFor(size_t a, const RoundedPositions& positions) const {
    if (IsPosed(a)) return PoseRoom() - Square(positions.distance / meter_.error());
    return (1.0 - Square(own_attributes_[a])) / correction_.attributes[a] - Square(positions.slides[a] / attributes_[a].target);
  }

  // What rounding at a level is expected to add, likewise.
  double Added(size_t a, int level) {
    return Square(IsPosed(a) ? forecast_.Posed(a, level) / meter_.error() : forecast_.Rounded(a, level) / attributes_[a].target);
  }

  // The coarsest level at which an attribute is expected to meet its target on these positions; beyond kMostLevel: exact.
  std::optional<int> LevelFor(size_t a, const RoundedPositions& positions) {
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
  double PoseRoom() const { return poses_.has_value() ? (1.0 - Square(own_poses_)) / correction_.poses : kInfinity; }

  // No more than any precision that meets the targets takes: the bytes of what has a target, far too coarse. 0 where that is not known, or any number will do.
  uint64_t FewestBytes(uint64_t most_bytes) const {
    constexpr int kTooCoarse = 2 * kLevelsPerBit;
    if (most_bytes == std::numeric_limits<uint64_t>::max()) return 0;
    const Lattice positions = forecast_.LatticeAt(std::max(1, forecast_.StartLevel(meter_.error()) - kTooCoarse));
    const auto bytes_of = [&](size_t m) {
      const TriangleMesh surface = Surface(*primitives_[m]);
      Primitive coarse{surface.positions.size(), surface.triangles, {{"POSITION", MakeFloatAccessor(surface.positions)}}};
      DracoPrecision precision{positions, {}, 0};
      for (const RoundedAttribute& attribute : attributes_) {
        const int level = attribute.is_shown ? attribute.AtOrAbove(attribute.StartLevel() - kTooCoarse) : attribute.FirstLevel();
        for (const RoundedAttribute::Part& part : attribute.parts) {
          if (part.member != m) continue;
          coarse.attributes.push_back(primitives_[m]->attributes[part.index]);
          SetPrecision(attribute, part, coarse.attributes.back().name, level, &precision);
        }
      }
      return DracoPrimitiveBytes(coarse, precision, {});
    };
    const StatusOr<std::vector<uint64_t>> sizes = OfEachMember<uint64_t>(bytes_of);
    return sizes.ok() ? std::accumulate(sizes.value().begin(), sizes.value().end(), uint64_t{0}) : 0;
  }

  // The smallest of what is expected to meet the targets; null where nothing is. One that takes far more than most_bytes ends the search.
  StatusOr<Trial*> Smallest(uint64_t most_bytes) {
    constexpr double kFar = 3;  // times as many: other precisions do not save so much
    Trial* smallest = nullptr;
    for (const Levels& levels : Candidates()) {
      LACERTA_ASSIGN_OR_RETURN(Trial* trial, TrialAt(levels));
      if (smallest == nullptr || trial->bytes < smallest->bytes) smallest = trial;
      if (static_cast<double>(smallest->bytes) > kFar * static_cast<double>(most_bytes)) break;
    }
    return smallest;
  }

  StatusOr<Trial*> TrialAt(const Levels& levels) {
    auto known = trials_.find(levels);
    if (known == trials_.end()) {
      LACERTA_ASSIGN_OR_RETURN(Trial trial, Encode(levels));
      known = trials_.emplace(levels, std::move(trial)).first;
    }
    return &known->second;
  }

  // Takes away what forecasts had to spare: one thing after the other is rounded more coarsely, first where that saves most, as long as what is
  // measured meets the targets.
  StatusOr<Trial*> Coarsened(Trial* best) {
    constexpr int kMostMeasures = 6;
    constexpr double kWorthwhile = 0.003;  // of the bytes, for a measure
    std::vector<int> strides(1 + attributes_.size(), kLevelsPerBit / 2);  // of positions and every attribute; 0: as coarse as they can be
    strides[0] = kLevelsPerBit;  // forecasts allow that where it is not the distance that limits them, and then half a bit says little of a whole one
    for (int i = 0; i < kMostMeasures; ++i) {
      Trial* smallest = nullptr;
      size_t changed = 0;
      for (size_t k = 0; k < strides.size(); ++k) {
        std::optional<Levels> levels = Coarser(best->levels, k, strides[k]);
        while (levels.has_value() && HasMissed(*levels)) levels = Coarser(best->levels, k, strides[k] = SmallerStride(k, strides[k]));
        if (!levels.has_value() || !MayMeet(*levels, *best)) continue;
        LACERTA_ASSIGN_OR_RETURN(Trial* trial, TrialAt(*levels));
        if (smallest != nullptr && trial->bytes >= smallest->bytes) continue;
        smallest = trial;
        changed = k;
      }
      if (smallest == nullptr || static_cast<double>(smallest->bytes) > (1.0 - kWorthwhile) * static_cast<double>(best->bytes)) break;
      Measure(smallest);
      if (smallest->met) {
        best = smallest;
        strides[changed] *= 2;
      } else {
        strides[changed] = SmallerStride(changed, strides[changed]);
      }
    }
    return best;
  }

  // Moves values to points that take fewer bits, as far as their errors allow: attributes that meet their targets with room to spare do so until there is
  // none.
  StatusOr<Trial> Descended(const Trial& best) {
    constexpr int kMostMeasures = 3;
    constexpr double kWorthwhile = 0.003;  // of the bytes, for a measure
    constexpr double kNearer = 0.98;       // than what missed
    const RoundedPositions& positions = forecast_.Positions(best.levels.positions);
    std::vector<double> most_errors(attributes_.size(), kInfinity);
    std::vector<std::optional<DescendedValues>> descents(attributes_.size());
    std::vector<size_t> due;
    for (size_t a = 0; a < attributes_.size(); ++a) {
      if (indices_[a].has_value() && attributes_[a].is_shown && best.levels.attributes[a] <= kMostLevel) due.push_back(a);
    }
    for (int i = 0; i < kMostMeasures && !due.empty(); ++i) {
      for (const size_t a : due) {
        const double room = attributes_[a].target * std::sqrt(std::max(RoomFor(a, positions), 0.0));
        LACERTA_ASSIGN_OR_RETURN(descents[a], SmallestDescent(a, best, positions, std::min(room, most_errors[a])));
      }
      Trial trial = best;
      trial.errors = {};
      for (size_t a = 0; a < attributes_.size(); ++a) {
        if (descents[a].has_value()) SetValues(a, *descents[a], positions, &trial);
      }
      LACERTA_RETURN_IF_ERROR(EncodeRounded(&trial));
      if (static_cast<double>(trial.bytes) > (1.0 - kWorthwhile) * static_cast<double>(best.bytes)) break;
      Measure(&trial);
      if (trial.met) return trial;
      if (trial.errors.attributes.empty()) break;  // not measured: something else is against it
      due.clear();
      for (size_t a = 0; a < attributes_.size(); ++a) {
        if (!indices_[a].has_value() || Ratio(trial.errors, *indices_[a]) <= 1.0) continue;
        most_errors[a] = kNearer * trial.rounded[a];
        if (descents[a].has_value()) due.push_back(a);
      }
    }
    return best;
  }

  // With what saves most; nothing where nothing does.
  StatusOr<std::optional<DescendedValues>> SmallestDescent(size_t a, const Trial& best, const RoundedPositions& positions, double most_error) {
    const std::vector<AccessorData>& wanted = forecast_.Fitted(a, best.levels.positions);
    std::vector<DescendedValues> descents =
        DescentsWithin(primitives_, positions.moved, attributes_[a], wanted, best.levels.attributes[a], most_error,
                       [&](const std::vector<AccessorData>& values) { return forecast_.Rounded(a, wanted, values); });
    uint64_t least = best.bytes;
    std::optional<DescendedValues> smallest;
    for (DescendedValues& descent : descents) {
      Trial trial = best;
      SetValues(a, descent, positions, &trial);
      LACERTA_ASSIGN_OR_RETURN(const uint64_t bytes, BytesAsCoded(trial));
      if (bytes >= least) continue;
      least = bytes;
      smallest = std::move(descent);
    }
    return smallest;
  }

  // What a trial takes in the codings that its members have.
  StatusOr<uint64_t> BytesAsCoded(const Trial& trial) const {
    const auto bytes_of = [&](size_t m) { return DracoPrimitiveBytes(*primitives_[m], trial.family.precisions[m], trial.family.members[m].coding); };
    LACERTA_ASSIGN_OR_RETURN(const std::vector<uint64_t> sizes, OfEachMember<uint64_t>(bytes_of));
    return std::accumulate(sizes.begin(), sizes.end(), uint64_t{0});
  }

  void SetValues(size_t a, const DescendedValues& descent, const RoundedPositions& positions, Trial* trial) {
    trial->levels.attributes[a] = descent.level;
    trial->rounded[a] = descent.error;
    SetAttribute(a, descent.level, positions, &trial->family);
    for (size_t p = 0; p < descent.values.size(); ++p) SetValues(attributes_[a].parts[p], descent.values[p], &trial->family);
  }

  int SmallerStride(size_t k, int stride) const { return k > 0 && attributes_[k - 1].octahedral ? 0 : stride / 2; }

  // Whether something that is nowhere coarser was measured to miss the targets.
  bool HasMissed(const Levels& levels) const {
    return std::any_of(trials_.begin(), trials_.end(), [&](const auto& entry) {
      const Trial& trial = entry.second;
      return trial.is_measured && !trial.met && trial.levels.IsAsFineAs(levels);
    });
  }

  // Whether what is rounded more coarsely than `best` is expected to meet the targets, from what was measured of that.
  bool MayMeet(const Levels& levels, const Trial& best) {
    constexpr double kMost = 1.05;  // of a squared target: forecasts err
    const RoundedPositions &positions = forecast_.Positions(levels.positions), &before = forecast_.Positions(best.levels.positions);
    const double farther = (Square(positions.distance) - Square(before.distance)) / Square(targets_.distance);
    if (Square(best.errors.distance / targets_.distance) + correction_.distance * farther > kMost) return false;
    for (size_t a = 0; a < attributes_.size(); ++a) {
      if (!indices_[a].has_value()) continue;
      const double more = (Square(forecast_.Rounded(a, levels.attributes[a])) - Square(forecast_.Rounded(a, best.levels.attributes[a])) +
                           Square(positions.slides[a]) - Square(before.slides[a])) / Square(attributes_[a].target);
      if (Square(Ratio(best.errors, *indices_[a])) + correction_.attributes[a] * more > kMost) return false;
    }
    if (!poses_.has_value()) return true;
    double more = farther;
    for (size_t a = 0; a < attributes_.size(); ++a) {
      if (IsPosed(a)) more += Added(a, levels.attributes[a]) - Added(a, best.levels.attributes[a]);
    }
    return Square(Ratio(best.errors, *poses_)) + correction_.poses * more <= kMost;
  }

  // With positions (k = 0) or the attribute k - 1 so many levels coarser, or a bit where it comes in whole ones; nothing where there is no such level or no
  // stride.
  std::optional<Levels> Coarser(Levels levels, size_t k, int stride) const {
    if (stride == 0) return std::nullopt;
    if (k == 0) {
      levels.positions -= stride;
      return levels.positions >= 1 ? std::optional<Levels>(std::move(levels)) : std::nullopt;
    }
    const RoundedAttribute& attribute = attributes_[k - 1];
    int& level = levels.attributes[k - 1];
    if (level > kMostLevel) return std::nullopt;
    level -= attribute.octahedral ? kLevelsPerBit : stride;
    return level >= attribute.FirstLevel() ? std::optional<Levels>(std::move(levels)) : std::nullopt;
  }

  // Levels that are expected to meet the targets: from the coarsest positions on, with attributes as coarse as these allow,
  // the few for which the fewest bits are expected.
  std::vector<Levels> Candidates() {
    constexpr int kStride = 2;
    constexpr int kPatience = 4;  // positions that cost more than the best
    constexpr size_t kKept = 4;
    std::vector<std::pair<double, Levels>> all;
    double least = kInfinity;
    int worse = 0;
    for (int p = FirstPositions(); p <= kMostLevel && worse < kPatience; p += kStride) {
      const RoundedPositions& positions = forecast_.Positions(p);
      if (positions.flipped + own_turned_ > meter_.attribute_targets().turned && p + kStride <= kMostLevel) continue;
      Levels levels{p, {}};
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
    std::vector<Levels> result;
    for (size_t i = 0; i < std::min(all.size(), kKept); ++i) result.push_back(std::move(all[i].second));
    return result;
  }

  // The coarsest positions that are expected to be near enough.
  int FirstPositions() {
    const double room = std::min((1.0 - Square(own_distance_)) / correction_.distance, PoseRoom());
    const auto meets = [&](int level) { return Square(forecast_.Positions(level).distance / meter_.error()) <= room; };
    if (!(meter_.error() > 0.0) || !(room > 0.0)) return kMostLevel;
    int level = std::max(forecast_.StartLevel(meter_.error() * std::sqrt(room)), least_positions_);
    while (level < kMostLevel && !meets(level)) ++level;
    while (level > least_positions_ && meets(level - 1)) --level;
    return level;
  }

  StatusOr<Trial> Encode(const Levels& levels) {
    Trial trial;
    trial.levels = levels;
    const RoundedPositions& positions = forecast_.Positions(levels.positions);
    RoundedFamily& family = trial.family;
    family.precisions.assign(primitives_.size(), DracoPrecision{positions.lattice, {}, 0});
    for (const Primitive* primitive : primitives_) {
      family.reports.emplace_back();
      for (const Attribute& attribute : primitive->attributes) {
        if (attribute.name != "POSITION") family.reports.back().push_back({attribute.name, 0, 0.0, ""});
      }
    }
    for (size_t m = 0; m < primitives_.size(); ++m) {
      if (primitives_[m]->Find("POSITION")->data.type == ComponentType::kFloat) family.precisions[m].values["POSITION"] = MakeFloatAccessor(positions.moved[m]);
    }
    for (size_t a = 0; a < attributes_.size(); ++a) {
      SetAttribute(a, levels.attributes[a], positions, &family);
      SetFitted(a, levels, &family);
      trial.rounded.push_back(forecast_.Rounded(a, levels.attributes[a]));
    }
    LACERTA_RETURN_IF_ERROR(EncodeRounded(&trial));
    family.error = positions.distance;
    return trial;
  }

  // The same values in fewer bytes. Those in another order are measured at other samples, and have to meet the targets there as well.
  StatusOr<RoundedFamily> Shrunk(Trial trial) {
    constexpr double kWorthwhile = 0.003;  // of the bytes, for a measure
    LACERTA_RETURN_IF_ERROR(EncodeMembers(&trial, [&](size_t m) {
      return EncodeDracoPrimitive(*primitives_[m], trial.family.precisions[m], DracoSearch::kPredictions);
    }));
    Trial other = trial;
    LACERTA_RETURN_IF_ERROR(EncodeMembers(&other, [&](size_t m) {
      return EncodeInOtherOrder(*primitives_[m], trial.family.precisions[m], trial.family.members[m]);
    }));
    if (static_cast<double>(other.bytes) > (1.0 - kWorthwhile) * static_cast<double>(trial.bytes)) return std::move(trial.family);
    Measure(&other);
    return std::move(other.met ? other.family : trial.family);
  }

  Status EncodeRounded(Trial* trial) const {
    return EncodeMembers(trial, [&](size_t m) { return EncodeDracoPrimitive(*primitives_[m], trial->family.precisions[m]); });
  }

  template <typename EncodeMember>
  Status EncodeMembers(Trial* trial, const EncodeMember& encode) const {
    LACERTA_ASSIGN_OR_RETURN(trial->family.members, OfEachMember<DracoEncoded>(encode));
    trial->bytes = 0;
    for (const DracoEncoded& member : trial->family.members) trial->bytes += member.bytes.size();
    return Status();
  }

  // What `make` gives for each primitive, several at a time; fails where one fails.
  template <typename T, typename Make>
  StatusOr<std::vector<T>> OfEachMember(const Make& make) const {
    std::vector<StatusOr<T>> made(primitives_.size(), InternalError("not made"));
    ForEachBranch(primitives_.size(), [&](size_t m) { made[m] = make(m); });
    std::vector<T> result;
    for (StatusOr<T>& one : made) {
      LACERTA_RETURN_IF_ERROR(one.status());
      result.push_back(std::move(one).value());
    }
    return result;
  }

  // Says whether what is decoded meets the targets, and corrects the forecast.
  void Measure(Trial* trial) {
    trial->is_measured = true;
    trial->met = is_usable_ == nullptr || is_usable_(trial->family);
    if (!trial->met) least_positions_ = trial->levels.positions + kLevelsPerBit / 2;
    if (!trial->met || !meter_.status().ok()) return;
    std::vector<const Primitive*> decoded;
    for (const DracoEncoded& member : trial->family.members) decoded.push_back(&member.decoded);
    const StatusOr<SurfaceErrors> errors = meter_.Measure(decoded);
    const Levels& levels = trial->levels;
    trial->met = errors.ok() && WorstRatio(errors.value(), targets_) <= 1.0;
    // A group has lost its area, or too much has turned: no forecast tells how much finer that has to be.
    if (!errors.ok() || errors.value().MostTurned() > targets_.turned) least_positions_ = levels.positions + ++num_turned_;
    if (!errors.ok()) return;
    trial->errors = errors.value();
    Report(errors.value(), &trial->family);
    Correct(errors.value(), *trial, forecast_.Positions(levels.positions));
    const double exact = WorstExactRatio(errors.value());
    if (exact > 1.0) least_positions_ = std::max(least_positions_, levels.positions + LevelsFiner(exact));
  }

  // What stays exact, integers of colors for one, slides along with rounded positions all the same.
  double WorstExactRatio(const SurfaceErrors& errors) const {
    double worst = 0.0;
    for (size_t index = 0; index < errors.attributes.size(); ++index) {
      const bool is_rounded = std::find(indices_.begin(), indices_.end(), index) != indices_.end() || poses_ == index;
      if (!is_rounded) worst = std::max(worst, Ratio(errors, index));
    }
    return worst;
  }

  // Values go to where positions have slid to.
  void SetFitted(size_t a, const Levels& levels, RoundedFamily* family) {
    const RoundedAttribute& attribute = attributes_[a];
    if (levels.attributes[a] > kMostLevel || !attribute.is_shown) return;
    const std::vector<AccessorData>& fitted = forecast_.Fitted(a, levels.positions);
    for (size_t p = 0; p < fitted.size(); ++p) SetValues(attribute.parts[p], attribute.RoundedAt(fitted[p], attribute.parts[p], levels.attributes[a]), family);
  }

  void SetValues(const RoundedAttribute::Part& part, AccessorData values, RoundedFamily* family) const {
    family->precisions[part.member].values[primitives_[part.member]->attributes[part.index].name] = std::move(values);
  }

  void SetAttribute(size_t a, int level, const RoundedPositions& positions, RoundedFamily* family) {
    if (level > kMostLevel) return;
    const RoundedAttribute& attribute = attributes_[a];
    for (const RoundedAttribute::Part& part : attribute.parts) {
      const std::string& name = primitives_[part.member]->attributes[part.index].name;
      const int bits = SetPrecision(attribute, part, name, level, &family->precisions[part.member]);
      for (AttributeReport& report : family->reports[part.member]) {
        if (report.name != name) continue;
        report.bits = bits;
        report.error = std::hypot(forecast_.Rounded(a, level), positions.slides[a]);
        report.unit = attribute.unit;
      }
    }
  }

  void Report(const SurfaceErrors& errors, RoundedFamily* family) const {
    family->error = errors.distance;
    family->everywhere.clear();  // of a measure before this one
    for (const MeshAttribute& attribute : meter_.original().attributes) {
      const size_t a = family->everywhere.size();
      const bool direction = IsDirection(attribute.kind);
      family->everywhere.push_back(direction ? std::max(errors.attributes[a].rms, targets_.attributes[a]) : kInfinity);
    }
    for (size_t a = 0; a < attributes_.size(); ++a) {
      if (!indices_[a].has_value()) continue;
      for (const RoundedAttribute::Part& part : attributes_[a].parts) {
        const std::string& name = primitives_[part.member]->attributes[part.index].name;
        for (AttributeReport& report : family->reports[part.member]) {
          if (report.name == name) report.error = meter_.Reported(errors, *indices_[a]);
        }
      }
    }
  }

  // What was measured takes the place of what was expected.
  void Correct(const SurfaceErrors& errors, const Trial& trial, const RoundedPositions& positions) {
    const Levels& levels = trial.levels;
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
      const double rounded = trial.rounded[a] / attributes_[a].target;
      const double expected = std::hypot(rounded, positions.slides[a] / attributes_[a].target);
      const double measured = Ratio(errors, *indices_[a]);
      if (measured > std::max(1.0, kUnforeseen * expected)) {
        Blame(a, measured, levels);
        continue;
      }
      correction_.attributes[a] = corrected(measured, own_attributes_[a], expected);
    }
  }

  // An attribute errs by far more than forecast, for one of two reasons. Its values are off by more where the forecast has left out what errs; or they
  // lie on the other side of an edge, over an area that shrinks with the step of the positions. What was made finer for it and has not mended it was not the reason.
  void Blame(size_t a, double measured, const Levels& levels) {
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

  const std::vector<const Primitive*>& primitives_;
  const FamilyMeter& meter_;
  const std::function<bool(const RoundedFamily&)>& is_usable_;
  const std::vector<RoundedAttribute> attributes_;
  RoundingForecast forecast_;
  // Errors that the primitives have before they are rounded, relative to the targets.
  double own_distance_ = 0.0;
  double own_turned_ = 0.0;  // share of the area, away from its normals
  double own_poses_ = 0.0;
  std::vector<double> own_attributes_;
  std::vector<std::optional<size_t>> indices_;  // of attributes_ in the meter's original
  std::optional<size_t> poses_;  // in the meter's original; with a skin
  ErrorTargets targets_;
  double num_positions_ = 1.0;
  std::vector<double> num_numbers_;  // of each attribute
  std::vector<std::optional<Unforeseen>> unforeseen_;  // of each attribute, the last
  int least_positions_ = 1;
  int num_turned_ = 0;  // how often positions were too coarse for that
  std::vector<int> least_attributes_;  // levels
  Correction correction_;
  std::map<Levels, Trial> trials_;
};

}  // namespace

StatusOr<RoundedFamily> RoundFamily(const std::vector<const Primitive*>& primitives, const FamilyMeter& meter,
                                    const SurfaceErrors* own_errors, const std::vector<double>& everywhere,
                                    const std::function<bool(const RoundedFamily&)>& is_usable, uint64_t most_bytes) {
  return FamilyRounder(primitives, meter, own_errors, everywhere, is_usable).Run(most_bytes);
}

}  // namespace lacerta
