// Triangles that go through each other everywhere ("soup"). What is asked of a surface again and again, for the point of it closest to
// another, takes time with their number there, so they are not remeshed, simplified or fitted, and measured a few times only.
#ifndef LACERTA_DRACO_CROWDED_INPUT_H_
#define LACERTA_DRACO_CROWDED_INPUT_H_

#include "draco/candidate_search.h"
#include "draco/zero_level_search.h"
#include "lacerta/mesh.h"
#include "lacerta/status.h"
#include "lacerta/surface_distance.h"

namespace lacerta {

// What TriangleTree::Crowding is above this in. Scans, CAD models and assets have 3 to 8 (57 files), 150 random triangles 78, 1,500 of
// them 716.
inline constexpr double kMostCrowding = 50;

// How many of `most` samples to measure in that crowding, above kMostCrowding: as many as take as long as all do in a crowd of 20, but 2,000, enough to
// tell 0.2 dB.
uint64_t SamplesInCrowd(double crowding, uint64_t most);

// All triangles of `mesh` on a lattice whose step meets the target, as a zero-level stream; where none does, the nearest. crowding: of
// the mesh, above kMostCrowding; the more there is, the fewer samples are measured, 2,000 at least, so that the time does not grow with
// it up to 20,000. Fails as EncodeLatticeMesh does.
StatusOr<ZeroLevelStream> CodeCrowdedInput(const TriangleMesh& mesh, double crowding, const SurfaceDistanceMeter& meter, const ResolvedTarget& target);

}  // namespace lacerta

#endif  // LACERTA_DRACO_CROWDED_INPUT_H_
