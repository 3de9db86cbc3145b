// The attributes of a surface over the levels of its remesh: corners of the base, and values at all vertices.
#ifndef LACERTA_REMESH_LEVEL_ATTRIBUTES_H_
#define LACERTA_REMESH_LEVEL_ATTRIBUTES_H_

#include <cstdint>
#include <vector>

#include "lacerta/attributed_levels.h"
#include "lacerta/remesh.h"
#include "remesh/attributed_parts.h"
#include "remesh/base_domain.h"

namespace lacerta {

// Groups and base corners that follow from a base alone, with the values of the base's vertices.
struct BaseAttributes {
  std::vector<uint32_t> groups;            // #F0; empty: all 0
  std::vector<LevelAttribute> attributes;  // `values` of the base alone
};

// domain: of a history of parts.refined.surface, in the order of the base. base_triangles: #F0, those of the domain in their order among
// those of parts.still, which are the ones with a vertex that has no input vertex in the domain; still_vertex: #V0, their vertices in
// parts.still, kNone for all others.
BaseAttributes SampleBase(const AttributedParts& parts, const BaseDomain& domain, const std::vector<Triangle>& base_triangles,
                          const std::vector<uint32_t>& still_vertex);

// Values at the vertices of all levels: of the point of the input at the parameter of each (from Pierce), on the side of a seam that the
// triangles of the wedge are on. remesh: of the domain, whose vertices may have moved since.
void SampleLevels(const AttributedParts& parts, const BaseDomain& domain, const SemiRegularMesh& remesh,
                  const std::vector<DomainPoint>& parameters, std::vector<LevelAttribute>* attributes);

// The wedge mesh of a level: 4^level triangles for each base triangle that is split, then the still ones, as MeshAtLevel orders them;
// kNoValue x 3 where the attribute is not. 0 <= level <= num_levels.
std::vector<Triangle> WedgeTriangles(const SemiRegularMesh& surface, const LevelAttribute& attribute, int level);

// The surface of the finest level with its attributes. The corners of attribute a are WedgeTriangles(.., num_levels).
AttributedMesh FinestLevel(const AttributedSemiRegularMesh& mesh);

}  // namespace lacerta

#endif  // LACERTA_REMESH_LEVEL_ATTRIBUTES_H_
