// Simplification of a surface with attributes: edge collapses in order of quadric errors of position and attributes [Garland, Heckbert
// 1998; Hoppe 1999], recorded so that the surface can be had at every size from one run.
#ifndef LACERTA_REMESH_ATTRIBUTED_SIMPLIFY_H_
#define LACERTA_REMESH_ATTRIBUTED_SIMPLIFY_H_

#include <cstdint>
#include <vector>

#include "lacerta/attributed_mesh.h"
#include "remesh/wedge_mesh.h"

namespace lacerta {

// How far the surface may go from the input, in mesh units.
struct SimplificationBounds {
  double charts = 0;    // where a chart vanishes (below): vertices from the planes that they stand for, RMS; 0: charts stay
  double anywhere = 0;  // any point of either surface from the other, as far as samples tell (deviation_bound.h); 0: no bound
};

class AttributedSimplification {
 public:
  // input: one that CheckAttributedMesh accepts. weights: for each attribute, the distance relative to the bounding box's
  // diagonal that is as bad an error as one unit of the attribute; >= 0. held: for each vertex 1 where nothing may change, else 0; empty: none.
  //
  // Curves (seams, borders of groups, open borders; wedge_mesh.h) stay what they are: a vertex on one comes together only with its
  // neighbors along it; where the surface had to be cut, vertices stand still. Curves meet where the last triangle between them goes, as of a
  // chart that is only one triangle wide, if a neighbor of its group takes its place. A vertex that remains goes to where the errors are
  // least, with the values that are best there; a collapse that turns a triangle over, in space or in the texture, is not made, nor one that
  // changes the topology.
  // Deterministic; O(n log n).
  AttributedSimplification(AttributedMesh input, const std::vector<double>& weights, const std::vector<uint8_t>& held = {},
                           const SimplificationBounds& bounds = {});

  uint32_t num_input_triangles() const { return static_cast<uint32_t>(start_.mesh.triangles.size()); }
  // Of the coarsest surface: no collapse is possible any more.
  uint32_t fewest_triangles() const { return collapses_.empty() ? num_input_triangles() : collapses_.back().num_triangles; }

  // The surface of at most `num_triangles`, but not fewer than fewest_triangles(), after as few collapses as possible; welded, with the
  // groups and attributes of the input. Directions have unit length, weights add up to 1, colors are in the range of the input's.
  AttributedMesh MeshWith(uint32_t num_triangles) const;

 private:
  friend class AttributedSimplifier;
  struct Collapse {
    uint32_t removed, kept;
    Vec3f position;          // of `kept` from then on
    uint32_t num_triangles;  // that remain
  };
  struct NodeMerge {
    uint32_t removed, kept;
    uint32_t num_collapses;  // with which it happened
  };
  struct NodeValue {
    uint32_t node;
    uint32_t num_collapses;
  };
  struct NodeHistory {
    std::vector<NodeMerge> merges;
    std::vector<NodeValue> moves;
    std::vector<float> values;  // of the moves, row after row
  };

  void WriteValues(size_t num_collapses, const NodeHistory& history, const AttributeNodes& nodes, const MeshAttribute& input,
                   MeshAttribute* output, std::vector<uint32_t>* becomes) const;

  AttributedMesh input_;
  WedgeMesh start_;
  std::vector<Collapse> collapses_;
  std::vector<NodeHistory> histories_;  // of each attribute
};

}  // namespace lacerta

#endif  // LACERTA_REMESH_ATTRIBUTED_SIMPLIFY_H_
