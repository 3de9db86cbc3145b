// The base of a stream with attributes: one Draco stream for each group of faces (docs/format.md, "Attributes").
#ifndef LACERTA_PLUGIN_C_GROUP_BASE_H_
#define LACERTA_PLUGIN_C_GROUP_BASE_H_

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "common/stream_layout.h"
#include "lacerta/attributed_base.h"
#include "lacerta/attributed_mesh.h"
#include "lacerta/decoder.h"
#include "lacerta/status.h"

namespace lacerta {

// What glTF tells of such a stream.
struct GroupOptions {
  std::vector<uint64_t> sizes;     // bytes of the Draco stream of each group; empty: a stream without attributes
  std::vector<std::string> names;  // of the attributes, in the order of the refinement header
};

// What the groups so far have together.
struct GroupTotals {
  size_t vertices = 0, triangles = 0;
  std::vector<uint32_t> components;  // per name, floats per vertex; 0 where no group has it
};

// Adds a group. Fails, and adds nothing, with kLimitExceeded where all together are over the limits, and with kInvalidData where an
// attribute has another number of components than in the groups before.
Status AddGroup(const VertexSoup& group, const GroupOptions& options, const DecodeLimits& limits, GroupTotals* totals);

// Reads the base section. Only where CanReadStockBase(). Fails as ReadStockGroup and AddGroup do.
StatusOr<std::vector<VertexSoup>> ReadGroups(Span<const uint8_t> section, const GroupOptions& options, const DecodeLimits& limits,
                                             GroupTotals* totals);

// The groups as the refinement behind them wants them. Fails with kInvalidData where it has other attributes, or none.
StatusOr<AttributedBase> BaseOfGroups(const std::vector<VertexSoup>& groups, const GroupOptions& options, const RefinementHeader& header);

// The attribute of that name; null where the group has not got it.
const VertexSoup::Attribute* FindAttribute(const std::vector<VertexSoup::Attribute>& attributes, const std::string& name);

}  // namespace lacerta

#endif  // LACERTA_PLUGIN_C_GROUP_BASE_H_
