// Two-sided surface-to-surface distance (S2S) between triangle meshes, by which all distortion is measured:
// [Payan & Antonini 2004] (2)-(4).
//
//   d(A, B)   = sqrt(1/|A| * integral over a in A of min over b in B of |a - b|^2), by sampling A
//   d_S(A, B) = max(d(A, B), d(B, A))
#ifndef LACERTA_SURFACE_DISTANCE_H_
#define LACERTA_SURFACE_DISTANCE_H_

#include <cstdint>
#include <memory>

#include "lacerta/mesh.h"
#include "lacerta/status.h"

namespace lacerta {

struct SurfaceDistanceOptions {
  // Points on each of the two surfaces, 1 to kMaxSamples. They are spread evenly over the area, whatever the triangles.
  uint64_t num_samples = 200'000;
  // Picks another set of samples: the spread over seeds is the error of the measure.
  uint32_t seed = 0;
  // Look for the maximum at the vertices too, where it often is. Costs as much as so many samples more; switch it off
  // to measure a mesh quickly with few samples.
  bool max_at_vertices = true;

  static constexpr uint64_t kMaxSamples = 1'000'000'000;

  // For a caller that has no use for the maximum.
  static SurfaceDistanceOptions RmsOnly(uint64_t samples = 200'000) { return {samples, 0, false}; }
};

// One direction of the distance, in model units.
struct OneSidedDistance {
  double rms = 0.0;
  double max = 0.0;  // over the samples, and the vertices if asked: a lower bound of the one-sided Hausdorff distance
};

// All in model units.
struct SurfaceDistance {
  OneSidedDistance forward;   // from the original to the other mesh
  OneSidedDistance backward;  // from the other mesh to the original

  double Rms() const { return forward.rms > backward.rms ? forward.rms : backward.rms; }        // d_S
  double Hausdorff() const { return forward.max > backward.max ? forward.max : backward.max; }  // sampled
};

// Length of the diagonal of the box around the vertices that triangles use, model units. 0 where there is none;
// triangles with an index out of range do not count, nor do those with two corners at one point, which are no surface.
double BoundingBoxDiagonal(const TriangleMesh& mesh);

// No two meshes of floats are measured to be closer than this many dB.
inline constexpr double kMaxPsnr = 200.0;

// Peak signal-to-noise ratio in dB: 20 log10(diagonal / distance), at most kMaxPsnr, which also stands for distance
// zero. Both in the same unit and >= 0; where the diagonal is zero and the distance is not, minus infinity; NaN where
// either is NaN.
double Psnr(double distance, double diagonal);

// The distance d_S for a PSNR in dB: diagonal * 10^(-psnr / 20).
double DistanceOfPsnr(double psnr, double diagonal);

// Measures many meshes against one original, of which everything that measuring needs is prepared once.
//
// Samples are a low-discrepancy sequence over the cumulated triangle areas in spatially coherent order; measuring runs
// on all cores of the TBB arena it is called in. The result depends on the meshes and options alone, to the last bit,
// not on the number of threads. Measure is const and may be called from several threads. Copies share what was prepared.
class SurfaceDistanceMeter {
 public:
  // Fails with kInvalidData when the original has no triangle, no area, an index out of range, a coordinate that is not
  // finite or beyond 1e18 in size, or a bounding box smaller than 1e-12. Degenerate triangles among others are fine.
  static StatusOr<SurfaceDistanceMeter> Create(const TriangleMesh& original);

  // For originals of many millions of triangles: takes 7 to 13 bytes a triangle beside the mesh, where Create takes about 100, and two to three times as
  // long to measure. The distances are the same but for the choice of samples. `original` has to outlive the meter and its copies.
  static StatusOr<SurfaceDistanceMeter> CreateLean(const TriangleMesh& original);
  static StatusOr<SurfaceDistanceMeter> CreateLean(TriangleMesh&&) = delete;

  // Distance between the original and `mesh`. Fails as Create does, except for the size of the box, and with
  // kInvalidArgument on options out of range.
  StatusOr<SurfaceDistance> Measure(const TriangleMesh& mesh, const SurfaceDistanceOptions& options = {}) const;

  // Of the original's bounding box, model units.
  double diagonal() const;

 private:
  struct Original;
  explicit SurfaceDistanceMeter(std::shared_ptr<const Original> original);
  template <typename Make>
  static StatusOr<SurfaceDistanceMeter> Create(const TriangleMesh& original, const Make& make);

  std::shared_ptr<const Original> original_;
};

// The same for a single pair.
StatusOr<SurfaceDistance> MeasureSurfaceDistance(const TriangleMesh& original, const TriangleMesh& mesh,
                                                 const SurfaceDistanceOptions& options = {});

}  // namespace lacerta

#endif  // LACERTA_SURFACE_DISTANCE_H_
