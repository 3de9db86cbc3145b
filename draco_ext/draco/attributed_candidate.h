// One way to code a surface with attributes progressively: a base of a certain size, the normal mesh over it, and the stream of it that
// just meets error targets.
#ifndef LACERTA_DRACO_ATTRIBUTED_CANDIDATE_H_
#define LACERTA_DRACO_ATTRIBUTED_CANDIDATE_H_

#include <cstdint>
#include <vector>

#include "draco/attributed_stream.h"
#include "lacerta/attributed_mesh.h"
#include "lacerta/status.h"
#include "remesh/attributed_remesh.h"
#include "remesh/simplify_to_errors.h"

namespace lacerta {

// A surface with attributes, prepared once for all candidates. References must outlive the candidates.
struct AttributedSurface {
  const AttributedMesh& original;
  const SurfaceErrorMeter& meter;  // of the original
  const AttributedParts& parts;
  const InputSurface& surface;     // of parts.refined.surface
  const CollapseHistory& history;  // of the same
};

struct AttributedTrial {
  AttributedStream stream;
  SurfaceErrors errors;  // of the finest level as decoded, against the original
  double ratio = 0;      // WorstRatio: the targets are met where it is at most 1
};

class AttributedCandidate {
 public:
  // num_base_vertices, num_levels: as in AttributedRemeshOptions.
  static StatusOr<AttributedCandidate> Create(const AttributedSurface& input, uint32_t num_base_vertices, int num_levels);

  const AttributedNormalMesh& mesh() const { return mesh_; }

  // Whether the remesh itself, not quantized, leaves something of the targets to quantization.
  StatusOr<bool> CanMeet(const ErrorTargets& targets) const;

  // The fewest bytes found at which the stream meets the targets; where none did in `tries` attempts, each of which corrects the precision of
  // positions and every attribute by the errors of the last one, the nearest. Errors depend on each other (a texture on how far positions
  // slide), so a coarser target may take more bytes than a finer one: try that, too. num_samples: of the measure.
  StatusOr<AttributedTrial> Meet(const ErrorTargets& targets, int tries, uint64_t num_samples) const;

 private:
  AttributedCandidate(const AttributedSurface& input, AttributedNormalMesh mesh) : input_(input), mesh_(std::move(mesh)) {}

  AttributedSurface input_;
  AttributedNormalMesh mesh_;
};

}  // namespace lacerta

#endif  // LACERTA_DRACO_ATTRIBUTED_CANDIDATE_H_
