// Analysis of a semi-regular mesh: the forward transform of the codec, [Payan & Antonini 2004] Sec. II-B.
//
// Unlifted butterfly: the positions of level i - 1 are the first ones of level i, and the detail of the midpoint of
// edge e is what the butterfly does not predict, d_e = F_e^T (x_e - B_e(c)), in the local frame F_e of the predicted
// fine mesh [Khodakovsky, Guskov 2002]. Open loop: prediction and frames come from the exact coarse positions.
#ifndef LACERTA_ENCODER_ANALYSIS_H_
#define LACERTA_ENCODER_ANALYSIS_H_

#include <vector>

#include "lacerta/mesh.h"
#include "lacerta/status.h"

namespace lacerta {

// Details of one level, one per edge of the level below, in the order of its edges.
struct LevelCoefficients {
  std::vector<Vec3f> detail;      // #E x (tangent1, tangent2, normal), model units; zero at copies
  double mean_edge_length = 0.0;  // of the edges that were split, model units
};

// Details of levels 1 .. num_levels; entry i - 1 is level i. Fails with kInvalidData where the base mesh is not an
// oriented manifold (BuildTopology), and with kInvalidArgument where a position is not finite or the number of
// positions or levels does not fit the connectivity.
StatusOr<std::vector<LevelCoefficients>> Analyze(const SemiRegularMesh& mesh);

// When a detail counts as normal, that is its vertex as lying on the normal through its predicted position.
struct NormalTolerance {
  double share_of_normal = 0.05;       // tangential length at most this share of the length of the normal part, or
  double share_of_edge_length = 1e-4;  // at most this share of the level's mean edge length
};

// Share (0..1) of all details that are normal; 1 where there are none. Measured on the mesh alone: for one that comes
// from the remesher, NormalShare in lacerta/remesh.h counts how its vertices were found.
double NormalDetailShare(const std::vector<LevelCoefficients>& levels, const NormalTolerance& tolerance = {});

}  // namespace lacerta

#endif  // LACERTA_ENCODER_ANALYSIS_H_
