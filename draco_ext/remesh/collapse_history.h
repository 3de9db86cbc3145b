// The sequence of half-edge collapses that leads from a mesh to its coarsest base mesh, kept as a chain of 2-D charts
// so that every point of the mesh maps to every intermediate base mesh and back: the parametrization of
// [Lee et al. 1998] (MAPS), one chart per removed vertex, exact in both directions.
//
// Faces are numbered for life: those of the input first, then the ones that each collapse makes. A collapse removes vertex v
// with the ring p_0 .. p_{k-1} (counterclockwise) in favor of p_j: the k old faces (v, p_i, p_{i+1}) give way to the k - 2
// new faces (p_j, p_i, p_{i+1}), i = j+1 .. j+k-2. Both sets cover one polygon of the chart, which has v at its origin.
// A vertex on the border has k - 1 old faces, and v lies on the side p_{k-1} p_0 of the polygon; j is 0 or k - 1. A vertex on a
// crease lies on the diagonal between the two neighbors on the crease, one of which is p_j. So curves are mapped onto curves.
#ifndef LACERTA_REMESH_COLLAPSE_HISTORY_H_
#define LACERTA_REMESH_COLLAPSE_HISTORY_H_

#include <array>
#include <cstdint>
#include <vector>

#include "common/subdivision.h"
#include "lacerta/mesh.h"
#include "remesh/fan_chart.h"

namespace lacerta {

// A point on a face: weights of the face's three vertices, which sum to one.
struct DomainPoint {
  uint32_t face = kNone;
  Vec3d barycentric;
};

// The collapses that lead to one of the meshes of a history: the first `time` ones, but for those that are held back.
struct HistoryCut {
  HistoryCut(uint32_t t) : time(t) {}  // NOLINT(google-explicit-constructor): a time alone is a cut

  uint32_t time;
  std::vector<uint8_t> held;  // #time, 1 for those held back; or empty where none is

  bool Has(uint32_t collapse) const { return collapse < time && (held.empty() || held[collapse] == 0); }
};

class CollapseHistory {
 public:
  // topology: of the input mesh, with its curves.
  explicit CollapseHistory(const Topology& topology);

  // Appends a collapse. ring: #k vertices, chart: #k their chart positions, old_faces: #k with old_faces[i] = (v, p_i, p_{i+1})
  // in any rotation, one less on the border. Returns the number of the first of the k - 2 new faces.
  uint32_t Append(uint32_t removed, const std::vector<uint32_t>& ring, const std::vector<Vec2d>& chart,
                  const std::vector<uint32_t>& old_faces, int kept);

  uint32_t num_collapses() const { return static_cast<uint32_t>(collapses_.size()); }
  // How many of them leave `num_vertices` vertices; all where the coarsest mesh has more, none where the input has fewer.
  uint32_t CollapsesTo(uint32_t num_vertices) const;
  uint32_t num_faces() const { return static_cast<uint32_t>(faces_.size()); }  // of all times
  const Triangle& face(uint32_t f) const { return faces_[f]; }
  // Whether the side of a face opposite to one of its corners is an edge of a curve.
  bool is_curve(uint32_t f, int corner) const { return (curve_sides_[f] >> corner & 1) != 0; }
  CurveRole role(uint32_t input_vertex) const { return roles_[input_vertex]; }

  // The collapse that made a face, or kNone for those of the input.
  uint32_t created_by(uint32_t f) const { return created_by_[f]; }

  // The first `time` collapses without the `held` ones, nor those that build on them: a mesh that is finer in places. All others can be
  // made without them: a collapse needs the faces of its own fan alone, and edges between vertices that stay are never lost. Only the
  // number of faces at a vertex may be too small; where that breaks the manifold, nothing is held back.
  HistoryCut CutWithout(const std::vector<uint32_t>& held, uint32_t time) const;

  // Faces that exist at a cut, in increasing number.
  std::vector<uint32_t> FacesAt(const HistoryCut& cut) const;

  // The same point on a face that exists at a cut, from an earlier face.
  DomainPoint Forward(DomainPoint point, const HistoryCut& cut) const;
  // Each of them, in two thirds of the time where there are some dozens: while one waits for memory, others go on.
  void Forward(std::vector<DomainPoint>* points, const HistoryCut& cut) const;
  // The same point on a face of the input mesh, from any face.
  DomainPoint Backward(DomainPoint point) const;

 private:
  struct Collapse {
    size_t first_ring;       // into ring_positions_ and old_faces_: #k each
    uint32_t first_new_face;
    uint16_t valence;        // k
    uint16_t num_old_faces;  // k, or k - 1 on the border
    uint16_t kept;           // j
    uint32_t removed;
  };
  // How a face ends: as (v, p_spoke, p_spoke+1) of a collapse, where its corner `corner` is v. All that the walk needs of a face, in 8 bytes:
  // the walk is as fast as memory is.
  struct End {
    uint32_t collapse = kNone;  // kNone: it does not
    uint16_t spoke = 0;
    uint8_t corner = 0;
  };
  Vec2d PlaceInChart(const DomainPoint& point, const End& end) const;        // of the collapse that ends the point's face
  DomainPoint InNewFaces(const Vec2d& place, const Collapse& collapse) const;  // the point there
  DomainPoint BackwardOnce(const DomainPoint& point, const Collapse& c) const;

  std::vector<CurveRole> roles_;                     // per vertex of the input
  std::vector<Triangle> faces_;
  std::vector<uint8_t> curve_sides_;                 // per face: bit k for the side opposite to corner k
  std::vector<uint32_t> created_by_;                 // per face: collapse, or kNone
  std::vector<End> ends_;                            // per face
  std::vector<Collapse> collapses_;
  std::vector<Vec2d> ring_positions_;
  std::vector<uint32_t> old_faces_;  // kNone after the last one on the border
};

}  // namespace lacerta

#endif  // LACERTA_REMESH_COLLAPSE_HISTORY_H_
