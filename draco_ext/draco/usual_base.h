// Which base meshes streams of a surface usually have.
#ifndef LACERTA_DRACO_USUAL_BASE_H_
#define LACERTA_DRACO_USUAL_BASE_H_

#include <cstdint>

#include "draco/refinable_surface.h"
#include "lacerta/surface_distance.h"

namespace lacerta {

// The PSNR of the base by itself that streams of a PSNR usually have at least, dB, and how much of the surface is askew to it at most: shapes with much in
// them want large bases, and so do those with limbs and folds, of which a base may be near and yet have little to predict from.
double UsualBasePsnr(double psnr);
double UsualAskewShare(double psnr);

// The PSNR, dB, of the base that the history has at `num_vertices` vertices, at most those of the surface, or of its coarsest if that is larger, without
// any level. meter: of the input.
double BasePsnr(const RefinableSurface& surface, uint32_t num_vertices, const SurfaceDistanceMeter& meter);

// The share of the surface's area that is more than 60 degrees off the triangle of that base in which it lies.
double AskewShare(const RefinableSurface& surface, uint32_t num_vertices);

}  // namespace lacerta

#endif  // LACERTA_DRACO_USUAL_BASE_H_
