// A base mesh as the parameter domain of the input surface: one base mesh of the collapse history, with points that move
// freely across its edges.
#ifndef LACERTA_REMESH_BASE_DOMAIN_H_
#define LACERTA_REMESH_BASE_DOMAIN_H_

#include <optional>
#include <vector>

#include "common/subdivision.h"
#include "geometry/triangle_tree.h"
#include "lacerta/mesh.h"
#include "remesh/collapse_history.h"
#include "remesh/domain_moves.h"
#include "remesh/input_surface.h"

namespace lacerta {

// A point of the domain in the chart of one base face: barycentric coordinates that go on affinely over the three faces
// across its edges, as if all four were equilateral and unfolded into the plane.
using ChartPoint = Vec3d;

// A point of the input that the tree over it has found.
inline DomainPoint InputPoint(const SurfacePoint& point) { return {point.face, {point.barycentric[0], point.barycentric[1], point.barycentric[2]}}; }

class BaseDomain {
 public:
  // The base mesh at a cut of `history`, which must outlive the domain.
  BaseDomain(const CollapseHistory& history, HistoryCut cut);

  uint32_t num_vertices() const { return static_cast<uint32_t>(input_vertex_.size()); }
  const std::vector<Triangle>& triangles() const { return triangles_; }
  // Input vertex at which a base vertex stands, or stood before it slid; kNone for those that Reorder has put in.
  uint32_t input_vertex(uint32_t v) const { return input_vertex_[v]; }
  // The collapse that made a base face, or kNone where it is one of the input's.
  uint32_t created_by(uint32_t f) const { return history_.created_by(history_face_[first_face_[f]]); }
  // With creases and corners, and with joined borders after Join.
  const Topology& topology() const { return topology_; }
  // Positions of the base vertices on the input; the origin for those that Reorder has put in.
  std::vector<Vec3f> PositionsOn(const TriangleMesh& input) const;
  const BaseTags& tags() const { return tags_; }

  // Renumbers vertices and faces: vertex_map[v] is the present number of the vertex that will be v, and `triangles` (in new
  // numbers) gives the new order and rotation of the faces. Numbers from num_vertices() on stand for vertices that are not of the
  // domain: they become isolated ones.
  void Reorder(const std::vector<uint32_t>& vertex_map, const std::vector<Triangle>& triangles);

  // Joins the borders of a cut (BaseTags::joined): finer levels number the vertices of joined borders differently, so this has to be
  // known before anything is refined. After Reorder, which forgets it. joined: #V0.
  void Join(std::vector<uint32_t> joined);

  // Vertices slide to points of the input (face kNone: those that stay), where the domain lets them (DomainMoves). Before Reorder. to: #V0; positions: #V0, where they stand.
  void Slide(const std::vector<DomainPoint>& to, const std::vector<Vec3f>& positions);
  // Turns edges without a face in common where the domain lets them (DomainMoves), and where no other edge joins the same vertices already. Before Reorder. positions: #V0, where vertices stand. Returns how many.
  size_t Flip(const std::vector<uint32_t>& edges, const std::vector<Vec3f>& positions);
  // The point of the input at which a base vertex stands if it has slid there, else face kNone.
  const DomainPoint& slid_to(uint32_t v) const { return slid_to_[v]; }

  // Point of the domain (face: base face) of a point on a face of the input, and back.
  DomainPoint FromInput(const DomainPoint& on_input) const;
  void FromInput(std::vector<DomainPoint>* points) const;  // each of them, which takes less time than one after the other
  DomainPoint ToInput(const DomainPoint& point) const;

  // The chart coordinates of a domain point around base face `center`; none where it lies beyond the neighboring faces.
  std::optional<ChartPoint> ToChart(uint32_t center, const DomainPoint& point) const;
  // The inverse; none where the chart point lies outside of the four faces.
  std::optional<DomainPoint> FromChart(uint32_t center, const ChartPoint& point) const;

 private:
  DomainPoint OnFirstFace(const DomainPoint& on_history_face) const { return {face_of_history_[on_history_face.face], on_history_face.barycentric}; }
  DomainPoint OnBaseFace(const DomainPoint& on_first_face) const;
  void BuildTables();
  BaseTags FindTags() const;

  const CollapseHistory& history_;
  HistoryCut cut_;
  std::vector<Triangle> triangles_;          // #F0 base vertices
  std::vector<uint32_t> input_vertex_;       // #V0
  std::vector<uint8_t> curve_sides_;         // #F0, bit k for the side opposite to corner k
  std::vector<uint32_t> history_face_;       // #F0, in the first order
  std::vector<uint32_t> face_of_history_;    // the inverse, or kNone
  DomainMoves moves_;                        // of faces in the first order
  std::vector<uint32_t> first_face_;         // #F0: number in the first order
  std::vector<uint32_t> base_face_;          // the inverse
  std::vector<uint8_t> rotation_;            // corner of the face in the first order at corner 0 of the base face
  BaseTags tags_;
  Topology topology_;
  std::vector<DomainPoint> slid_to_;         // #V0
};

// The input's normal where a base vertex stands, which is no isolated one.
inline Vec3f NormalAtBase(const InputSurface& surface, const BaseDomain& domain, uint32_t v) {
  const DomainPoint& slid_to = domain.slid_to(v);
  return slid_to.face != kNone ? surface.NormalAt(slid_to.face, slid_to.barycentric) : surface.vertex_normal(domain.input_vertex(v));
}

}  // namespace lacerta

#endif  // LACERTA_REMESH_BASE_DOMAIN_H_
