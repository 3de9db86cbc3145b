// Which vertex of a base mesh is coded next, and where it is expected: shared by both sides of the coding of positions
// (common/position_coding.h). Specified in docs/format.md, "Positions of the compact base".
//
// An edge with two faces and their four vertices is a flap. If the faces around its end a were equal, the far ends c, d of the
// edges beside the edge to b would have c + d = t b + (2 - t) a with t = 2 cos(2 pi / valence of a): for valence 6 this is the
// parallelogram. A vertex is expected where the flaps that lack it alone fit best, by least squares. Of all vertices, the one for
// which these equations weigh most is coded next: a generalization of multi-parallelogram prediction [Cohen-Or et al. 2002].
#ifndef LACERTA_COMMON_POSITION_PREDICTION_H_
#define LACERTA_COMMON_POSITION_PREDICTION_H_

#include <array>
#include <cstdint>
#include <queue>
#include <utility>
#include <vector>

#include "common/lattice_point.h"
#include "common/subdivision.h"

namespace lacerta {

using LatticeVector = std::array<int64_t, 3>;

// How much is known about a vertex before it is coded.
enum class Foresight : uint8_t {
  kFlaps,      // at least one flap
  kNeighbors,  // a neighbor
  kNothing,
};

struct Expectation {
  Foresight foresight = Foresight::kNothing;
  LatticePoint point{};
  int64_t weight = 0;      // of the equations, if foresight is kFlaps; > 0
  LatticeVector normal{};  // about that of the surface there, times 2^12; zero if unknown
};

class PositionPredictor {
 public:
  // t: of a mesh in which every vertex has a triangle; must outlive the predictor.
  explicit PositionPredictor(const Topology& t);

  // The vertex to be coded next; there must be one.
  uint32_t Next();
  Expectation Expect(uint32_t vertex) const;
  void SetPoint(uint32_t vertex, const LatticePoint& point);

  bool is_known(uint32_t vertex) const { return is_known_[vertex] != 0; }
  Span<const uint32_t> neighbors(uint32_t vertex) const {
    return {neighbors_.data() + first_neighbor_[vertex], first_neighbor_[vertex + 1] - first_neighbor_[vertex]};
  }

  std::vector<LatticePoint> TakePoints() { return std::move(points_); }

 private:
  // Sums of the equations for one vertex x: weight * coefficient * (coefficient * x - target) = 0.
  struct Equations {
    LatticeVector target{};
    int64_t weight = 0;
    LatticeVector normal{};
    uint32_t num_flaps = 0, num_neighbors = 0;
  };

  // newest: the vertex of the flap that became known last.
  void UseFlap(uint32_t edge, uint32_t newest);

  const Topology& t_;
  std::vector<int32_t> turn_;  // #V, 2 cos of the mean angle around the vertex, times 256
  std::vector<uint32_t> first_neighbor_, neighbors_;
  std::vector<uint32_t> first_flap_, flaps_;  // by vertex, the flaps it is in
  std::vector<uint8_t> num_known_;            // by edge, of the vertices of the flap
  std::vector<uint8_t> is_known_;
  std::vector<LatticePoint> points_;
  std::vector<Equations> equations_;
  std::priority_queue<std::pair<int64_t, uint32_t>> queue_;  // weight, ~vertex
  uint32_t next_in_order_ = 0;
  uint32_t last_ = kNone;
};

}  // namespace lacerta

#endif  // LACERTA_COMMON_POSITION_PREDICTION_H_
