// Between the plain structs and arrays of lacerta.h and our own types.
#ifndef LACERTA_PLUGIN_C_CALLER_DATA_H_
#define LACERTA_PLUGIN_C_CALLER_DATA_H_

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "group_base.h"
#include "lacerta.h"
#include "lacerta/attributed_mesh.h"
#include "lacerta/mesh.h"
#include "lacerta/status.h"
#include "shown_level.h"
#include "stream_decoder.h"

namespace lacerta {

// What the options tell of groups, and how long the base section is then; false where it makes no sense.
bool ReadGroupOptions(const lacerta_decoder_options& options, GroupOptions* groups, uint64_t* base_size);

// Vertices and triangles of the host's base. Fails with kInvalidArgument where a triangle refers to a vertex that is not there.
Status ReadBase(const float* positions, uint32_t num_vertices, const uint32_t* indices, uint32_t num_triangles,
                std::vector<Vec3f>* vertices, std::vector<Triangle>* triangles);
// The same with attributes; names: of GroupOptions.
StatusOr<VertexSoup> ReadBaseGroup(const lacerta_base_group& base, const std::vector<std::string>& names);

// The attribute of that name; null where the view has not got it.
const VertexSoup::Attribute* AttributeOf(const LevelView& view, const std::string& name);

// Writes a group of a level, or all of them; nothing where it fails.
Status WriteMesh(StreamDecoder* stream, int level, std::optional<size_t> group, const lacerta_mesh_buffers& buffers);

}  // namespace lacerta

#endif  // LACERTA_PLUGIN_C_CALLER_DATA_H_
