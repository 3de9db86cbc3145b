// Piercing level by level: a normal mesh that can be given more levels.
#ifndef LACERTA_REMESH_GROWING_NORMAL_MESH_H_
#define LACERTA_REMESH_GROWING_NORMAL_MESH_H_

#include <vector>

#include "common/butterfly.h"
#include "common/subdivision.h"
#include "lacerta/remesh.h"
#include "remesh/base_domain.h"
#include "remesh/input_surface.h"
#include "remesh/level_piercer.h"
#include "remesh/piercing.h"

namespace lacerta {

// surface and domain must outlive it.
class GrowingNormalMesh {
 public:
  // No level yet. base_positions: #V0, as for Pierce; of the options all but num_levels count.
  GrowingNormalMesh(const InputSurface& surface, const BaseDomain& domain, const std::vector<Vec3f>& base_positions, const PiercingOptions& options);

  void AddLevel();

  int num_levels() const { return mesh_.mesh.num_levels; }
  // As Pierce with so many levels makes it.
  const NormalMesh& mesh() const { return mesh_; }
  // The points of the domain at which the vertices stand, #V; face kNone for isolated base vertices.
  std::vector<DomainPoint> Parameters() const;

 private:
  const InputSurface& surface_;
  const BaseDomain& domain_;
  const PiercingOptions options_;
  NormalMesh mesh_;
  std::vector<Site> sites_;  // #V
  Topology topology_;        // of level max(0, num_levels - 1)
  StencilTable stencils_;
};

}  // namespace lacerta

#endif  // LACERTA_REMESH_GROWING_NORMAL_MESH_H_
