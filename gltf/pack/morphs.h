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
#include "pack/target_mixes.h"

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
  // Looks at each target at weight 1 with all others at 0, and at `mixes` besides. Fails like SurfaceDistanceMeter.
  static StatusOr<MorphMeter> Create(const std::vector<MorphedPrimitive>& originals, const std::vector<TargetMix>& mixes);

  // What is looked at: first one target after the other, as many as there are.
  const std::vector<TargetMix>& mixes() const { return mixes_; }

  // Whether d_S between the surfaces is `error` at most in every mix, mesh units.
  StatusOr<bool> AreWithin(double error, const std::vector<MorphedPrimitive>& stored) const;

  // The same of a surface that is morphed already, by one of `mixes`.
  StatusOr<double> Distance(size_t mix, const TriangleMesh& morphed, uint64_t num_samples) const;

 private:
  std::vector<TargetMix> mixes_;
  std::vector<SurfaceDistanceMeter> meters_;  // for each of them
};

// Morph targets in the order that the vertices of a primitive have after coding at a precision; empty where that order
// does not tell, because vertices with other targets became one.
std::optional<std::vector<MorphTarget>> ReorderTargets(const MorphedPrimitive& morphed, const DracoPrecision& precision,
                                                       const Primitive& decoded);

// Bytes of accessors that hold them, sparse where that is smaller.
uint64_t BytesOfTargets(const std::vector<MorphTarget>& targets);

}  // namespace lacerta

#endif  // LACERTA_PACK_MORPHS_H_
