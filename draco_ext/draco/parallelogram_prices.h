// What points of a lattice take in a stock stream, by the parallelograms from which its decoder predicts them.
#ifndef LACERTA_DRACO_PARALLELOGRAM_PRICES_H_
#define LACERTA_DRACO_PARALLELOGRAM_PRICES_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "draco/parallelogram_choice.h"
#include "draco/position_stream.h"
#include "geometry/by_vertex.h"
#include "remesh/lattice_fit.h"
#include "remesh/rate_model.h"

namespace lacerta {

// Of the choice of parallelograms and the costs of symbols for all points at the last Begin; single points may then be predicted by others.
class ParallelogramPrices : public PointPrices {
 public:
  // stream: must outlive the prices.
  ParallelogramPrices(const PositionStream& stream, size_t num_vertices);

  void Begin(const std::vector<LatticePoint>& points) override;
  void LookAround(uint32_t v) override;
  double Bits(const LatticePoint& p, double enough) const override;
  void Move(uint32_t v, const LatticePoint& p) override;

  // Of all points but the first, as they are predicted since the last Begin.
  LinearPredictions Predictions() const;

 private:
  // A value that depends on the vertex looked at: what it is predicted from and the value itself are `rest` + `factor` * the vertex.
  struct Part {
    LatticePoint rest{};
    int factor = 0;

    LatticePoint At(const LatticePoint& p) const { return {rest[0] + factor * p[0], rest[1] + factor * p[1], rest[2] + factor * p[2]}; }
  };
  struct Dependent {
    Part value, before;
    std::array<Part, kMostParallelograms> parallelograms;
    uint32_t offers = 0;
    bool has_usual = false;
  };

  Part PartOf(uint32_t n, uint32_t v) const;
  double BitsOf(const Dependent& dependent, const LatticePoint& p) const;

  const PositionStream& stream_;
  ByVertex dependents_;  // values that are at a vertex, or predicted from it
  PredictableValues values_;
  ParallelogramChoice choice_;
  Wrap wrap_;
  std::optional<SymbolCosts> costs_;
  std::vector<Dependent> around_;  // the vertex looked at
};

}  // namespace lacerta

#endif  // LACERTA_DRACO_PARALLELOGRAM_PRICES_H_
