// Integers for the offsets of morph targets, which KHR_mesh_quantization allows.
#ifndef LACERTA_PACK_ROUND_TARGETS_H_
#define LACERTA_PACK_ROUND_TARGETS_H_

#include <vector>

#include "pack/source.h"

namespace lacerta {

// What rounding may put offsets off by, RMS over those that are not zero; 0: they stay floats.
struct TargetTolerance {
  double positions = 0.0;   // mesh units
  double directions = 0.0;  // of normals and tangents, radians
};

// Of what is allowed, in positions: several targets may show at once, and what each is off adds up.
inline constexpr double kShareOfOffsets = 0.2;

// What is left of an error that may be `allowed` and is `taken` by something independent.
double RoomBeside(double taken, double allowed);

// Offsets of floats as normalized integers of 8 bits or, where these are not near enough, of 16. Those that neither holds,
// which reach from -1 to 1, stay as they are, and so do offsets that are integers already.
std::vector<MorphTarget> RoundTargets(std::vector<MorphTarget> targets, const TargetTolerance& tolerance);

// Whether readers have to know KHR_mesh_quantization.
bool AreQuantized(const std::vector<MorphTarget>& targets);

}  // namespace lacerta

#endif  // LACERTA_PACK_ROUND_TARGETS_H_
