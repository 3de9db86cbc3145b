#include "pack/rounded.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "pack/descents_within.h"
#include "pack/rounded_attributes.h"
#include "pack/rounding_forecast.h"
#include "pack/rounding_levels.h"
#include "pack/rounding_outlook.h"

namespace lacerta {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

struct Trial {
  RoundingLevels levels;
  std::vector<double> rounded;  // forecast of what rounding does to each attribute, in the unit of its target
  RoundedFamily family;
  bool is_measured = false;
  bool met = false;  // if measured
  SurfaceErrors errors;  // if measured and nothing else was against it
};

Status TooLarge(uint64_t bytes) { return Unsupported("compressed it would be larger (about " + std::to_string(bytes) + " bytes)"); }

class FamilyRounder {
 public:
  FamilyRounder(const std::vector<const Primitive*>& primitives, const FamilyMeter& meter, const SurfaceErrors* own_errors,
                const std::vector<double>& everywhere, const std::function<bool(const RoundedFamily&)>& is_usable)
      : primitives_(primitives), meter_(meter), is_usable_(is_usable), outlook_(primitives, meter, own_errors, everywhere),
        attributes_(outlook_.attributes()), forecast_(outlook_.forecast()), coder_(primitives, attributes_, &forecast_) {}

  StatusOr<RoundedFamily> Run(uint64_t most_bytes) {
    constexpr int kMostRounds = 10;
    constexpr double kHopeless = 1.5;  // of the bytes, whatever a measure would correct
    constexpr double kUnlikely = 1.1;  // of the bytes, for what follows takes a tenth off, or little more
    constexpr double kWorthwhile = 0.01;  // of the bytes, for another measure
    if (most_bytes < std::numeric_limits<uint64_t>::max()) {
      if (const uint64_t fewest = coder_.FewestBytes(meter_.error()); fewest > most_bytes) return TooLarge(fewest);
    }
    Trial* best = nullptr;
    for (int round = 0; round < kMostRounds; ++round) {
      LACERTA_ASSIGN_OR_RETURN(Trial* trial, Smallest(most_bytes));
      // What is decoded has all that was asked for and nothing smaller is expected: done.
      if (trial == nullptr || trial->is_measured) break;
      if (static_cast<double>(trial->family.size()) > kHopeless * static_cast<double>(most_bytes)) return TooLarge(trial->family.size());
      if (best != nullptr && static_cast<double>(trial->family.size()) > (1.0 - kWorthwhile) * static_cast<double>(best->family.size())) break;
      Measure(trial);
      if (trial->met) best = trial;
    }
    if (best == nullptr) return Unsupported("rounding misses the errors at every precision");
    if (static_cast<double>(best->family.size()) > kUnlikely * static_cast<double>(most_bytes)) return TooLarge(best->family.size());
    if (!meter_.status().ok()) return Shrunk(std::move(*best));
    LACERTA_ASSIGN_OR_RETURN(best, Coarsened(best));
    LACERTA_ASSIGN_OR_RETURN(Trial descended, Descended(*best));
    return Shrunk(std::move(descended));
  }

 private:
  // The smallest of what is expected to meet the targets; null where nothing is. One that takes far more than most_bytes ends the search.
  StatusOr<Trial*> Smallest(uint64_t most_bytes) {
    constexpr double kFar = 3;  // times as many: other precisions do not save so much
    Trial* smallest = nullptr;
    for (const RoundingLevels& levels : outlook_.Candidates()) {
      LACERTA_ASSIGN_OR_RETURN(Trial* trial, TrialAt(levels));
      if (smallest == nullptr || trial->family.size() < smallest->family.size()) smallest = trial;
      if (static_cast<double>(smallest->family.size()) > kFar * static_cast<double>(most_bytes)) break;
    }
    return smallest;
  }

  StatusOr<Trial*> TrialAt(const RoundingLevels& levels) {
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
        std::optional<RoundingLevels> levels = Coarser(best->levels, k, strides[k]);
        while (levels.has_value() && HasMissed(*levels)) levels = Coarser(best->levels, k, strides[k] = SmallerStride(k, strides[k]));
        if (!levels.has_value() || !outlook_.MayMeet(*levels, best->levels, best->errors)) continue;
        LACERTA_ASSIGN_OR_RETURN(Trial* trial, TrialAt(*levels));
        if (smallest != nullptr && trial->family.size() >= smallest->family.size()) continue;
        smallest = trial;
        changed = k;
      }
      if (smallest == nullptr || static_cast<double>(smallest->family.size()) > (1.0 - kWorthwhile) * static_cast<double>(best->family.size())) break;
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
      if (outlook_.IndexOf(a).has_value() && attributes_[a].is_shown && best.levels.attributes[a] <= kMostLevel) due.push_back(a);
    }
    for (int i = 0; i < kMostMeasures && !due.empty(); ++i) {
      for (const size_t a : due) {
        const double room = attributes_[a].target * std::sqrt(std::max(outlook_.RoomFor(a, positions), 0.0));
        LACERTA_ASSIGN_OR_RETURN(descents[a], SmallestDescent(a, best, positions, std::min(room, most_errors[a])));
      }
      Trial trial = best;
      trial.errors = {};
      for (size_t a = 0; a < attributes_.size(); ++a) {
        if (descents[a].has_value()) SetValues(a, *descents[a], positions, &trial);
      }
      LACERTA_RETURN_IF_ERROR(coder_.Code(&trial.family));
      if (static_cast<double>(trial.family.size()) > (1.0 - kWorthwhile) * static_cast<double>(best.family.size())) break;
      Measure(&trial);
      if (trial.met) return trial;
      if (trial.errors.attributes.empty()) break;  // not measured: something else is against it
      due.clear();
      for (size_t a = 0; a < attributes_.size(); ++a) {
        if (!outlook_.IndexOf(a).has_value() || outlook_.Ratio(trial.errors, *outlook_.IndexOf(a)) <= 1.0) continue;
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
    uint64_t least = best.family.size();
    std::optional<DescendedValues> smallest;
    for (DescendedValues& descent : descents) {
      Trial trial = best;
      SetValues(a, descent, positions, &trial);
      LACERTA_ASSIGN_OR_RETURN(const uint64_t bytes, coder_.BytesAsCoded(trial.family));
      if (bytes >= least) continue;
      least = bytes;
      smallest = std::move(descent);
    }
    return smallest;
  }

  void SetValues(size_t a, const DescendedValues& descent, const RoundedPositions& positions, Trial* trial) {
    trial->levels.attributes[a] = descent.level;
    trial->rounded[a] = descent.error;
    coder_.SetValues(a, descent, positions, &trial->family);
  }

  int SmallerStride(size_t k, int stride) const { return k > 0 && attributes_[k - 1].octahedral ? 0 : stride / 2; }

  // Whether something that is nowhere coarser was measured to miss the targets.
  bool HasMissed(const RoundingLevels& levels) const {
    return std::any_of(trials_.begin(), trials_.end(), [&](const auto& entry) {
      const Trial& trial = entry.second;
      return trial.is_measured && !trial.met && trial.levels.IsAsFineAs(levels);
    });
  }

  // With positions (k = 0) or the attribute k - 1 so many levels coarser, or a bit where it comes in whole ones; nothing where there is no such level or no
  // stride.
  std::optional<RoundingLevels> Coarser(RoundingLevels levels, size_t k, int stride) const {
    if (stride == 0) return std::nullopt;
    if (k == 0) {
      levels.positions -= stride;
      return levels.positions >= 1 ? std::optional<RoundingLevels>(std::move(levels)) : std::nullopt;
    }
    const RoundedAttribute& attribute = attributes_[k - 1];
    int& level = levels.attributes[k - 1];
    if (level > kMostLevel) return std::nullopt;
    level -= attribute.octahedral ? kLevelsPerBit : stride;
    return level >= attribute.FirstLevel() ? std::optional<RoundingLevels>(std::move(levels)) : std::nullopt;
  }

  StatusOr<Trial> Encode(const RoundingLevels& levels) {
    Trial trial;
    trial.levels = levels;
    trial.family = coder_.RoundedAt(levels);
    for (size_t a = 0; a < attributes_.size(); ++a) trial.rounded.push_back(forecast_.Rounded(a, levels.attributes[a]));
    LACERTA_RETURN_IF_ERROR(coder_.Code(&trial.family));
    return trial;
  }

  // The same values in fewer bytes. Those in another order are measured at other samples, and have to meet the targets there as well.
  StatusOr<RoundedFamily> Shrunk(Trial trial) {
    constexpr double kWorthwhile = 0.003;  // of the bytes, for a measure
    LACERTA_RETURN_IF_ERROR(coder_.Code(&trial.family, DracoSearch::kPredictions));
    Trial other = trial;
    LACERTA_RETURN_IF_ERROR(coder_.CodeInOtherOrder(&other.family));
    if (static_cast<double>(other.family.size()) > (1.0 - kWorthwhile) * static_cast<double>(trial.family.size())) return std::move(trial.family);
    Measure(&other);
    return std::move(other.met ? other.family : trial.family);
  }

  // Says whether what is decoded meets the targets, and corrects the forecast.
  void Measure(Trial* trial) {
    trial->is_measured = true;
    trial->met = is_usable_ == nullptr || is_usable_(trial->family);
    if (!trial->met) outlook_.RefusePositions(trial->levels.positions);
    if (!trial->met || !meter_.status().ok()) return;
    std::vector<const Primitive*> decoded;
    for (const DracoEncoded& member : trial->family.members) decoded.push_back(&member.decoded);
    const StatusOr<SurfaceErrors> errors = meter_.Measure(decoded);
    trial->met = outlook_.Learn(errors, trial->levels, trial->rounded);
    if (!errors.ok()) return;
    trial->errors = errors.value();
    Report(errors.value(), &trial->family);
  }

  void Report(const SurfaceErrors& errors, RoundedFamily* family) const {
    family->error = errors.distance;
    family->everywhere.clear();  // of a measure before this one
    for (const MeshAttribute& attribute : meter_.original().attributes) {
      const size_t a = family->everywhere.size();
      const bool direction = IsDirection(attribute.kind);
      family->everywhere.push_back(direction ? std::max(errors.attributes[a].rms, outlook_.targets().attributes[a]) : kInfinity);
    }
    for (size_t a = 0; a < attributes_.size(); ++a) {
      if (!outlook_.IndexOf(a).has_value()) continue;
      for (const RoundedAttribute::Part& part : attributes_[a].parts) {
        const std::string& name = primitives_[part.member]->attributes[part.index].name;
        for (AttributeReport& report : family->reports[part.member]) {
          if (report.name == name) report.error = meter_.Reported(errors, *outlook_.IndexOf(a));
        }
      }
    }
  }

  const std::vector<const Primitive*>& primitives_;
  const FamilyMeter& meter_;
  const std::function<bool(const RoundedFamily&)>& is_usable_;
  RoundingOutlook outlook_;
  const std::vector<RoundedAttribute>& attributes_;
  RoundingForecast& forecast_;
  FamilyCoder coder_;
  std::map<RoundingLevels, Trial> trials_;
};

}  // namespace

StatusOr<RoundedFamily> RoundFamily(const std::vector<const Primitive*>& primitives, const FamilyMeter& meter,
                                    const SurfaceErrors* own_errors, const std::vector<double>& everywhere,
                                    const std::function<bool(const RoundedFamily&)>& is_usable, uint64_t most_bytes) {
  return FamilyRounder(primitives, meter, own_errors, everywhere, is_usable).Run(most_bytes);
}

}  // namespace lacerta
