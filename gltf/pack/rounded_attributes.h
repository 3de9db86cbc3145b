// The attributes of a family that are rounded, each over all primitives that have it.
#ifndef LACERTA_PACK_ROUNDED_ATTRIBUTES_H_
#define LACERTA_PACK_ROUNDED_ATTRIBUTES_H_

#include <map>
#include <string>
#include <vector>

#include "document/draco_encode.h"
#include "document/primitive.h"
#include "lacerta/gltf.h"
#include "pack/attributed_family.h"

namespace lacerta {

// How finely something is rounded: in steps of its range / 2^(level / kLevelsPerBit).
inline constexpr int kLevelsPerBit = 4;
inline constexpr int kMostLevel = kLevelsPerBit * (kMostLatticeBits - 1);

// At which a range is so many steps, or somewhat fewer: 0 .. kMostLevel.
int LevelOfSteps(double steps);

// One attribute of those members that share its name and scale.
struct RoundedAttribute {
  struct Part {
    size_t member = 0;
    size_t index = 0;  // in the primitive's attributes
    Lattice box;       // its values; bits mean nothing
  };

  std::string name;         // SoupName
  double target = 0.0;      // RMS over the surface, in `unit`
  double scale = 1.0;       // from the attribute's unit to that of the target; directions are in degrees
  bool direction = false;
  bool octahedral = false;
  bool is_shown = true;     // as a color or so on the surface; weights belong to their vertices, and add up to 1
  std::string unit;         // "texels", "degrees" or empty
  float range = 0.0f;       // the largest of its parts
  std::vector<Part> parts;  // of ascending members; all are rounded to the same step
  double num_numbers = 0.0; // elements times components as coded, of all parts

  int FirstLevel() const;
  int StartLevel() const;  // at which the step moves values by about the target
  int AtOrAbove(int level) const;  // octahedral coding comes in whole bits
  Lattice LatticeAt(const Part& part, int level) const;  // of what is not octahedral
  AccessorData RoundedAt(const AccessorData& values, const Part& part, int level) const;  // values of a part as a decoder returns them
};

// by_name: targets of colors and application attributes, the length of a difference. Attributes that nobody gave a tolerance for (JOINTS, others
// that are not named there) and those with values that are not finite are not in here: they stay exact.
std::vector<RoundedAttribute> RoundedAttributesOf(const std::vector<const Primitive*>& primitives,
                                                  const AttributeTargets& targets, const TexelScale& scale,
                                                  const std::map<std::string, double>& by_name = {});

}  // namespace lacerta

#endif  // LACERTA_PACK_ROUNDED_ATTRIBUTES_H_
