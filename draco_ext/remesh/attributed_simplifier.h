// The run behind AttributedSimplification.
#ifndef LACERTA_REMESH_ATTRIBUTED_SIMPLIFIER_H_
#define LACERTA_REMESH_ATTRIBUTED_SIMPLIFIER_H_

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "remesh/attribute_quadrics.h"
#include "remesh/attributed_simplify.h"
#include "remesh/collapse_queue.h"
#include "remesh/corner_rings.h"
#include "remesh/deviation_bound.h"
#include "remesh/placement.h"

namespace lacerta {

class AttributedSimplifier {
 public:
  AttributedSimplifier(const AttributedMesh& input, const WedgeMesh& start, const std::vector<double>& weights, const SimplificationBounds& bounds,
                       AttributedSimplification* sequence);
  void Run();

 private:
  struct Candidate {
    float cost;
    uint32_t u, v;
    uint32_t version;                           // of both ends; when an end has changed since, the entry is void
    bool operator<(const Candidate& b) const {  // for a heap with the cheapest on top
      if (cost != b.cost) return cost > b.cost;
      return u != b.u ? u > b.u : v > b.v;
    }
  };

  // One attribute while vertices come together. Values are scaled to be compared with distances.
  struct Channel {
    Channel(const MeshAttribute& attribute, const AttributeNodes& nodes, double weight, uint32_t num_vertices);

    bool is_texture, is_normal;
    double scale;
    std::vector<Triangle> nodes;           // of the corners, kept up to date
    std::vector<uint32_t> node_of_vertex;  // of vertices where there is only one
    std::vector<double> values;            // of the nodes
    AttributeQuadrics quadrics;
  };

  // Nodes that become one at the vertex that remains.
  struct NodeGroup {
    uint32_t channel;
    uint32_t first, count;  // of group_members_
    size_t value;           // where in new_values_
  };

  struct Planes {
    Quadric surface, curves;
  };

  // Of a triangle at an edge: its third vertex, and how many of the two edges there are on curves.
  struct Tip {
    uint32_t vertex = 0;
    int num_curves = 0;
  };

  void RememberPlanes();
  void FindQuadrics(uint32_t v);
  Planes PlanesAround(uint32_t v) const;
  void PushAll();
  void Push(uint32_t u, uint32_t v);
  std::vector<uint32_t> NeighborsOf(uint32_t v);

  bool MayCollapse(uint32_t u, uint32_t v);
  bool IsCurve(uint32_t u, uint32_t v, const std::vector<uint32_t>& corners_u) const;
  bool KeepsTopology(uint32_t u, uint32_t v);
  Tip TipOf(uint32_t triangle, uint32_t u, uint32_t v) const;
  bool HasNeighborOfGroup(uint32_t triangle, uint32_t u, uint32_t v, uint32_t tip) const;
  bool MayJoinCurves(uint32_t u, uint32_t v, const Vec3d& position) const;
  bool StaysNear(uint32_t u, uint32_t v, const Vec3d& position);
  void GatherNodes(uint32_t u, uint32_t v);
  void SumNodes();
  Placement Place(uint32_t u, uint32_t v);
  void FindValues(const Vec3d& position);
  bool AnyTurnsOver(uint32_t moved, uint32_t other, const std::vector<uint32_t>& corners, const Vec3d& to) const;
  bool AnyTextureTurnsOver(uint32_t other, const std::vector<uint32_t>& corners) const;
  bool AnyTurnsFromNormals(uint32_t moved, uint32_t other, const std::vector<uint32_t>& corners, const Vec3d& to) const;
  // Whether the value at a corner of the moved or the removed vertex is among those that the group's new value takes the place of.
  bool IsOfGroup(const NodeGroup& group, uint32_t corner) const;
  void Collapse(uint32_t kept, uint32_t removed, const Vec3d& position);
  void JoinEdges(uint32_t kept, uint32_t removed);
  void JoinNodes();

  bool Has(uint32_t triangle, uint32_t v) const {
    const Triangle& t = triangles_[triangle];
    return t[0] == v || t[1] == v || t[2] == v;
  }
  bool IsVoid(const Candidate& c) const {
    return c.version != version_[c.u] + version_[c.v] || rings_.is_empty(c.u) || rings_.is_empty(c.v);
  }

  const AttributedMesh& input_;
  const WedgeMesh& start_;
  AttributedSimplification* const sequence_;
  Vec3d center_;
  double scale_ = 1;
  std::vector<Vec3d> positions_;  // centered and scaled to unit size: quadrics lose their digits far from the origin
  std::vector<Triangle> triangles_;
  std::vector<uint8_t> dead_, curve_edges_;  // per triangle
  std::vector<VertexFreedom> freedom_;
  std::vector<Quadric> remembered_;  // per vertex: planes of the input, of all vertices that came together in it
  std::vector<Quadric> quadrics_;    // with those of its triangles and curves as they are now
  std::vector<Channel> channels_;
  CornerRings rings_;
  std::vector<uint32_t> version_, mark_, valence_;
  uint32_t last_mark_ = 0;
  uint32_t num_alive_ = 0;
  double edge_weight_ = 0;
  double most_squared_ = 0;  // squared distance from its planes that a vertex may have where curves join
  std::optional<DeviationBound> deviation_;
  CollapseQueue<Candidate> queue_;

  // Of the edge that is looked at.
  std::vector<uint32_t> corners_u_, corners_v_, around_;
  std::vector<DeviationBound::Face> faces_;
  std::vector<NodeGroup> groups_;
  std::vector<uint32_t> group_members_;
  std::vector<double> sums_;        // rows of the groups, one after the other
  std::vector<double> new_values_;  // of the groups
};

}  // namespace lacerta

#endif  // LACERTA_REMESH_ATTRIBUTED_SIMPLIFIER_H_
