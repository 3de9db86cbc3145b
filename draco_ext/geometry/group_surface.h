// A surface with attributes, ready to be sampled and to be asked for closest points group by group.
#ifndef LACERTA_GEOMETRY_GROUP_SURFACE_H_
#define LACERTA_GEOMETRY_GROUP_SURFACE_H_

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <vector>

#include "geometry/triangle_tree.h"
#include "lacerta/attributed_mesh.h"

namespace lacerta {

class GroupSurface {
 public:
  struct Point {
    uint32_t face = 0;
    std::array<float, 3> barycentric{};
    float squared_distance = 0;
    Vec3f position;
  };

  static constexpr size_t kMostNear = 49;  // points that PointsNear gives, the nearest: more faces are not told apart, so that the work is bounded

  // mesh: one that CheckAttributedMesh accepts; must outlive the surface.
  explicit GroupSurface(const AttributedMesh& mesh);

  const AttributedMesh& mesh() const { return mesh_; }
  bool HasArea(uint32_t group) const;
  Vec3d NormalOf(uint32_t face) const;  // unit; zero for a degenerate face

  struct Nearness {
    bool agrees = false;         // a face near looks the way that was asked for
    float squared_distance = 0;  // of the closest point, whichever way its face looks; 0 where there is none
    // Along the normal, of the nearest face that looks back (more than 120 degrees off) above the nearest that looks the way asked for. Nothing where
    // one is missing.
    std::optional<double> height_of_back;
  };

  // The points of the group's faces that are closest to p: one per face, of the faces up to `beyond` farther than the closest one, and
  // of those only that look the way of `normal` unless none does. The nearest comes first; none where the group has no face. *hint is a
  // face that may be near, and becomes the closest one.
  Nearness PointsNear(uint32_t group, const Vec3f& p, const Vec3d& normal, double beyond, uint32_t* hint, std::vector<Point>* points) const;

  // Of what PointsNear gave, leaves the first one on each side of the attribute's seams. Faces are on one side where a chain of them
  // leads from one to the other in which they share a vertex and its value.
  void KeepOnePerSide(const MeshAttribute& attribute, std::vector<Point>* points) const;
  // Whether that leaves the same points for each attribute, for there is no seam of any at the faces.
  bool AreSidesOfAllAttributes(const std::vector<Point>& points) const;

  // The triangles, groups one after the other and neighbours mostly, too: for SurfaceSampler.
  const std::vector<TriangleTree::Corners>& corners() const { return corners_; }
  const std::vector<double>& cumulated_area() const { return cumulated_area_; }
  uint32_t face_of_slot(size_t slot) const { return faces_[slot]; }

 private:
  struct Group {
    TriangleTree tree;
    std::vector<uint32_t> faces;  // of the mesh, for each face of the tree
    double area = 0;
  };

  const AttributedMesh& mesh_;
  std::map<uint32_t, Group> groups_;
  std::vector<uint32_t> place_;  // of each face in its group's list
  std::vector<bool> has_seam_;   // of each vertex: not all of its corners have the same value of each attribute
  std::vector<TriangleTree::Corners> corners_;
  std::vector<uint32_t> faces_;
  std::vector<double> cumulated_area_;
};

// The interpolated value at a point; value: attribute.components numbers.
void InterpolateValue(const MeshAttribute& attribute, const GroupSurface::Point& point, double* value);

}  // namespace lacerta

#endif  // LACERTA_GEOMETRY_GROUP_SURFACE_H_
