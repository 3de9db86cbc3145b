// The coder of [Payan & Antonini 2004] as written: open loop, sets (i, 1) and (i, 2), generalized Gaussian models, steps by
// model-based allocation, uniform quantizer. Kept as the reference that every other choice is measured against.
#ifndef LACERTA_ENCODER_PAPER_MODE_H_
#define LACERTA_ENCODER_PAPER_MODE_H_

#include <vector>

#include "encoder/analysis.h"
#include "encoder/coefficient_descent.h"
#include "lacerta/decoder.h"
#include "lacerta/mesh.h"
#include "lacerta/status.h"

namespace lacerta {

// Codes `mesh` at the slope lambda > 0 of the model's rate-distortion curve: squared model units of mean squared vertex error
// per bit of the stream. Fails as Analyze and BitAllocator::Create do.
StatusOr<CodedSurface> CodeByModel(const SemiRegularMesh& mesh, double lambda);

// The same for what any transform made of a mesh. coefficients: as a mesh, but only the first num_base_vertices positions
// matter, which are those of the base; levels, energies: as for Describe.
StatusOr<CodedSurface> CodeByModel(const SemiRegularMesh& coefficients, const std::vector<LevelCoefficients>& levels,
                                   const std::vector<double>& energies, double lambda);

}  // namespace lacerta

#endif  // LACERTA_ENCODER_PAPER_MODE_H_
