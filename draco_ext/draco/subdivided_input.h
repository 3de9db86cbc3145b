// Input that is semi-regular already, coded on its own connectivity: vertices and triangles come back one for one.
#ifndef LACERTA_DRACO_SUBDIVIDED_INPUT_H_
#define LACERTA_DRACO_SUBDIVIDED_INPUT_H_

#include "draco/normal_mesh_candidate.h"
#include "draco/rate_control.h"
#include "lacerta/codec.h"
#include "lacerta/mesh.h"
#include "lacerta/status.h"
#include "lacerta/surface_distance.h"
#include "remesh/unsubdivide.h"

namespace lacerta {

// The way to code `input` on the base and levels of `split`, which UndoSubdivision found in it. Every decoded vertex is within
// one step of its own along each axis of its local frame, but in paper mode. Fails where Draco cannot carry the base.
StatusOr<NormalMeshCandidate> SubdividedCandidate(const TriangleMesh& input, const Unsubdivided& split,
                                                  BaseCoding coding = BaseCoding::kStock);

// Codes it at the target; the nearest stream where that is out of reach, which the result says. Fails as above, and with
// kUnsupported where the bytes of a rate target do not tell vertices from their neighbors.
StatusOr<ChosenStream> CodeSubdivided(const TriangleMesh& input, const Unsubdivided& split, const SurfaceDistanceMeter& meter,
                                      const ResolvedTarget& target, EncodeMode mode, const SearchEffort& effort = SearchEffort());

}  // namespace lacerta

#endif  // LACERTA_DRACO_SUBDIVIDED_INPUT_H_
