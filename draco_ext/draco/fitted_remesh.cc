#include "draco/fitted_remesh.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "draco/decoded_distance.h"
#include "lacerta/decoder.h"
#include "remesh/surface_fit.h"

namespace lacerta {
namespace {

// Levels to begin with: those that bring a base to a third of the input's vertices, where chords of the remesh may cost little already.
int FirstLevels(double num_base_vertices, double num_input_vertices) {
  constexpr double kVertexShare = 0.35;
  constexpr int kMostLevels = 10;
  int levels = 0;
  for (double v = num_base_vertices; v < kVertexShare * num_input_vertices && levels < kMostLevels; v *= 4) ++levels;
  return levels;
}

// That levels may bring a remesh to: six times the input's, and more where that is quickly decoded. Coarse inputs need it most: their
// triangles are as large as what a stream of 70 dB may be wrong by.
double MostVertices(double num_input_vertices) {
  constexpr double kShare = 6, kLargestShare = 24, kQuicklyDecoded = 200'000;
  return std::max(kShare * num_input_vertices, std::min(kLargestShare * num_input_vertices, kQuicklyDecoded));
}

double PsnrOf(const NormalMesh& remesh, const SurfaceDistanceMeter& meter, uint64_t num_samples) {
  const TriangleMesh finest = MeshAtLevel(remesh.mesh, remesh.mesh.num_levels).value();
  return DecodedPsnr(meter, finest, num_samples);
}

constexpr uint64_t kRoughSamples = 30'000;

// Whether a remesh has no more than that PSNR, which few samples mostly tell.
bool IsBelow(double psnr, const NormalMesh& remesh, const SurfaceDistanceMeter& meter) {
  constexpr uint64_t kFewSamples = 5'000;
  constexpr double kClear = 1.5;  // dB
  const double about = PsnrOf(remesh, meter, kFewSamples);
  return std::fabs(about - psnr) > kClear ? about < psnr : PsnrOf(remesh, meter, kRoughSamples) <= psnr;
}

}  // namespace

StatusOr<FittedRemesh> RemeshForPsnr(const RefinableSurface& surface, uint32_t num_base_vertices, double psnr, BaseCoding coding,
                                     const SurfaceDistanceMeter& meter, std::unique_ptr<PiercedBase> begun) {
  constexpr double kMostGain = 4;  // dB that the fit brings (182 remeshes that it made near enough: one was farther than 3 before)
  const double num_input = static_cast<double>(surface.surface.mesh().positions.size());
  std::unique_ptr<PiercedBase> pierced = std::move(begun);
  for (int levels = pierced ? pierced->num_levels() + 1 : FirstLevels(num_base_vertices, num_input);; ++levels) {
    LACERTA_ASSIGN_OR_RETURN(pierced, PierceUnreversed(surface, num_base_vertices, levels, coding, std::move(pierced)));
    const bool may_grow = 4 * static_cast<double>(pierced->refined().mesh.positions.size()) <= MostVertices(num_input);
    if (may_grow && IsBelow(psnr - kMostGain, pierced->Remesh(), meter)) continue;  // fitted or not
    FittedRemesh result{pierced->base(), pierced->Remesh(), 0, nullptr};
    if (!may_grow) pierced.reset();  // as large as what comes now
    FitToInput(surface.surface, SurfaceFitOptions(), &result.mesh);
    result.psnr = PsnrOf(result.mesh, meter, kRoughSamples);
    if (may_grow && result.psnr <= psnr) continue;
    result.pierced = std::move(pierced);
    return result;
  }
}

}  // namespace lacerta
