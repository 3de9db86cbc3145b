// A surface ready to be sampled and to be measured against.
#ifndef LACERTA_GEOMETRY_MEASURED_SURFACE_H_
#define LACERTA_GEOMETRY_MEASURED_SURFACE_H_

#include <cstdint>
#include <functional>
#include <memory>

#include "lacerta/mesh.h"
#include "lacerta/status.h"

namespace lacerta {

// All is const and may be used from several threads.
class MeasuredSurface {
 public:
  // Called with rising numbers of points.
  using Points = std::function<Vec3f(uint64_t)>;

  virtual ~MeasuredSurface() = default;

  // Of all triangles, > 0 where there is anything to sample.
  virtual double doubled_area() const = 0;
  // Squared distance of p. *hint: any number at first, then what the last call for a point near p left there.
  virtual double SquaredDistance(const Vec3f& p, uint32_t* hint) const = 0;
  // Points spread evenly over the area (SampleSequence), neighbors in the list mostly neighbors in space.
  virtual Points Samples(uint64_t num_samples, uint32_t seed) const = 0;
  // Points among which are all vertices in use, and no other; how many there are.
  virtual Points Vertices() const = 0;
  virtual uint64_t num_vertices() const = 0;
};

// Fails with kInvalidData where the bounding box of a surface has a diagonal, model units, too small for what is measured against it.
Status CheckDiagonal(double diagonal);

// mesh: indices in range, used coordinates finite and within TriangleTree::kMaxCoordinate.

// With a copy of all that it needs: about 100 bytes a triangle. with_vertices: num_vertices is 0 otherwise.
std::unique_ptr<MeasuredSurface> MakeMeasuredSurface(const TriangleMesh& mesh, bool with_vertices);

// By way of LeanTree, 7 to 13 bytes a triangle beside the mesh, which has to outlive it. The same distances of the same points, of other samples: those
// of a surface follow the order of its tree.
std::unique_ptr<MeasuredSurface> MakeLeanSurface(const TriangleMesh& mesh);

}  // namespace lacerta

#endif  // LACERTA_GEOMETRY_MEASURED_SURFACE_H_
