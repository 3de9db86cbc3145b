// Simplification in steps, between which the vertices are fitted to the input.
#ifndef LACERTA_REMESH_FITTED_SIMPLIFY_H_
#define LACERTA_REMESH_FITTED_SIMPLIFY_H_

#include <cstdint>
#include <vector>

#include "lacerta/mesh.h"
#include "remesh/distance_model.h"
#include "remesh/simplify.h"

namespace lacerta {

// Simplified meshes of one input, each made from a fitted one that is at most a tenth larger. Quadrics are of planes that are there, so
// that what the fit mends stays mended: fitted again, these are 0.5 dB nearer to the input than meshes of a run of their own
// (docs/decisions/0030-planes-now.md).
class FittedSimplification {
 public:
  struct Options {
    uint32_t largest;  // triangles; larger meshes come from the sequence as they are
    size_t fewest_samples, most_samples;  // of the target, four for each triangle in between
  };

  // sequence: of the input; target: the input, which is sampled anew for each step. Both must outlive this.
  FittedSimplification(const SimplificationSequence& sequence, const Options& options, FitTarget* target);

  // As SimplificationSequence::MeshWith; not fitted at this size. Steps are taken down to it and kept; which ones does not depend on what was
  // asked for before.
  TriangleMesh MeshWith(uint32_t num_triangles);
  // Whether MeshWith makes such a mesh of a fitted one.
  bool IsOfStep(uint32_t num_triangles) const { return num_triangles <= options_.largest && num_triangles < sequence_.num_input_triangles(); }

 private:
  struct Step {
    uint32_t num_triangles;
    SimplificationSequence sequence;  // of the fitted mesh
  };

  Step Fitted(TriangleMesh mesh, uint32_t num_triangles) const;

  const SimplificationSequence& sequence_;
  const Options options_;
  FitTarget* const target_;
  std::vector<Step> steps_;  // from the largest down
};

}  // namespace lacerta

#endif  // LACERTA_REMESH_FITTED_SIMPLIFY_H_
