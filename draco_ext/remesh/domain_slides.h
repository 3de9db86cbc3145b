// Vertices of a base mesh that move within the triangles around them, and take the domain with them.
#ifndef LACERTA_REMESH_DOMAIN_SLIDES_H_
#define LACERTA_REMESH_DOMAIN_SLIDES_H_

#include <cstdint>
#include <vector>

#include "common/subdivision.h"
#include "lacerta/mesh.h"
#include "remesh/collapse_history.h"
#include "remesh/fan_chart.h"

namespace lacerta {

// A map of the domain onto itself, made of moves of one vertex each: the triangles around it are flattened as for a collapse [Lee et al. 1998], the vertex goes to
// another point of the polygon, and what lay there lies at the vertex from then on. All beyond the outline stays where it is.
class DomainSlides {
 public:
  // None yet. topology: of the base.
  explicit DomainSlides(const Topology& topology);

  // The vertex v goes to where the point `to` of the domain lies after the moves so far. In ascending order of vertices. topology: of the base; positions: #V, which
  // the triangles are flattened by. Changes nothing and returns false where the point is in no triangle around v, where one of these would be turned over or nearly
  // so, and on a border.
  bool Move(uint32_t v, const DomainPoint& to, const Topology& topology, const std::vector<Vec3d>& positions);

  // Where a point of the domain lies after all moves; and before them, of one that lies there after them.
  DomainPoint Forward(DomainPoint point) const;
  DomainPoint Backward(DomainPoint point) const;

 private:
  struct Star {
    Fan fan;                       // none of a vertex that has not moved
    std::vector<uint8_t> corners;  // of each face, where the vertex is
    std::vector<Vec2d> chart;      // of the ring, around where the vertex was
    Vec2d center;                  // where it is now
  };
  static Vec2d Place(const Star& star, const DomainPoint& point, const Vec2d& center);
  static DomainPoint At(const Star& star, const Vec2d& place, const Vec2d& center);
  bool has_moved(uint32_t v) const { return !stars_[v].fan.faces.empty(); }

  std::vector<Triangle> triangles_;
  std::vector<uint32_t> first_face_;  // of each vertex, or kNone
  std::vector<Star> stars_;           // of each vertex
};

}  // namespace lacerta

#endif  // LACERTA_REMESH_DOMAIN_SLIDES_H_
