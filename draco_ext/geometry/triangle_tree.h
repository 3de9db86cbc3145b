// Closest points and line hits on a triangle mesh through a bounding volume hierarchy.
#ifndef LACERTA_GEOMETRY_TRIANGLE_TREE_H_
#define LACERTA_GEOMETRY_TRIANGLE_TREE_H_

#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "lacerta/mesh.h"

namespace lacerta {

// A point on a face of the mesh: barycentric[k] belongs to corner k of the face; they are >= 0 and add up to 1.
struct SurfacePoint {
  static constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();
  uint32_t face = kNone;  // index into TriangleMesh::triangles; kNone: there is no such point
  std::array<float, 3> barycentric{};
  Vec3f position;
};

struct ClosestPointResult {
  SurfacePoint point;
  float squared_distance = std::numeric_limits<float>::infinity();
};

struct LineHit {
  SurfacePoint point;  // position = origin + t * direction
  float t = 0.0f;      // in lengths of the direction
};

// A hierarchy of axis-aligned boxes, four to a node, split by the binned surface area heuristic [Wald 2007]. Queries
// are const, need no memory of their own and may run in many threads at once. Where the faces are in the order of
// subdivision, the smallest boxes are those of two levels of it, and the tree is built in a tenth of the time.
//
// The tree copies the triangles, so the mesh may go away. Faces that no query can meet are left out: an index out of
// range, or a coordinate that is not finite or beyond kMaxCoordinate. Degenerate faces stay: they are the segment or
// point that they look like to ClosestPoint, and invisible to IntersectLine.
class TriangleTree {
 public:
  using Corners = std::array<Vec3f, 3>;

  // Squares of larger coordinates would leave the range of float.
  static constexpr float kMaxCoordinate = 1e18f;
  static bool IsUsable(const Vec3f& p) {  // written so that NaN is refused
    return std::fabs(p.x) <= kMaxCoordinate && std::fabs(p.y) <= kMaxCoordinate && std::fabs(p.z) <= kMaxCoordinate;
  }

  explicit TriangleTree(const TriangleMesh& mesh);

  // The point of the mesh closest to p and not farther than max_squared_distance from it; face == kNone where there is
  // none, or where p is not finite or beyond kMaxCoordinate. Distances are computed in double. Of several closest
  // points, on a shared edge say, any may be returned, but the same call returns the same one.
  ClosestPointResult ClosestPoint(const Vec3f& p,
                                  float max_squared_distance = std::numeric_limits<float>::infinity()) const;

  // ClosestPoint without a limit. `hint` is a face thought to be near p, such as the one found for a neighbour of p: its
  // distance bounds the search from the start. It may be any number: what is no face of the tree is no hint.
  ClosestPointResult ClosestPointNear(const Vec3f& p, uint32_t hint) const;

  // Whether ClosestPoint finds one, in less time where there are many.
  bool IsNear(const Vec3f& p, float max_squared_distance) const;

  // Appends to *points for each face not farther from p than max_squared_distance its point closest to p, the nearest first, of equal ones
  // that of the lower face; but for no more than `max_points` faces: the nearest where there are more.
  void PointsNear(const Vec3f& p, float max_squared_distance, size_t max_points, std::vector<ClosestPointResult>* points) const;

  // Appends to *hits, in no particular order, where the line origin + t * direction meets the mesh with t_min <= t <=
  // t_max, whichever way the faces look. Watertight [Woop et al. 2013]: a line through a shared edge or vertex hits at
  // least one, and possibly all, of the faces there. Faces parallel to the line are not hit. direction: not zero, of
  // any length; else nothing is appended, nor where a number is not finite (t_min and t_max may be infinite).
  void IntersectLine(const Vec3f& origin, const Vec3f& direction, float t_min, float t_max,
                     std::vector<LineHit>* hits) const;

  // The number of faces in leaves whose boxes hold a point of the mesh, in the mean of some hundred points: what a query near the
  // surface has to look at. Ten or so for a surface, however large; of triangles that go through each other a share of all of them.
  double Crowding() const;

  // The faces, without those left out, in an order in which neighbours in the list are mostly neighbours in space.
  const std::vector<uint32_t>& faces_in_tree_order() const { return faces_; }
  // The corners of those faces.
  const std::vector<Corners>& corners_in_tree_order() const { return corners_; }

 private:
  static constexpr int kWidth = 4;  // children of a node
  static constexpr uint32_t kLeafSize = 4;
  // From this depth on ranges are halved, which bounds the depth: the stack of a query never overflows.
  static constexpr int kMaxHeuristicDepth = 24;
  // Halving 2^32 faces twice per level ends after 16 more; each level leaves at most three children waiting.
  static constexpr int kStackSize = 3 * (kMaxHeuristicDepth + 17);

  // Boxes of the children as structure of arrays and by center and half size, so that the compiler tests four at once; relative to
  // the origin of the tree.
  struct alignas(64) Node {
    float center[3][kWidth];
    float half_size[3][kWidth];  // negative in a missing child
    uint32_t child[kWidth];      // a node, or the first slot of a leaf
    uint32_t count[kWidth];      // 0: a node, else the number of triangles in the leaf

    // Of a point, relative to the origin of the tree, to all four boxes; 0 inside.
    void SquaredDistances(const Vec3f& point, float (&d2)[kWidth]) const {
      const float px = point.x, py = point.y, pz = point.z;
      for (int k = 0; k < kWidth; ++k) {
        const float x = std::fabs(center[0][k] - px) - half_size[0][k];
        const float y = std::fabs(center[1][k] - py) - half_size[1][k];
        const float z = std::fabs(center[2][k] - pz) - half_size[2][k];
        // v + |v| is twice max(v, 0), without a branch.
        const float x2 = x + std::fabs(x), y2 = y + std::fabs(y), z2 = z + std::fabs(z);
        d2[k] = 0.25f * (x2 * x2 + y2 * y2 + z2 * z2);
      }
    }
  };
  struct Reference;  // a face, or some that stay together, while the tree is built
  struct Building;
  struct Search;     // what a closest point query has found so far

  uint32_t BuildNode(const Building& building, Reference* first, Reference* last, int depth, std::vector<Node>* nodes) const;
  Node GroupNode(const TriangleMesh& mesh, uint32_t first_face, uint32_t first_slot) const;
  // Whether LowerBounds, which reads four triangles in a row, is to be asked of a leaf: an exact look at one alone takes no longer.
  bool AreWorthBounds(uint32_t first, uint32_t count) const { return count > 1 && first + kLeafSize <= corners_.size(); }
  void LowerBounds(uint32_t first, const Vec3f& point, std::array<float, kLeafSize>* bounds) const;
  void TestLeaf(uint32_t first, uint32_t count, Search* search) const;  // count: at most kLeafSize
  void TestSlot(uint32_t slot, Search* search) const;
  ClosestPointResult Finish(const Search& search) const;
  void Traverse(Search* search) const;
  // Calls visit(first slot, count) for the leaves whose boxes are less than that far from a point, relative to the origin of the tree, nearer ones
  // mostly first. What visit makes of the distance is heeded at once.
  template <typename Visit>
  void VisitLeaves(const Vec3f& point, const float& max_squared_distance, const Visit& visit) const;

  std::vector<Node> nodes_;       // the first is the root; empty when there is no triangle
  std::vector<Corners> corners_;  // per slot
  std::vector<uint32_t> faces_;   // per slot
  std::vector<uint32_t> slots_;   // per face of the mesh; kNone for those left out
  // The middle of the mesh: boxes relative to it are tight however far the mesh is from zero.
  Vec3f origin_;
  float scale_ = 1.0f;    // a power of two, by which the largest coordinate from there is near a thousand
  float padding_ = 0.0f;  // by which every box is larger than what it holds: a few ulps of the largest coordinate in it
};

}  // namespace lacerta

#endif  // LACERTA_GEOMETRY_TRIANGLE_TREE_H_
