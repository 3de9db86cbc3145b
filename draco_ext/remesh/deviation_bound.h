// How far a surface goes from what it was while its triangles change: error control of simplification by the Hausdorff distance of samples
// [Klein, Liebich, Strasser 1996, "Mesh reduction with error control"]. Quadrics know the mean over an area alone, in which a tab is nothing.
#ifndef LACERTA_REMESH_DEVIATION_BOUND_H_
#define LACERTA_REMESH_DEVIATION_BOUND_H_

#include <array>
#include <cstdint>
#include <vector>

#include "geometry/triangle_tree.h"
#include "lacerta/mesh.h"
#include "lacerta/vec3.h"

namespace lacerta {

class DeviationBound {
 public:
  // A triangle around the vertex that an edge collapses to.
  struct Face {
    uint32_t triangle;
    bool remains;
    Vec3d a, b;  // its other corners
  };

  // positions: #V, within TriangleTree::kMaxCoordinate. groups: #F, of the triangles; what was in one has to stay near triangles of the same one.
  // farthest: units of the positions, > 0.
  DeviationBound(const std::vector<Vec3d>& positions, const std::vector<Triangle>& triangles, std::vector<uint32_t> groups, double farthest);

  // Whether the surface stays within the bound where an edge collapses to that place, and the triangles around it become these. What was on them has to
  // be near what remains of them, and points of large ones near the surface as it was.
  bool Allows(const Vec3d& to, const std::vector<Face>& faces);
  // Makes what the last call of Allows was asked for the state, where that said yes.
  void Accept();

 private:
  static constexpr uint32_t kNone = ~uint32_t{0};
  struct Place {
    uint32_t sample, triangle;
  };

  uint32_t StepsAlong(const std::array<Vec3d, 3>& corners) const;
  void Add(const Vec3d& sample, uint32_t triangle);
  uint32_t NearestOf(const Vec3d& to, const std::vector<Face>& faces, uint32_t own, const Vec3d& sample) const;
  bool IsNearOriginal(const Vec3d& point) const;
  bool AreNearOriginal(const Vec3d& to, const std::vector<Face>& faces) const;

  std::vector<uint32_t> groups_;
  double farthest_;
  TriangleTree original_;
  std::vector<Vec3d> samples_;          // of the original
  std::vector<uint32_t> first_, next_;  // of each triangle its first sample, of each sample the next on its triangle
  std::vector<uint32_t> changed_;       // triangles that the last call asked for
  std::vector<Place> places_;           // where it found their samples
};

}  // namespace lacerta

#endif  // LACERTA_REMESH_DEVIATION_BOUND_H_
