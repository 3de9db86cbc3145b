// A remesh with so many levels that it is worth coding at a PSNR.
#ifndef LACERTA_DRACO_FITTED_REMESH_H_
#define LACERTA_DRACO_FITTED_REMESH_H_

#include <cstdint>
#include <memory>

#include "draco/base_mesh_codec.h"
#include "draco/pierced_base.h"
#include "draco/refinable_surface.h"
#include "lacerta/remesh.h"
#include "lacerta/status.h"
#include "lacerta/surface_distance.h"

namespace lacerta {

struct FittedRemesh {
  CodedBase base;
  NormalMesh mesh;  // over base.mesh, fitted to the input (remesh/surface_fit.h)
  double psnr = 0;  // dB, of the mesh
  std::unique_ptr<PiercedBase> pierced;  // to go on from; null where one level more would have more vertices than the input is worth
};

// Remeshes the surface over the base of about that many vertices, with levels until the remesh is of that PSNR, dB, or has many times the
// input's vertices. meter: of the input; begun: of the same base at a lower PSNR, from which it goes on to a level more, or null. Fails where the
// base cannot be coded.
StatusOr<FittedRemesh> RemeshForPsnr(const RefinableSurface& surface, uint32_t num_base_vertices, double psnr, BaseCoding coding,
                                     const SurfaceDistanceMeter& meter, std::unique_ptr<PiercedBase> begun = nullptr);

}  // namespace lacerta

#endif  // LACERTA_DRACO_FITTED_REMESH_H_
