// Piercing: the refinement of a base mesh to a normal mesh, level by level [Guskov et al. 2000, Sec. 4].
#ifndef LACERTA_REMESH_PIERCING_H_
#define LACERTA_REMESH_PIERCING_H_

#include <vector>

#include "lacerta/mesh.h"
#include "lacerta/remesh.h"
#include "remesh/base_domain.h"
#include "remesh/input_surface.h"

namespace lacerta {

struct PiercingOptions {
  int num_levels = 5;
  // A point found on the normal line counts only if it lies within these bounds of what is expected:
  double max_distance = 1.0;            // from the predicted position, in lengths of the coarse edge
  double max_parameter_distance = 0.75; // from the middle of the edge in the parametrization, in lengths of the edge there
  double min_normal_cosine = 0.2;       // between the input's normal and the predicted one
  double min_child_area = 0.02;         // of a fine triangle in the parametrization, as a share of its parent (1/4 is even)
  int relaxation_rounds = 2;            // over the vertices of a level that are not on their normal line
  int turning_rounds = 4;               // over the vertices of triangles that are turned over after all of this
};

// Each level: predict the midpoint of every edge with the butterfly stencil, pierce the input along the predicted normal, and
// keep the nearest hit that the parametrization confirms; where there is none take the closest point on the input, else the
// parametric point. Then every fine triangle is checked for folds in the parametrization and against the input's normals, and
// the midpoints of those that fail fall back. The parametric triangles never fold, so the mesh keeps the input's topology; where
// they are turned over in space nonetheless, their midpoints move in the parametrization until that is undone or no move helps.
//
// base_positions: #V0, of the base as the decoder will have it (they need not lie on the input). parameters: where not null, becomes the
// points of the domain at which the vertices of the finest level stand, #V; face kNone for isolated base vertices.
NormalMesh Pierce(const InputSurface& surface, const BaseDomain& domain, const std::vector<Vec3f>& base_positions,
                  const PiercingOptions& options, std::vector<DomainPoint>* parameters = nullptr);

}  // namespace lacerta

#endif  // LACERTA_REMESH_PIERCING_H_
