#include "remesh/level_wedges.h"

#include <algorithm>
#include <utility>

#include "common/base_tags.h"
#include "common/subdivision.h"

namespace lacerta {
namespace {

constexpr uint32_t kNoValue = MeshAttribute::kNoValue;

}  // namespace

SplitWedges SplitOf(const BaseTags& tags, const LevelAttribute& attribute) {
  SplitWedges result;
  for (size_t f = 0; f < attribute.base_corners.size(); ++f) {
    if (!tags.still.empty() && tags.still[f] != 0) continue;
    const bool has_value = attribute.base_corners[f][0] != kNoValue;
    result.number.push_back(has_value ? static_cast<uint32_t>(result.triangles.size()) : kNone);
    if (has_value) result.triangles.push_back(attribute.base_corners[f]);
  }
  return result;
}

std::vector<Triangle> RefinedWedges(const SplitWedges& split, uint32_t num_base_values, int level) {
  Topology topology = BuildTopology(num_base_values, split.triangles).value();
  for (int i = 0; i < level; ++i) topology = Refine(topology);
  return topology.triangles;
}

std::vector<Triangle> WedgeTriangles(const SemiRegularMesh& surface, const LevelAttribute& attribute, int level) {
  if (level == 0) return attribute.base_corners;
  const SplitWedges split = SplitOf(surface.tags, attribute);
  const size_t per_base = size_t{1} << (2 * level);
  std::vector<Triangle> result(split.number.size() * per_base, {kNoValue, kNoValue, kNoValue});
  if (!split.triangles.empty()) {
    const std::vector<Triangle> wedges = RefinedWedges(split, attribute.num_base_values, level);
    for (size_t f = 0; f < split.number.size(); ++f) {
      if (split.number[f] == kNone) continue;
      std::copy_n(wedges.begin() + static_cast<std::ptrdiff_t>(split.number[f] * per_base), per_base,
                  result.begin() + static_cast<std::ptrdiff_t>(f * per_base));
    }
  }
  return WithStillTriangles(std::move(result), attribute.base_corners, surface.tags);
}

AttributedMesh FinestLevel(const AttributedSemiRegularMesh& mesh) {
  const SemiRegularMesh& surface = mesh.surface;
  AttributedMesh result;
  BaseTags tags = surface.tags;
  std::vector<Triangle> split;
  for (size_t f = 0; f < surface.base_triangles.size(); ++f) {
    if (tags.still.empty() || tags.still[f] == 0) split.push_back(surface.base_triangles[f]);
  }
  Topology topology = BuildTopology(surface.num_base_vertices, split).value();
  for (int i = 0; i < surface.num_levels; ++i) topology = Refine(topology);
  result.surface = {surface.positions, surface.num_levels == 0 ? surface.base_triangles
                                                               : WithStillTriangles(std::move(topology.triangles), surface.base_triangles, tags)};
  if (!mesh.base_groups.empty()) {
    const size_t per_base = size_t{1} << (2 * surface.num_levels);
    std::vector<uint32_t> still_groups;
    for (size_t f = 0; f < surface.base_triangles.size(); ++f) {
      const bool is_still = surface.num_levels > 0 && !tags.still.empty() && tags.still[f] != 0;
      if (is_still) {
        still_groups.push_back(mesh.base_groups[f]);
      } else {
        result.groups.insert(result.groups.end(), per_base, mesh.base_groups[f]);
      }
    }
    result.groups.insert(result.groups.end(), still_groups.begin(), still_groups.end());
  }
  for (const LevelAttribute& attribute : mesh.attributes) {
    MeshAttribute& out = result.attributes.emplace_back();
    out.name = attribute.name;
    out.kind = attribute.kind;
    out.components = attribute.components;
    out.values = attribute.values;
    out.corners = WedgeTriangles(surface, attribute, surface.num_levels);
  }
  return result;
}

}  // namespace lacerta
