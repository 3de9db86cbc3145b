#include "common/glued_base.h"

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include "common/attribute_layout.h"
#include "common/gluing.h"
#include "common/octahedral.h"
#include "common/stream_layout.h"
#include "common/subdivision.h"

namespace lacerta {
namespace {

Status CheckAttribute(const BaseAttribute& a, size_t num_vertices, size_t num_groups) {
  const AttributeLattice& p = a.precision;
  const bool is_normal = p.kind == AttributeKind::kNormal;
  if (!HasLegalComponents(p)) return InvalidData(std::to_string(p.components) + " components are not legal");
  if (is_normal ? p.octahedral_bits < kLeastOctahedralBits || p.octahedral_bits > kMostOctahedralBits : !(p.step > 0) || p.octahedral_bits != 0)
    return InvalidData("its step or number of bits is not legal");
  if (a.values.size() != num_vertices * a.numbers_per_value() || a.in_group.size() != num_groups)
    return InvalidData("its values or groups are not as many as those of the base");
  const int32_t least = is_normal ? 0 : -kMaxLatticeValue, most = is_normal ? (1 << p.octahedral_bits) - 2 : kMaxLatticeValue;
  if (std::all_of(a.values.begin(), a.values.end(), [&](int32_t v) { return v >= least && v <= most; })) return Status();
  return InvalidData("a value is off its lattice");
}

StatusOr<std::vector<uint32_t>> GroupsOfTriangles(const AttributedBase& base) {
  std::vector<uint32_t> groups;
  uint64_t sum = 0;
  for (const uint32_t size : base.group_sizes) sum += size;
  if (sum != base.mesh.triangles.size()) return InvalidData("the groups of the base do not add up to its triangles");
  for (uint32_t g = 0; g < base.group_sizes.size(); ++g) groups.insert(groups.end(), base.group_sizes[g], g);
  return groups;
}

// The row of floats that integers stand for.
void AppendValue(const AttributeLattice& p, const int32_t* numbers, std::vector<float>* values) {
  if (p.kind != AttributeKind::kNormal) {
    for (uint32_t c = 0; c < p.components; ++c) values->push_back(static_cast<float>(numbers[c]) * p.step);
    return;
  }
  const Vec3f normal = NormalFromOctahedral({numbers[0], numbers[1]}, p.octahedral_bits);
  values->insert(values->end(), {normal.x, normal.y, normal.z});
}

LevelAttribute GlueAttribute(const AttributedBase& base, const std::vector<uint32_t>& groups, const std::vector<uint32_t>& twins,
                             const BaseAttribute& a) {
  const std::vector<Triangle>& triangles = base.mesh.triangles;
  const uint32_t n = a.numbers_per_value();
  const auto value_at = [&](uint32_t face, uint32_t corner) { return a.values.begin() + size_t{triangles[face][corner % 3]} * n; };
  std::vector<uint8_t> is_in(triangles.size());
  for (size_t f = 0; f < is_in.size(); ++f) is_in[f] = a.in_group[groups[f]];
  const auto is_glued = [&](uint32_t h, uint32_t twin) {
    const auto same = [&](uint32_t corner, uint32_t other) {
      const auto first = value_at(h / 3, corner), second = value_at(twin / 3, other);
      return std::equal(first, first + n, second);
    };
    return same(h % 3 + 1, twin % 3 + 2) && same(h % 3 + 2, twin % 3 + 1);
  };
  std::vector<uint32_t> glued_twins = twins;
  for (uint32_t h = 0; h < twins.size(); ++h) {
    if (twins[h] != kNone && is_in[h / 3] != 0 && is_in[twins[h] / 3] != 0 && !is_glued(h, twins[h])) glued_twins[h] = kNone;
  }
  GluedCorners glued = GlueCorners(is_in, glued_twins);
  LevelAttribute result{a.precision.name, a.precision.kind, a.precision.components, std::move(glued.vertices),
                        static_cast<uint32_t>(glued.first_corner.size()), {}};
  for (const uint32_t corner : glued.first_corner) AppendValue(a.precision, &*value_at(corner / 3, corner % 3), &result.values);
  return result;
}

}  // namespace

StatusOr<GluedBase> GlueBase(const AttributedBase& base) {
  const std::vector<std::array<int32_t, 3>>& lattice = base.mesh.lattice;
  for (const Triangle& t : base.mesh.triangles) {
    for (const uint32_t v : t) {
      if (v >= lattice.size()) return InvalidData("a triangle of the base refers to vertex " + std::to_string(v) + " of " + std::to_string(lattice.size()));
    }
  }
  GluedBase result;
  LACERTA_ASSIGN_OR_RETURN(result.groups, GroupsOfTriangles(base));
  const std::vector<uint32_t> twins = PairHalfEdges(lattice, base.mesh.triangles);
  GluedCorners surface = GlueCorners(std::vector<uint8_t>(base.mesh.triangles.size(), 1), twins);
  result.mesh.step = base.mesh.step;
  for (const uint32_t corner : surface.first_corner) result.mesh.lattice.push_back(lattice[base.mesh.triangles[corner / 3][corner % 3]]);
  result.mesh.triangles = std::move(surface.vertices);
  for (const BaseAttribute& a : base.attributes) {
    LACERTA_RETURN_IF_ERROR(CheckAttribute(a, lattice.size(), base.group_sizes.size()).WithContext("attribute " + a.precision.name + " of the base"));
    result.attributes.push_back(GlueAttribute(base, result.groups, twins, a));
  }
  return result;
}

}  // namespace lacerta
