// One way to code a surface with attributes progressively: a base of a certain size, the normal mesh over it, and the stream of it that
// just meets error targets.
#ifndef LACERTA_DRACO_ATTRIBUTED_CANDIDATE_H_
#define LACERTA_DRACO_ATTRIBUTED_CANDIDATE_H_

#include <cstddef>
#include <cstdint>
#include <functional>
#include <limits>
#include <utility>

#include "draco/attributed_stream.h"
#include "geometry/group_surface.h"
#include "lacerta/attributed_mesh.h"
#include "lacerta/status.h"
#include "remesh/attributed_remesh.h"
#include "remesh/simplify_to_errors.h"

namespace lacerta {

// Sets errors of a surface that show elsewhere than in what was measured, as weights of joints do; empty: there are
// none.
using ErrorCorrection = std::function<Status(const AttributedMesh&, uint64_t num_samples, SurfaceErrors*)>;

// What values are for, where they do not say it themselves. May be asked from several threads at a time.
struct AttributeMeaning {
  JointTable joints = {};  // all three as in AttributedStreamOptions
  ErrorFactors factors = {};
  BytesBeside beside = {};
  ErrorCorrection correct = {};
};

// A surface with attributes, prepared once for all candidates. References must outlive the candidates.
struct AttributedSurface {
  const GroupSurface& original;
  const SurfaceErrorMeter& meter;  // of the original
  const AttributedParts& parts;
  const InputSurface& surface;     // of parts.refined.surface
  const CollapseHistory& history;  // of the same
  AttributeMeaning meaning = {};

  StatusOr<SurfaceErrors> Measure(const AttributedMesh& mesh, uint64_t num_samples) const;
};

struct AttributedTrial {
  AttributedStream stream;
  SurfaceErrors errors;  // of the finest level as decoded, against the original
  double ratio = 0;      // WorstRatio: the targets are met where it is at most 1
  double remesh_distance = 0;  // of the remesh before anything is quantized, as errors.distance
  int measurements = 0;        // of errors, that it took
  double least_bytes = 0;  // about what would do where errors are below their targets
};

struct MeetOptions {
  int first_tries = 6;   // until the targets are met, > 0
  int finer_tries = 4;   // with more precise positions than those need
  uint64_t num_samples = 50'000;  // of the measure that the stream is held to; the search takes a quarter
  size_t most_bytes = std::numeric_limits<size_t>::max();  // no more attempts where the stream seems to need as many or more
};

class AttributedCandidate {
 public:
  // num_base_vertices, num_levels: as in AttributedRemeshOptions.
  static StatusOr<AttributedCandidate> Create(const AttributedSurface& input, uint32_t num_base_vertices, int num_levels);

  const AttributedNormalMesh& mesh() const { return mesh_; }

  // Of the remesh itself, not quantized.
  const SurfaceErrors& errors() const { return errors_; }

  // Whether the remesh leaves something of the targets to quantization.
  bool CanMeet(const ErrorTargets& targets) const;

  // The smallest stream found that meets the targets; where none does, the nearest. Precisions of positions and of every attribute are corrected by the
  // errors of the attempt before. Attributes are off by their own residuals and by how far positions slide below them, so that more precise
  // positions may save bytes: they are tried for as long as they do.
  StatusOr<AttributedTrial> Meet(const ErrorTargets& targets, const MeetOptions& options) const;

 private:
  AttributedCandidate(const AttributedSurface& input, AttributedNormalMesh mesh, SurfaceErrors errors)
      : input_(input), mesh_(std::move(mesh)), errors_(std::move(errors)) {}

  AttributedSurface input_;
  AttributedNormalMesh mesh_;
  SurfaceErrors errors_;
};

}  // namespace lacerta

#endif  // LACERTA_DRACO_ATTRIBUTED_CANDIDATE_H_
