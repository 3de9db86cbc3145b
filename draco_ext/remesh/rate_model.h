// What a mesh takes in the stream of a parallelogram coder, as solvers over vertex positions need it.
#ifndef LACERTA_REMESH_RATE_MODEL_H_
#define LACERTA_REMESH_RATE_MODEL_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "remesh/mesh_neighbors.h"

namespace lacerta {

// What a parallelogram coder spends on a vertex, and what that is worth. A vertex that is predicted with the error r on a lattice
// of step s takes about 1.5 log2(1 + c |r|^2 / s^2) bits. Where its predictors are not known, all flaps around it count alike, a third of that each.
struct RateModel {
  double step = 0;                // of the lattice, model units
  double distortion_per_bit = 0;  // squared model units of DistanceModel's E for a bit; 0: bits do not matter

  // Of a mesh that is off by that much more, squared model units, once it is on its lattice.
  static RateModel For(double lattice_distortion, size_t num_vertices);
  static double StepFor(double lattice_distortion);  // of that lattice

  // Of all vertices of a mesh with the given flaps: bits of one flap with the squared error r2.
  double BitsOfFlap(double r2) const;
  // Slope of that over r2.
  double BitSlope(double r2) const;
};

// Errors of predictions, each the sum of some vertices by factors.
class LinearPredictions {
 public:
  struct Term {
    uint32_t vertex = 0;
    float factor = 0;
  };

  // flaps: as many bits each takes.
  explicit LinearPredictions(double flaps) : flaps_(flaps) {}

  // All flaps of a mesh, of which it is not known which ones predict.
  static LinearPredictions OfFlaps(const MeshNeighbors& neighbors);

  // To the last prediction.
  void Add(uint32_t vertex, float factor) { terms_.push_back({vertex, factor}); }
  void EndPrediction() { first_.push_back(static_cast<uint32_t>(terms_.size())); }

  size_t size() const { return first_.size() - 1; }
  double flaps() const { return flaps_; }
  Span<const Term> operator[](size_t i) const { return {terms_.data() + first_[i], first_[i + 1] - first_[i]}; }

  static constexpr double kFlapsPerVertex = 3;  // on average, and what one takes that is the only one

 private:
  double flaps_ = 1;
  std::vector<uint32_t> first_ = {0};
  std::vector<Term> terms_;
};

}  // namespace lacerta

#endif  // LACERTA_REMESH_RATE_MODEL_H_
