// Simplification of a manifold to its coarsest base mesh by half-edge collapses in order of quadric error
// [Garland, Heckbert 1997], keeping the parametrization of the input over every intermediate mesh [Lee et al. 1998].
#ifndef LACERTA_REMESH_DECIMATE_H_
#define LACERTA_REMESH_DECIMATE_H_

#include <cstdint>
#include <vector>

#include "common/subdivision.h"
#include "lacerta/mesh.h"
#include "remesh/collapse_history.h"

namespace lacerta {

struct DecimateOptions {
  uint32_t target_vertices = 16;   // stop there; earlier where no collapse is sound any more
  int max_valence = 12;            // of a base vertex, at most 64; one that the input has more of may stay
  double min_normal_cosine = 0.2;  // between a new triangle and the one it replaces
  // #E of the topology, or empty. 1: a curve where the shape shows none, kept in place like a border
  std::vector<uint8_t> drawn_curves = {};
};

// mesh: oriented manifold, with or without border, one fan per vertex. topology: its own, with its curves; corners
// (CurveRole::kCorner) are never removed, and a vertex on a curve only along the curve. A collapse is sound when it keeps the
// topology (link condition), turns no triangle over and its chart has no fold.
CollapseHistory Decimate(const TriangleMesh& mesh, const Topology& topology, const DecimateOptions& options);

}  // namespace lacerta

#endif  // LACERTA_REMESH_DECIMATE_H_
