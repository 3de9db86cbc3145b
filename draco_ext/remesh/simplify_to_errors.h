// The smallest simplified surface that stays within errors of positions and attributes.
#ifndef LACERTA_REMESH_SIMPLIFY_TO_ERRORS_H_
#define LACERTA_REMESH_SIMPLIFY_TO_ERRORS_H_

#include <cstdint>
#include <functional>
#include <vector>

#include "lacerta/attributed_mesh.h"
#include "lacerta/status.h"
#include "remesh/surface_errors.h"

namespace lacerta {

struct SimplifyToErrorsOptions {
  uint64_t num_samples = 100'000;        // of the measure that the result is held to
  uint64_t num_search_samples = 10'000;  // while the size is looked for
  int num_weightings = 5;                // at most: weights of attributes are set anew by what limited the size while that pays
  // Makes of a fitted surface what will be stored of it, before it is measured: for values that something else follows from.
  std::function<void(AttributedMesh*)> finish = nullptr;
};

struct SimplifiedSurface {
  AttributedMesh mesh;
  SurfaceErrors errors;       // measured with num_samples
  bool meets_targets = true;  // false only where even the input's own triangles do not, by the precision of the measure
};

// Of `most` samples those that a search needs on a surface of so many triangles: small parts, of which an asset may have thousands, have
// less to tell. What is found is measured with all.
uint64_t SamplesToTell(size_t num_triangles, uint64_t most);

// For each attribute the weight against positions, as for AttributedSimplification, that the targets tell.
std::vector<double> WeightsOfTargets(const AttributedMesh& mesh, const SurfaceErrorMeter& meter, const ErrorTargets& targets);

// The smallest mesh found of those that AttributedSimplification makes of the original and that meet the targets. meter: of the original, or
// of what that is the AttributedProxy of. The weight of each attribute against positions is what the targets say, then changed by which of
// them limits the size.
StatusOr<SimplifiedSurface> SimplifyToErrors(const AttributedMesh& original, const SurfaceErrorMeter& meter, const ErrorTargets& targets,
                                             const SimplifyToErrorsOptions& options = {});

}  // namespace lacerta

#endif  // LACERTA_REMESH_SIMPLIFY_TO_ERRORS_H_
