// Closest points on a mesh of many millions of triangles, in little memory.
#ifndef LACERTA_GEOMETRY_LEAN_TREE_H_
#define LACERTA_GEOMETRY_LEAN_TREE_H_

#include <cstdint>
#include <limits>
#include <utility>
#include <vector>

#include "geometry/bounding_box.h"
#include "lacerta/mesh.h"

namespace lacerta {

// A hierarchy of boxes over the triangles of a mesh that stays where it is: 6 to 12 bytes a triangle beside it, 12 to 16 while it is built, where
// TriangleTree takes 83. It is balanced, so that neither ranges nor children have to be stored, and has no copy of the triangles: queries
// take two to three times as long. Only distances are asked of it.
//
// Queries are const, need no memory of their own and may run in many threads at once. The tree does not depend on the number of threads.
class LeanTree {
 public:
  static constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();

  // mesh: at least one triangle, indices in range, used coordinates within TriangleTree::kMaxCoordinate. Has to outlive the tree.
  explicit LeanTree(const TriangleMesh& mesh);
  explicit LeanTree(TriangleMesh&&) = delete;

  // Squared distance of p, finite, to the mesh, computed in double. *hint: a face thought to be near p, or kNone; becomes the closest one.
  double SquaredDistance(const Vec3f& p, uint32_t* hint) const;

  // The number of faces whose boxes hold the middle of a face, in the mean of some hundred: one or two for a surface, however large; of triangles that go
  // through each other a share of all of them.
  double Crowding() const;

  // All faces, in an order in which neighbors in the list are mostly neighbors in space.
  const std::vector<uint32_t>& faces_in_tree_order() const { return faces_; }
  const TriangleMesh& mesh() const { return mesh_; }

 private:
  static constexpr uint32_t kWidth = 4;        // children of a node
  static constexpr uint32_t kLargestLeaf = 16;  // of more than a quarter of that, as all have the same depth
  // Node n has the children 4 n + 1 to 4 n + 4; the children of the deepest nodes are leaves. Boxes relative to the origin, by axis.
  struct Node {
    float low[3][kWidth], high[3][kWidth];
  };
  struct Range {
    uint32_t first, last;  // slots of faces_
  };
  struct Entry {  // of the stack of a query
    float squared_distance;
    uint32_t node;
    Range range;
    int depth;
  };
  // Each of at most 15 levels leaves three children waiting.
  static constexpr size_t kStackSize = 3 * 15 + 2;
  struct KeyedFace;
  struct Search;

  static Range ChildOf(Range range, uint32_t k);
  void Sort(KeyedFace* faces, size_t count, int depth) const;
  BoundingBox FillNode(uint32_t node, Range range, int depth);
  void TestFace(uint32_t face, Search* search) const;
  uint64_t NumFacesAround(const Vec3f& point) const;

  const TriangleMesh& mesh_;
  Vec3f origin_;         // the middle of the mesh: boxes relative to it are tight however far the mesh is from zero
  float padding_ = 0;    // by which every box is larger than what it holds: a few ulps of the largest coordinate in it
  int depth_ = 0;        // of nodes; 0: all faces are one leaf
  std::vector<uint32_t> faces_;
  std::vector<Node> nodes_;
};

}  // namespace lacerta

#endif  // LACERTA_GEOMETRY_LEAN_TREE_H_
