// The attributes of a surface on a base mesh of it: groups, corners and their values.
#ifndef LACERTA_REMESH_BASE_ATTRIBUTES_H_
#define LACERTA_REMESH_BASE_ATTRIBUTES_H_

#include <cstdint>
#include <vector>

#include "lacerta/attributed_levels.h"
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

}  // namespace lacerta

#endif  // LACERTA_REMESH_BASE_ATTRIBUTES_H_
