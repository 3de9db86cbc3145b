// Wavelet transforms of semi-regular meshes behind one interface, so that coders can be put together from stages.
#ifndef LACERTA_TESTS_BASELINES_TRANSFORM_H_
#define LACERTA_TESTS_BASELINES_TRANSFORM_H_

#include <memory>
#include <vector>

#include "common/subdivision.h"
#include "encoder/analysis.h"
#include "lacerta/mesh.h"
#include "lacerta/status.h"

namespace lacerta::baselines {

// A mesh in the basis of a transform.
struct Decomposition {
  std::vector<Vec3f> base;                // #V0: positions, or control points where the basis does not interpolate
  std::vector<LevelCoefficients> levels;  // details of levels 1 .. L in local frames of the coarser level
};

// A transform on the connectivity of one base mesh and its refinements.
class Transform {
 public:
  virtual ~Transform() = default;

  // positions: #V of the finest level. Open loop: frames come from the exact coarser level.
  virtual StatusOr<Decomposition> Analyze(const std::vector<Vec3f>& positions) const = 0;
  // Positions of the finest level. Frames come from the coarser level as decoded.
  virtual StatusOr<std::vector<Vec3f>> Synthesize(const Decomposition& decomposition) const = 0;
  // By level 0 .. L: squared displacement of all finest vertices by a unit coefficient.
  virtual const std::vector<double>& energies() const = 0;
  // Of levels 0 .. L - 1, whose edges carry the details.
  virtual const std::vector<Topology>& topologies() const = 0;
};

// The unlifted butterfly transform [Khodakovsky, Guskov 2002]: that of the product.
StatusOr<std::unique_ptr<Transform>> MakeButterflyTransform(uint32_t num_base_vertices,
                                                            const std::vector<Triangle>& base_triangles,
                                                            int num_levels);

// Loop wavelets after [Khodakovsky, Schroeder, Sweldens 2000, Sec. 3.1]; see loop_wavelet.h.
StatusOr<std::unique_ptr<Transform>> MakeLoopTransform(uint32_t num_base_vertices,
                                                       const std::vector<Triangle>& base_triangles, int num_levels);

}  // namespace lacerta::baselines

#endif  // LACERTA_TESTS_BASELINES_TRANSFORM_H_
