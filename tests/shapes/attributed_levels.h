// Semi-regular meshes with attributes out of coarse surfaces.
#ifndef LACERTA_TESTS_SHAPES_ATTRIBUTED_LEVELS_H_
#define LACERTA_TESTS_SHAPES_ATTRIBUTED_LEVELS_H_

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include "common/attribute_wedges.h"
#include "common/glued_base.h"
#include "common/subdivision.h"
#include "lacerta/attributed_base.h"
#include "lacerta/attributed_levels.h"

namespace lacerta::shapes {

// The groups' soups, hung together where they touch, with `num_levels` levels over them: midpoints of positions and values lie in the middle
// of their edges, and then `place` moves every position, `change` every value of every attribute.
inline AttributedSemiRegularMesh SubdividedSoups(const std::vector<VertexSoup>& groups, int num_levels, const std::function<Vec3f(Vec3f)>& place,
                                                 const std::function<void(const LevelAttribute&, float*)>& change) {
  constexpr float kFine = 1.0f / 4096;
  std::vector<AttributeLattice> precision;
  std::vector<VertexSoup> rounded = groups;
  for (VertexSoup& soup : rounded) {
    for (Vec3f& p : soup.positions) {
      for (int c = 0; c < 3; ++c) p[c] = std::nearbyint(p[c] / kFine) * kFine;
    }
    for (VertexSoup::Attribute& a : soup.attributes) {
      const bool known = std::any_of(precision.begin(), precision.end(), [&](const AttributeLattice& p) { return p.name == a.name; });
      const bool is_normal = a.kind == AttributeKind::kNormal;
      if (!known) precision.push_back({a.name, a.kind, a.components, is_normal ? 0.0f : kFine, is_normal ? 12 : 0});
      for (float& x : a.values) x = is_normal ? x : std::nearbyint(x / kFine) * kFine;
    }
  }
  const GluedBase base = GlueBase(AttributedBaseFromSoups(rounded, kFine, precision).value()).value();
  AttributedSemiRegularMesh mesh;
  mesh.surface = {base.mesh.triangles, static_cast<uint32_t>(base.mesh.lattice.size()), num_levels, base.mesh.ToMesh().positions, {}};
  mesh.base_groups = base.groups;
  mesh.attributes = base.attributes;
  Topology t = BuildTopology(mesh.surface.num_base_vertices, base.mesh.triangles).value();
  for (int level = 0; level < num_levels; ++level) {
    if (level > 0) t = Refine(t);
    for (const auto& [a, b] : t.edges) mesh.surface.positions.push_back((mesh.surface.positions[a] + mesh.surface.positions[b]) * 0.5f);
  }
  for (LevelAttribute& a : mesh.attributes) {
    AttributeWedges wedges = MakeAttributeWedges(a.base_corners, a.num_base_values).value();
    for (int level = 0; level < num_levels; ++level) {
      if (level > 0) RefineWedges(&wedges);
      for (const auto& [v, w] : wedges.topology.edges) {
        for (uint32_t c = 0; c < a.components; ++c) a.values.push_back((a.values[v * a.components + c] + a.values[w * a.components + c]) / 2);
      }
    }
    for (size_t i = 0; i < a.values.size(); i += a.components) change(a, &a.values[i]);
  }
  for (Vec3f& p : mesh.surface.positions) p = place(p);
  return mesh;
}

}  // namespace lacerta::shapes

#endif  // LACERTA_TESTS_SHAPES_ATTRIBUTED_LEVELS_H_
