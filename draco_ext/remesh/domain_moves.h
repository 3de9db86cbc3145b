// Vertices of a base mesh that move within the triangles around them, and edges that turn, and take the domain with them.
#ifndef LACERTA_REMESH_DOMAIN_MOVES_H_
#define LACERTA_REMESH_DOMAIN_MOVES_H_

#include <array>
#include <cstdint>
#include <vector>

#include "common/subdivision.h"
#include "lacerta/mesh.h"
#include "remesh/collapse_history.h"
#include "remesh/fan_chart.h"

namespace lacerta {

// A map of the domain onto itself, made of moves, each of which covers a polygon of some faces anew: flattened, it is cut into as many other triangles, and what lies at a point of the
// polygon lies in another of them from then on. All beyond its outline stays where it is.
class DomainMoves {
 public:
  DomainMoves() = default;  // none yet
  explicit DomainMoves(size_t num_faces) : moves_of_face_(num_faces) {}

  // The vertex v goes to where the point `to` of the domain lies after the moves so far: the triangles around it are flattened as for a collapse [Lee et al. 1998], and it stands at
  // another point of the polygon. topology: of the base; positions: #V, which the triangles are flattened by. Changes nothing and returns false where the point is in no triangle around
  // v, where one of these would be turned over or nearly so, and on a border.
  bool Slide(uint32_t v, const DomainPoint& to, const Topology& topology, const std::vector<Vec3d>& positions);

  // The edge of two faces turns: where f was (c, a, b) and g was (d, b, a), from whichever corner on, f is (c, a, d) and g is (d, b, c) from then on. Changes nothing and returns false on a
  // border, and where the faces, unfolded into a plane, are no convex quadrangle or nearly so.
  bool Flip(uint32_t edge, const Topology& topology, const std::vector<Vec3d>& positions);

  // Where a point of the domain lies after all moves; and before them, of one that lies there after them.
  DomainPoint Forward(DomainPoint point) const;
  DomainPoint Backward(DomainPoint point) const;

 private:
  using Corners = std::array<Vec2d, 3>;
  struct Move {
    std::vector<uint32_t> faces;
    std::vector<Corners> before, after;  // of each face, in the chart
  };
  void Append(Move move);
  static DomainPoint Moved(const DomainPoint& point, const std::vector<uint32_t>& faces, const std::vector<Corners>& from, const std::vector<Corners>& to);

  std::vector<Move> moves_;
  std::vector<std::vector<uint32_t>> moves_of_face_;  // in ascending order
};

}  // namespace lacerta

#endif  // LACERTA_REMESH_DOMAIN_MOVES_H_
