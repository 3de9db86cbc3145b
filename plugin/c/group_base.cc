#include "group_base.h"

#include <algorithm>
#include <utility>

#include "base_reader.h"
#include "decoder/level_limits.h"

namespace lacerta {

const VertexSoup::Attribute* FindAttribute(const std::vector<VertexSoup::Attribute>& attributes, const std::string& name) {
  for (const VertexSoup::Attribute& a : attributes) {
    if (a.name == name) return &a;
  }
  return nullptr;
}

Status AddGroup(const VertexSoup& group, const GroupOptions& options, const DecodeLimits& limits, GroupTotals* totals) {
  GroupTotals sum = *totals;
  sum.vertices += group.positions.size();
  sum.triangles += group.triangles.size();
  LACERTA_RETURN_IF_ERROR(CheckBaseFits(sum.vertices, sum.triangles, limits));
  sum.components.resize(options.names.size());
  for (size_t i = 0; i < options.names.size(); ++i) {
    const VertexSoup::Attribute* const a = FindAttribute(group.attributes, options.names[i]);
    if (a == nullptr) continue;
    if (sum.components[i] == 0) sum.components[i] = a->components;
    if (sum.components[i] != a->components) return InvalidData("attribute " + a->name + " has not as many components in every group");
  }
  *totals = std::move(sum);
  return Status();
}

StatusOr<std::vector<VertexSoup>> ReadGroups(Span<const uint8_t> section, const GroupOptions& options, const DecodeLimits& limits,
                                             GroupTotals* totals) {
  std::vector<VertexSoup> groups;
  size_t begin = 0;
  for (const uint64_t size : options.sizes) {
    const Span<const uint8_t> part = section.Subspan(begin).First(static_cast<size_t>(size));
    LACERTA_ASSIGN_OR_RETURN(VertexSoup group, ReadStockGroup(part, options.names, limits));
    LACERTA_RETURN_IF_ERROR(AddGroup(group, options, limits, totals));
    groups.push_back(std::move(group));
    begin += part.size();
  }
  return groups;
}

StatusOr<AttributedBase> BaseOfGroups(const std::vector<VertexSoup>& groups, const GroupOptions& options, const RefinementHeader& header) {
  const auto is_named = [](const AttributeHeader& a, const std::string& name) { return a.precision.name == name; };
  if (!header.is_attributed || !std::equal(header.attributes.begin(), header.attributes.end(), options.names.begin(), options.names.end(), is_named)) {
    return InvalidData("the refinement does not carry the attributes that were announced");
  }
  if (header.base_step == 0) return InvalidData("the refinement header does not tell the step of the base lattice");
  std::vector<AttributeLattice> precision;
  for (const AttributeHeader& a : header.attributes) precision.push_back(a.precision);
  return AttributedBaseFromSoups(groups, header.base_step, precision);
}

}  // namespace lacerta
