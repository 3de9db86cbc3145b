#include "caller_data.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "common/attribute_layout.h"
#include "decoder/smooth_normals.h"

namespace lacerta {
namespace {

static_assert(sizeof(Vec3f) == 3 * sizeof(float) && sizeof(Triangle) == 3 * sizeof(uint32_t), "copied as they are");

template <typename Element>
void Copy(Span<const Element> from, void* to) {
  if (to != nullptr && !from.empty()) std::memcpy(to, from.data(), from.size() * sizeof(Element));
}

// Normals of a view: of the whole surface, which `all` is; the view's vertices are those of `all` from `first` on.
void WriteNormals(const LevelView& all, size_t first, size_t count, float* to) {
  const std::vector<Vec3f> normals = SmoothNormals(all.positions, all.triangles);
  Copy(Span<const Vec3f>(normals.data() + first, count), to);
}

}  // namespace

bool ReadGroupOptions(const lacerta_decoder_options& options, GroupOptions* groups, uint64_t* base_size) {
  constexpr uint32_t kMostAttributes = 32;  // bits of lacerta_mesh_size.attributes
  if (options.num_groups == 0) return options.num_attributes == 0;
  if (options.base_lengths == nullptr || options.num_attributes > kMostAttributes) return false;
  if (options.num_attributes > 0 && options.attribute_names == nullptr) return false;
  uint64_t sum = 0;
  for (uint32_t g = 0; g < options.num_groups; ++g) {
    if (options.base_lengths[g] > SIZE_MAX / 2 - sum) return false;
    sum += options.base_lengths[g];
  }
  if (sum == 0 || (options.base_size != 0 && options.base_size != sum)) return false;
  *base_size = sum;
  groups->sizes.assign(options.base_lengths, options.base_lengths + options.num_groups);
  for (uint32_t i = 0; i < options.num_attributes; ++i) {
    const char* const name = options.attribute_names[i];
    std::vector<std::string>& names = groups->names;
    if (name == nullptr || std::strlen(name) >= sizeof(lacerta_attribute::name) || std::find(names.begin(), names.end(), name) != names.end()) return false;
    names.emplace_back(name);
  }
  return true;
}

Status ReadBase(const float* positions, uint32_t num_vertices, const uint32_t* indices, uint32_t num_triangles,
                std::vector<Vec3f>* vertices, std::vector<Triangle>* triangles) {
  if (positions == nullptr || indices == nullptr) return InvalidArgument("positions or indices is NULL");
  vertices->resize(num_vertices);
  triangles->resize(num_triangles);
  std::memcpy(static_cast<void*>(vertices->data()), positions, num_vertices * sizeof(Vec3f));
  std::memcpy(triangles->data(), indices, num_triangles * sizeof(Triangle));
  for (uint32_t i = 0; i < num_triangles; ++i) {
    const Triangle& t = (*triangles)[i];
    if (*std::max_element(t.begin(), t.end()) < num_vertices) continue;
    return InvalidArgument("triangle " + std::to_string(i) + " of the base has a vertex that is not there");
  }
  return Status();
}

StatusOr<VertexSoup> ReadBaseGroup(const lacerta_base_group& base, const std::vector<std::string>& names) {
  VertexSoup soup;
  LACERTA_RETURN_IF_ERROR(ReadBase(base.positions, base.num_vertices, base.indices, base.num_triangles, &soup.positions, &soup.triangles));
  const bool has_attributes = base.attributes != nullptr && base.components != nullptr;
  for (size_t i = 0; has_attributes && i < std::min<size_t>(base.num_attributes, names.size()); ++i) {
    const float* const values = base.attributes[i];
    if (values == nullptr) continue;
    const uint32_t components = base.components[i];
    if (components == 0 || components > kMostComponents) return InvalidArgument("attribute " + names[i] + " has an illegal number of components");
    soup.attributes.push_back({names[i], AttributeKind::kGeneric, components, {values, values + size_t{components} * base.num_vertices}});
  }
  return soup;
}

const VertexSoup::Attribute* AttributeOf(const LevelView& view, const std::string& name) {
  return view.attributes == nullptr ? nullptr : FindAttribute(*view.attributes, name);
}

Status WriteMesh(StreamDecoder* stream, int level, std::optional<size_t> group, const lacerta_mesh_buffers& buffers) {
  LACERTA_ASSIGN_OR_RETURN(const LevelView view, stream->ViewOf(level, group));
  if (buffers.max_vertices < view.positions.size() || buffers.max_triangles < view.triangles.size()) {
    return InvalidArgument("the buffers are too small: the mesh has " + std::to_string(view.positions.size()) + " vertices and " +
                                    std::to_string(view.triangles.size()) + " triangles");
  }
  Copy(view.positions, buffers.positions);
  Copy(view.triangles, buffers.indices);
  const size_t num_attributes = buffers.attributes == nullptr ? 0 : std::min<size_t>(buffers.num_attributes, stream->attribute_names().size());
  for (size_t i = 0; i < num_attributes; ++i) {
    if (buffers.attributes[i] == nullptr) continue;
    if (const auto* attribute = AttributeOf(view, stream->attribute_names()[i]); attribute != nullptr) {
      Copy(Span<const float>(attribute->values), buffers.attributes[i]);
    } else {
      std::fill_n(buffers.attributes[i], view.positions.size() * stream->components_of(i), 0.0f);
    }
  }
  if (buffers.normals == nullptr) return Status();
  size_t first = 0;
  const size_t count = view.positions.size();
  for (size_t g = 0; group && g < *group; ++g) {
    LACERTA_ASSIGN_OR_RETURN(const LevelView before, stream->ViewOf(level, g));
    first += before.positions.size();
  }
  LACERTA_ASSIGN_OR_RETURN(const LevelView all, stream->ViewOf(level, std::nullopt));
  WriteNormals(all, first, count, buffers.normals);
  return Status();
}

}  // namespace lacerta
