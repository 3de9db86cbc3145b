// Choice of the quantized coefficients by their effect on the surface that the decoder will show: coordinate descent on
//   distortion + lambda * bits
// over the coefficients of all levels and the lattice of the base, coarse to fine, several times over.
//
// Distortion is that of encoder/surface_target.h at the finest level, linearized around the present surface; the effect of a
// coefficient is looked at one level finer than its own, with the gradient brought there by the transposed subdivision and
// the masses lumped. Bits are those that the adaptive models charge at that point of the stream.
#ifndef LACERTA_ENCODER_COEFFICIENT_DESCENT_H_
#define LACERTA_ENCODER_COEFFICIENT_DESCENT_H_

#include <vector>

#include "common/coefficient_coding.h"
#include "common/coefficient_sets.h"
#include "encoder/surface_target.h"
#include "lacerta/decoder.h"

namespace lacerta {

// A base mesh with quantized details: all that a stream holds.
struct CodedSurface {
  BaseMesh base;
  std::vector<LevelSteps> steps;        // L
  std::vector<QuantizedLevel> levels;   // L
};

// What a finer quality layer refines coefficients into: those of a level with 2^drop times smaller steps. Choices whose refinement takes
// many bits cost more. A level whose drop is 0 stays as it is.
struct FinerLayer {
  const std::vector<QuantizedLevel>* levels = nullptr;  // L
  std::vector<int> drops;                               // L
  double weight = 1;                                    // of these bits

  // About the bits that turn `value` of a level (1 .. L) into what is wanted.
  float Bits(int level, CoefficientKind kind, uint32_t edge, int32_t value) const;
};

struct DescentOptions {
  double lambda = 0.0;   // squared model units per bit
  int passes = 3;
  bool move_base = true;  // the lattice points of the base may move too
  const FinerLayer* finer = nullptr;  // where it is a quality layer; no set is left out then
};

// The surface that a decoder makes of it, all levels: #V of the finest.
std::vector<Vec3f> Synthesize(const SurfaceTarget& target, const CodedSurface& coded);

// Closed loop: each detail is taken against the decoded coarser level and rounded. Vertices found by piercing slide along the
// input's tangent plane onto the normal line and need no tangential part.
// positions: becomes Synthesize of that, where given.
CodedSurface QuantizeClosedLoop(const SurfaceTarget& target, const BaseMesh& base, const std::vector<LevelSteps>& steps,
                                std::vector<Vec3f>* positions = nullptr);

// Improves `coded`, whose steps stay as they are. positions: where given, Synthesize of the surface on entry and of that returned on return.
CodedSurface Descend(const SurfaceTarget& target, CodedSurface coded, const DescentOptions& options, std::vector<Vec3f>* positions = nullptr);

// Mean squared distance of a surface to the planes of the target, over the area of the finest level, squared model units: distances vary
// linearly over a triangle. With the squared distance of the unquantized remesh added it foretells the measured one within some hundredths
// of a dB; masses lumped at the vertices overstate it by up to 1.7 dB, since errors of neighbors partly cancel. positions: #V of the finest level.
double PlaneDistortion(const SurfaceTarget& target, const std::vector<Vec3f>& positions);
// The same, but for curves, whose vertices may be off in all directions.
double SurfaceDistortion(const SurfaceTarget& target, const std::vector<Vec3f>& positions);

}  // namespace lacerta

#endif  // LACERTA_ENCODER_COEFFICIENT_DESCENT_H_
