// Morph targets as attributes of a primitive, so that they are simplified with it.
#ifndef LACERTA_PACK_MORPHS_H_
#define LACERTA_PACK_MORPHS_H_

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "document/draco_encode.h"
#include "document/primitive.h"
#include "lacerta/status.h"
#include "lacerta/surface_distance.h"
#include "pack/source.h"

namespace lacerta {

// "TARGET_2/NORMAL": NORMAL of the third target, in a primitive that WithTargets made.
bool IsTargetAttribute(const std::string& name);
bool IsTargetPosition(const std::string& name);

// The primitive with the offsets of its targets as further attributes of floats. Fails with kUnsupported where there
// are others than those of POSITION, NORMAL and TANGENT, or too many to be looked at together.
StatusOr<Primitive> WithTargets(const Primitive& primitive, const std::vector<MorphTarget>& targets);

// The way back: takes them out again, in the order of `like`. Offsets of positions up to `nothing` become 0.
std::vector<MorphTarget> TakeTargets(const std::vector<MorphTarget>& like, double nothing, Primitive* primitive);

// A primitive and its targets.
struct MorphedPrimitive {
  const Primitive* primitive = nullptr;
  const std::vector<MorphTarget>* targets = nullptr;
};

class MorphMeter {
 public:
  // Fails like SurfaceDistanceMeter.
  static StatusOr<MorphMeter> Create(const std::vector<MorphedPrimitive>& originals);

  // d_S between the surfaces with one target at weight 1 and all others at 0, of the target where that is largest, mesh units.
  StatusOr<double> Worst(const std::vector<MorphedPrimitive>& stored) const;

  // The same of a surface that is morphed already. target: one of the originals'.
  StatusOr<double> Distance(size_t target, const TriangleMesh& morphed, uint64_t num_samples) const;

 private:
  std::vector<SurfaceDistanceMeter> targets_;
};

// Morph targets in the order that the vertices of a primitive have after coding at a precision; empty where that order
// does not tell, because vertices with other targets became one.
std::optional<std::vector<MorphTarget>> ReorderTargets(const MorphedPrimitive& morphed, const DracoPrecision& precision,
                                                       const Primitive& decoded);

// Bytes of accessors that hold them, sparse where that is smaller.
uint64_t BytesOfTargets(const std::vector<MorphTarget>& targets);

}  // namespace lacerta

#endif  // LACERTA_PACK_MORPHS_H_
