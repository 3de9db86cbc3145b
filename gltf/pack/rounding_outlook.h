// Which levels of rounding are expected to meet the targets of a family: what is forecast, corrected by what was measured.
#ifndef LACERTA_PACK_ROUNDING_OUTLOOK_H_
#define LACERTA_PACK_ROUNDING_OUTLOOK_H_

#include <cstddef>
#include <optional>
#include <vector>

#include "document/primitive.h"
#include "lacerta/status.h"
#include "pack/family_meter.h"
#include "pack/rounded_attributes.h"
#include "pack/rounding_forecast.h"
#include "pack/rounding_levels.h"

namespace lacerta {

class RoundingOutlook {
 public:
  // Arguments as of RoundFamily (pack/rounded.h), which they must outlive.
  RoundingOutlook(const std::vector<const Primitive*>& primitives, const FamilyMeter& meter, const SurfaceErrors* own_errors,
                  const std::vector<double>& everywhere);
  RoundingOutlook(const RoundingOutlook&) = delete;
  RoundingOutlook& operator=(const RoundingOutlook&) = delete;

  const std::vector<RoundedAttribute>& attributes() const { return attributes_; }
  RoundingForecast& forecast() { return forecast_; }
  const ErrorTargets& targets() const { return targets_; }
  // Of one of attributes() in the meter's original; none where that has it not.
  std::optional<size_t> IndexOf(size_t a) const { return indices_[a]; }
  // Error of an attribute of the meter's original over its target.
  double Ratio(const SurfaceErrors& errors, size_t index) const;

  // Levels that are expected to meet the targets: from the coarsest positions on, with attributes as coarse as these allow,
  // the few for which the fewest bits are expected.
  std::vector<RoundingLevels> Candidates();
  // Whether what is rounded more coarsely than `best` is expected to meet the targets, from what was measured of that.
  bool MayMeet(const RoundingLevels& levels, const RoundingLevels& best, const SurfaceErrors& errors_of_best);
  // What rounding may add to the error of an attribute on these positions, relative to its target and squared.
  double RoomFor(size_t a, const RoundedPositions& positions) const;

  // Positions of a level were of no use, whatever their errors.
  void RefusePositions(int level) { least_positions_ = level + kLevelsPerBit / 2; }
  // Takes what was measured at these levels in the place of what was expected. rounded: of each attribute, what was forecast. Returns whether
  // the targets are met.
  bool Learn(const StatusOr<SurfaceErrors>& errors, const RoundingLevels& levels, const std::vector<double>& rounded);

 private:
  // Measured over forecast, squared; of what is not yet measured 1.
  struct Correction {
    double distance = 1.0;
    double poses = 1.0;
    std::vector<double> attributes;
  };
  // Of an attribute that errs by far more than forecast.
  struct Unforeseen {
    double measured = 0.0;     // over its target
    bool is_position = false;  // what was made finer for it: positions, or the attribute
    int least_attribute = 1;   // before that
    int times = 0;             // that it was so before
  };

  // Whether an attribute is held to what poses show of it.
  bool IsPosed(size_t a) const { return poses_.has_value() && !attributes_[a].is_shown; }
  double Added(size_t a, int level);
  std::optional<int> LevelFor(size_t a, const RoundedPositions& positions);
  double PoseRoom() const;
  int FirstPositions();
  double WorstExactRatio(const SurfaceErrors& errors) const;
  void Correct(const SurfaceErrors& errors, const RoundingLevels& levels, const std::vector<double>& rounded);
  void Blame(size_t a, double measured, const RoundingLevels& levels);

  const FamilyMeter& meter_;
  const std::vector<RoundedAttribute> attributes_;
  RoundingForecast forecast_;
  ErrorTargets targets_;
  std::vector<std::optional<size_t>> indices_;  // of attributes_ in the meter's original
  std::optional<size_t> poses_;                 // in the meter's original; with a skin
  double num_positions_ = 1.0;
  std::vector<double> num_numbers_;  // of each attribute
  // Errors that the primitives have before they are rounded, relative to the targets.
  double own_distance_ = 0.0;
  double own_turned_ = 0.0;  // share of the area, away from its normals
  double own_poses_ = 0.0;
  std::vector<double> own_attributes_;
  // What was learned.
  Correction correction_;
  int least_positions_ = 1;
  int num_turned_ = 0;  // how often positions were too coarse for that
  std::vector<int> least_attributes_;                  // levels
  std::vector<std::optional<Unforeseen>> unforeseen_;  // of each attribute, the last
};

}  // namespace lacerta

#endif  // LACERTA_PACK_ROUNDING_OUTLOOK_H_
