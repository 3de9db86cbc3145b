// What bit allocation needs to know of each coefficient set (i, j).
#ifndef LACERTA_ENCODER_ALLOCATION_SET_STATISTICS_H_
#define LACERTA_ENCODER_ALLOCATION_SET_STATISTICS_H_

#include <cstddef>
#include <vector>

#include "encoder/analysis.h"
#include "lacerta/mesh.h"

namespace lacerta {

enum class SetKind {
  kBaseX,  // the three coordinates of the base positions, level 0
  kBaseY,
  kBaseZ,
  kTangential,  // (i, 1): both tangential coordinates of the details of level i, two samples per detail
  kNormal,      // (i, 2): their normal coordinate
};

struct SetStatistics {
  int level = 0;
  SetKind kind = SetKind::kNormal;
  size_t count = 0;     // samples
  double sigma = 0.0;   // standard deviation, model units: of base coordinates about their mean, of details about 0
  double alpha = 1.0;   // shape of the generalized Gaussian of the active samples, in [kMinAlpha, kMaxAlpha]
  double active = 1.0;  // share of the samples that are not zero, in (0, 1]
  double weight = 0.0;  // mean squared vertex error of the finest mesh per mean squared error of the set's samples
  double sample_fraction = 0.0;  // a_ij: count / (3 #V of the finest mesh); sums to 1 over all sets
};

struct DescribeOptions {
  // Coordinates of details up to this share of the level's mean edge length count as zero: what rounding leaves of a
  // detail that is normal, or of a flat part of the surface. Far below any useful step. 0 = the paper: all samples
  // follow the GGD.
  double zero_share_of_edge_length = 1e-4;
};

// Statistics of all sets in the order x, y, z of level 0, then (1, 1), (1, 2), (2, 1), (2, 2), ...
//   positions          #V of the finest mesh; the first num_base_vertices of them are the base
//   levels             details of levels 1.. from Analyze
//   energies           by level, levels.size() + 1: RegularEnergies or ProbeEnergies
// The weight of a set is (count / #V) E_i, for level i of N_i details: N_i / #V E_i for the normal set, twice that for
// the tangential one.
std::vector<SetStatistics> Describe(Span<Vec3f> positions, size_t num_base_vertices,
                                    const std::vector<LevelCoefficients>& levels, const std::vector<double>& energies,
                                    const DescribeOptions& options = {});

}  // namespace lacerta

#endif  // LACERTA_ENCODER_ALLOCATION_SET_STATISTICS_H_
