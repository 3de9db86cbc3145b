// The attributes of a surface at the vertices of all levels of its remesh.
#ifndef LACERTA_REMESH_LEVEL_ATTRIBUTES_H_
#define LACERTA_REMESH_LEVEL_ATTRIBUTES_H_

#include <vector>

#include "lacerta/attributed_levels.h"
#include "lacerta/mesh.h"
#include "remesh/attributed_parts.h"
#include "remesh/base_domain.h"

namespace lacerta {

// Values at the vertices of all levels: of the point of the input at the parameter of each (from Pierce), on the side of a seam that the
// triangles of the wedge are on. remesh: of the domain, whose vertices may have moved since.
void SampleLevels(const AttributedParts& parts, const BaseDomain& domain, const SemiRegularMesh& remesh,
                  const std::vector<DomainPoint>& parameters, std::vector<LevelAttribute>* attributes);

}  // namespace lacerta

#endif  // LACERTA_REMESH_LEVEL_ATTRIBUTES_H_
