// A base mesh over which levels have less left to code than decimation leaves them.
#ifndef LACERTA_REMESH_BASE_OPTIMIZATION_H_
#define LACERTA_REMESH_BASE_OPTIMIZATION_H_

#include <vector>

#include "lacerta/mesh.h"
#include "remesh/base_domain.h"
#include "remesh/input_surface.h"

namespace lacerta {

// Slides vertices (SlideBase) and turns edges (FlipBaseEdges) in turns. domain: of `surface`, before Reorder; positions: #V, on the input. Bases of more than ten thousand vertices stay as they are, which bounds time
// and memory.
void OptimizeBase(const InputSurface& surface, BaseDomain* domain, std::vector<Vec3f>* positions);

}  // namespace lacerta

#endif  // LACERTA_REMESH_BASE_OPTIMIZATION_H_
