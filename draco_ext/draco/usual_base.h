// Which base meshes streams of a surface usually have.
#ifndef LACERTA_DRACO_USUAL_BASE_H_
#define LACERTA_DRACO_USUAL_BASE_H_

#include <cstdint>

#include "draco/refinable_surface.h"
#include "lacerta/surface_distance.h"

namespace lacerta {

// The PSNR of the base by itself that streams of a PSNR usually have, dB: it hardly follows the stream's, and so shapes with much in them want large bases.
double UsualBasePsnr(double psnr);

// The PSNR, dB, of the base that the history has at `num_vertices` vertices, at most those of the surface, or of its coarsest if that is larger, without
// any level. meter: of the input.
double BasePsnr(const RefinableSurface& surface, uint32_t num_vertices, const SurfaceDistanceMeter& meter);

}  // namespace lacerta

#endif  // LACERTA_DRACO_USUAL_BASE_H_
