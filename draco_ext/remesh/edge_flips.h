// Edges of a simplified mesh turned to the other diagonal of their two triangles where that is worth it.
#ifndef LACERTA_REMESH_EDGE_FLIPS_H_
#define LACERTA_REMESH_EDGE_FLIPS_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "lacerta/mesh.h"
#include "remesh/distance_model.h"
#include "remesh/mesh_fit.h"

namespace lacerta {

// Turns edges of one mesh.
class EdgeFlipper {
 public:
  // mesh: no triangle with a repeated vertex. Both must outlive this.
  EdgeFlipper(const FitTarget& target, TriangleMesh* mesh);

  // Squared distance d_S of the mesh to the input, model units, by the target's samples and a few on each triangle: up to a third more than
  // FitTarget::DistortionAt, since these lie off its corners, and at no cost.
  double Distortion() const;

  // Turns edges ("edge swap" [Hoppe et al. 1993, section 4.2]) where that lowers the distance to the input, or the bits of `rate` and of the connectivity for little
  // of it; vertices stay where they are. In a few passes, each of those that gain most and share no triangle. Edges of more or fewer than two triangles, or of two that
  // are oriented against each other, stay, and so do those whose new triangles would look away from the old ones or whose new ends have an edge in common.
  // Returns how many were turned. Runs on all cores; the same on any number of them.
  size_t Flip(const RateModel& rate);

 private:
  // How far a triangle of the mesh is from the input.
  struct FaceDistance {
    double mean_square = 0;
    uint32_t near = SurfacePoint::kNone;  // a face of the input there
  };
  struct Edge;
  struct Turn;
  class Meter;

  FaceDistance DistanceOf(uint32_t face, uint32_t hint) const;
  std::vector<Turn> FindTurns(const RateModel& rate, const std::vector<uint8_t>& is_marked) const;
  void GiveHits(const std::vector<uint32_t>& turned_with);

  const FitTarget& target_;
  TriangleMesh& mesh_;
  std::vector<FaceDistance> distances_;  // of the mesh's faces
  std::vector<FitTarget::Hit> hits_;     // of the input's samples on them
};

}  // namespace lacerta

#endif  // LACERTA_REMESH_EDGE_FLIPS_H_
