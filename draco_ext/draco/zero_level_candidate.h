// One simplified mesh as a zero-level stream near a target.
#ifndef LACERTA_DRACO_ZERO_LEVEL_CANDIDATE_H_
#define LACERTA_DRACO_ZERO_LEVEL_CANDIDATE_H_

#include <cstddef>
#include <optional>

#include "draco/position_stream.h"
#include "draco/zero_level.h"
#include "lacerta/mesh.h"
#include "lacerta/status.h"
#include "remesh/distance_model.h"
#include "remesh/mesh_neighbors.h"
#include "remesh/lattice_fit.h"

namespace lacerta {

// A mesh with its vertices fitted to the input, and the codings of it on lattices.
class ZeroLevelCandidate {
 public:
  struct Coding {
    double step = 0;
    size_t bytes = 0;       // of `effort`
    double distortion = 0;  // squared distance d_S to the input, model units, by the samples of the fit
    CodedZeroLevel coded;
  };

  enum class Source {
    kInput,       // as it is: there is nothing to fit
    kSimplified,
    kFitted,      // simplified a little after it was fitted
  };

  // target: must outlive the candidate.
  ZeroLevelCandidate(const FitTarget& target, TriangleMesh mesh, Source source);

  // Squared d_S without a lattice, by the samples of the last fit.
  double fit_distortion() const { return fit_distortion_; }
  size_t num_triangles() const { return mesh_.triangles.size(); }

  // Turns edges and fits the vertices again, with the samples that the target has now, and with regard to the bytes on lattices that add
  // `lattice_distortion` to the squared distance.
  void FitForRate(double lattice_distortion, int rounds);

  // Finds the order of the smallest stock stream on the lattice of this step, and fits the vertices to what predicts them there. Coding is in
  // that order from then on; where there is none, as before.
  void FitForStream(double step);

  // On the lattice of this step, or of the finest that Draco keeps. coding: see EncodeLatticeMesh. rounds: of descent, each after looking anew.
  StatusOr<Coding> Code(double step, int rounds, CodingEffort effort, BaseCoding coding = BaseCoding::kStock) const;

 private:
  double StepNear(double step) const;
  LatticeMesh FitLattice(double step, int rounds, double* distortion) const;
  StatusOr<CodedZeroLevel> Encode(const LatticeMesh& lattice, CodingEffort effort, BaseCoding coding) const;

  const FitTarget& target_;
  TriangleMesh mesh_;
  const Source source_;
  // None where there are too many triangles to be fitted and to have their lattice points chosen; nor is there a model then.
  std::optional<MeshNeighbors> neighbors_;
  DistanceModel model_;  // at mesh_
  std::optional<PositionStream> order_;
  double fit_distortion_ = 0;
  double distortion_per_bit_ = 0;
};

}  // namespace lacerta

#endif  // LACERTA_DRACO_ZERO_LEVEL_CANDIDATE_H_
