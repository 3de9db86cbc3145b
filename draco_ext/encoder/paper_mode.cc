#include "encoder/paper_mode.h"

#include <algorithm>
#include <cmath>

#include "encoder/allocation/bit_allocation.h"
#include "encoder/allocation/subband_weights.h"
#include "encoder/quantizer.h"

namespace lacerta {
namespace {

// Where the model would not code the base at all the lattice still needs a step: the base fits into this many cells.
constexpr double kFewestLatticeCells = 16;

float LatticeStep(const std::vector<SetStatistics>& sets, const BitAllocation& allocation) {
  double spread = 0;
  for (const SetStatistics& set : sets) {
    if (set.level == 0) spread = std::max(spread, set.sigma);
  }
  return static_cast<float>(std::min(CommonBaseStep(sets, allocation), 4 * spread / kFewestLatticeCells));
}

}  // namespace

StatusOr<CodedSurface> CodeByModel(const SemiRegularMesh& mesh, double lambda) {
  LACERTA_ASSIGN_OR_RETURN(const std::vector<LevelCoefficients> levels, Analyze(mesh));
  return CodeByModel(mesh, levels, RegularEnergies(mesh.num_levels), lambda);
}

StatusOr<CodedSurface> CodeByModel(const SemiRegularMesh& mesh, const std::vector<LevelCoefficients>& levels,
                                   const std::vector<double>& energies, double lambda) {
  const std::vector<SetStatistics> sets = Describe(mesh.positions, mesh.num_base_vertices, levels, energies, DescribeOptions{0.0});
  const double num_samples = 3.0 * static_cast<double>(mesh.positions.size());
  LACERTA_ASSIGN_OR_RETURN(const BitAllocation allocation, AllocateForSlope(sets, lambda * num_samples));

  CodedSurface coded;
  const std::vector<Vec3f> base(mesh.positions.begin(), mesh.positions.begin() + mesh.num_base_vertices);
  coded.base = RoundToLattice({base, mesh.base_triangles}, LatticeStep(sets, allocation));
  coded.steps = StepsByLevel(sets, allocation, mesh.num_levels);
  for (size_t i = 0; i < levels.size(); ++i) {
    QuantizedLevel quantized;
    for (const Vec3f& detail : levels[i].detail) {
      quantized.tangential.push_back(RoundToStep(detail.x, coded.steps[i].tangential_step));
      quantized.tangential.push_back(RoundToStep(detail.y, coded.steps[i].tangential_step));
      quantized.normal.push_back(RoundToStep(detail.z, coded.steps[i].normal_step));
    }
    coded.levels.push_back(std::move(quantized));
  }
  return coded;
}

}  // namespace lacerta
