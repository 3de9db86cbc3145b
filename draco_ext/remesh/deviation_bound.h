// How far a surface goes from another one while its triangles change: error control of simplification by the Hausdorff distance of samples
// [Klein, Liebich, Strasser 1996, "Mesh reduction with error control"]. Quadrics know the mean over an area alone, in which a tab is nothing.
#ifndef LACERTA_REMESH_DEVIATION_BOUND_H_
#define LACERTA_REMESH_DEVIATION_BOUND_H_

#include <cstdint>
#include <memory>
#include <vector>

#include "lacerta/mesh.h"
#include "lacerta/vec3.h"
#include "remesh/deviation_samples.h"

namespace lacerta {

class DeviationBound {
 public:
  // A triangle around the vertex that an edge collapses to.
  struct Face {
    uint32_t triangle;
    bool remains;
    Vec3d a, b;  // its other corners
  };

  // Of the surface that the samples are of, as it is now. groups: as they were given to the samples; what was in one has to stay near triangles of the same
  // one.
  DeviationBound(std::shared_ptr<const DeviationSamples> original, size_t num_triangles, std::vector<uint32_t> groups);
  // Of one that was made of it. A sample that is too far from it already has to come no farther. Runs on all cores; the same on any number of them.
  DeviationBound(std::shared_ptr<const DeviationSamples> original, const TriangleMesh& surface);

  // Whether the surface stays within the bound where an edge collapses to that place, and the triangles around it become these. What was on them has to
  // be near what remains of them, and points of large ones near the original.
  bool Allows(const Vec3d& to, const std::vector<Face>& faces);
  // Makes what the last call of Allows was asked for the state, where that said yes.
  void Accept();
  // What is on a triangle is on another one from now on, upon which it lies.
  void Give(uint32_t triangle, uint32_t to);

 private:
  struct Place {
    uint32_t sample, triangle;
  };

  DeviationBound(std::shared_ptr<const DeviationSamples> original, size_t num_triangles);
  void Put(const Place& place);
  uint32_t NearestOf(const Vec3d& to, const std::vector<Face>& faces, uint32_t own, uint32_t sample) const;
  bool AreNearOriginal(const Vec3d& to, const std::vector<Face>& faces) const;

  std::shared_ptr<const DeviationSamples> original_;
  std::vector<uint32_t> groups_;        // empty: all are in one
  std::vector<double> most_squared_;    // of each sample: how far it may be
  std::vector<uint32_t> first_, next_;  // of each triangle its first sample, of each sample the next on its triangle
  std::vector<uint32_t> changed_;       // triangles that the last call asked for
  std::vector<Place> places_;           // where it found their samples
};

}  // namespace lacerta

#endif  // LACERTA_REMESH_DEVIATION_BOUND_H_
