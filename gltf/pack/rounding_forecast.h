// What rounding will do to the errors of a family, forecast triangle by triangle. No closest points are searched for:
// within a triangle everything is linear, and what moves within its plane takes the attributes with it.
#ifndef LACERTA_PACK_ROUNDING_FORECAST_H_
#define LACERTA_PACK_ROUNDING_FORECAST_H_

#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "document/primitive.h"
#include "lacerta/mesh.h"
#include "pack/position_descent.h"
#include "pack/rounded_attributes.h"
#include "pack/skin.h"

namespace lacerta {

// Positions of a family rounded to one lattice.
struct RoundedPositions {
  Lattice lattice;
  std::vector<std::vector<Vec3f>> moved;  // of each primitive
  double distance = 0.0;       // RMS over the surface of how far it moves along its normals
  double flipped = 0.0;        // share of its area that looks to the other side
  std::vector<double> slides;  // for each attribute the RMS by which its values slide along, once they are fitted to that, as `Rounded`
};

class RoundingForecast {
 public:
  // Refers to its arguments. skin: of the primitives, or null where they have none that is known; all have joints and weights then.
  RoundingForecast(const std::vector<const Primitive*>& primitives, const std::vector<RoundedAttribute>& attributes, const Skin* skin = nullptr);

  // Over the box of all positions in steps of its longest side / 2^(level / kLevelsPerBit); level >= 1.
  Lattice LatticeAt(int level) const;
  const RoundedPositions& Positions(int level);

  // Of each part of an attribute the values fitted to where Positions(level) are, not rounded.
  const std::vector<AccessorData>& Fitted(size_t attribute, int level);

  // RMS of an attribute rounded at a level, in the unit of its target, over the 99 % of the surface where it is least;
  // of other than texture coordinates and directions over all of it. 0 beyond kMostLevel.
  double Rounded(size_t attribute, int level) { return ErrorsOf(attribute, level).rms; }
  // The same of an attribute whose parts become `rounded` where they should be `values`.
  double Rounded(size_t attribute, const std::vector<AccessorData>& values, const std::vector<AccessorData>& rounded) const {
    return ErrorsOf(attribute, values, rounded).rms;
  }
  // At a level, of the triangle where it is most.
  double MostRounded(size_t attribute, int level) { return ErrorsOf(attribute, level).most; }

  // With a skin: RMS over the surface of how far weights rounded at a level move it along its normals, in the pose where that is most. 0 beyond kMostLevel.
  double Posed(size_t attribute, int level);

  // The level at which a step moves positions by about `error`.
  int StartLevel(double error) const;

 private:
  struct Errors {
    double rms = 0.0, most = 0.0;
  };
  const Errors& ErrorsOf(size_t attribute, int level);
  Errors ErrorsOf(size_t attribute, const std::vector<AccessorData>& values, const std::vector<AccessorData>& rounded) const;
  static Errors ErrorsOf(const RoundedAttribute& attribute, std::vector<std::pair<double, double>>* squares);

  const std::vector<const Primitive*>& primitives_;
  const std::vector<RoundedAttribute>& attributes_;
  const Skin* const skin_;
  std::vector<TriangleMesh> surfaces_;  // of the primitives
  std::optional<PositionDescent> descent_;
  Lattice box_;
  bool has_area_ = false;
  std::map<int, RoundedPositions> positions_;
  std::map<std::pair<size_t, int>, std::vector<AccessorData>> fitted_;
  std::map<std::pair<size_t, int>, Errors> rounded_;
  std::map<std::pair<size_t, int>, double> posed_;
};

}  // namespace lacerta

#endif  // LACERTA_PACK_ROUNDING_FORECAST_H_
