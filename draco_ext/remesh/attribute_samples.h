// Points of a mesh, and where on the original each is compared: what a fit of attributes goes by.
#ifndef LACERTA_REMESH_ATTRIBUTE_SAMPLES_H_
#define LACERTA_REMESH_ATTRIBUTE_SAMPLES_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "geometry/group_surface.h"
#include "lacerta/attributed_mesh.h"

namespace lacerta {

// There are three samples and more on every triangle: they are most of the memory of a fit.
class AttributeSamples {
 public:
  struct Sample {
    uint32_t face;
    std::array<float, 3> weights;
    GroupSurface::Point closest;  // its face is MeshAttribute::kNoValue where there is none
    uint32_t across;              // which of the AcrossSeams of its block, or none: no attribute has more than one side
  };

  // num_samples: so many on `mesh`, by area, and at least three on every triangle that has some. seam_distance: within which seams of the original are
  // looked across, model units. mesh has the attributes and groups of `original`.
  AttributeSamples(const AttributedMesh& mesh, const GroupSurface& original, size_t num_samples, double seam_distance);

  size_t size() const { return samples_.size(); }
  const Sample& operator[](size_t i) const { return samples_[i]; }
  // Of the area, what sample i stands for.
  double ShareOf(size_t i) const { return shares_[samples_[i].face]; }
  // Calls visit(point) for the points of the original that stand for the sides of an attribute at sample i, the nearest first.
  template <typename Visit>
  void ForEachSide(size_t i, size_t attribute, const Visit& visit) const {
    const Seam* const seam = SeamAt(i, attribute);
    if (seam == nullptr) return visit(samples_[i].closest);
    const std::vector<GroupSurface::Point>& points = AcrossAt(i).points;
    for (size_t k = 0; k < points.size(); ++k) {
      if ((seam->points >> k & 1) != 0) visit(points[k]);
    }
  }

 private:
  static constexpr size_t kBlockSize = 1024;
  static constexpr uint32_t kNoSeam = std::numeric_limits<uint32_t>::max();

  // An attribute with more than one side at a sample, and which of the points near it stand for them, by bits.
  struct Seam {
    size_t attribute;
    uint64_t points;
  };
  static_assert(GroupSurface::kMostNear <= 64, "a bit for each point");

  // Points near a sample that stand for sides of seams, the nearest first: one or two of dozens, which would fill the memory.
  struct AcrossSeams {
    std::vector<GroupSurface::Point> points;
    std::vector<Seam> seams;  // ascending attributes
  };

  static AcrossSeams KeepSides(const GroupSurface& original, const std::vector<GroupSurface::Point>& near);
  void TakeBlock(const AttributedMesh& mesh, const GroupSurface& original, double seam_distance, size_t block);
  const AcrossSeams& AcrossAt(size_t i) const { return across_[i / kBlockSize][samples_[i].across]; }
  const Seam* SeamAt(size_t i, size_t attribute) const;

  std::vector<Sample> samples_;
  std::vector<double> shares_;                    // of the faces: of the area, for each of its samples
  std::vector<std::vector<AcrossSeams>> across_;  // of every block of samples
};

}  // namespace lacerta

#endif  // LACERTA_REMESH_ATTRIBUTE_SAMPLES_H_
