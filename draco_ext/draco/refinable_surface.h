// What candidates are made of, prepared once: the surface that is remeshed and what stands still beside it.
#ifndef LACERTA_DRACO_REFINABLE_SURFACE_H_
#define LACERTA_DRACO_REFINABLE_SURFACE_H_

#include "lacerta/mesh.h"
#include "remesh/collapse_history.h"
#include "remesh/input_surface.h"

namespace lacerta {

struct RefinableSurface {
  const InputSurface& surface;
  const CollapseHistory& history;  // of surface.mesh()
  const TriangleMesh& still;       // an oriented manifold like the other; may be empty
};

}  // namespace lacerta

#endif  // LACERTA_DRACO_REFINABLE_SURFACE_H_
