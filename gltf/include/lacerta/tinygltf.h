// Progressive meshes for hosts that load glTF with tinygltf (tested: 2.7.0): a loaded model in, a refined model out.
//   tinygltf::TinyGLTF loader;
//   loader.LoadBinaryFromFile(&model, &error, &warning, "model.glb");
//   const lacerta::StatusOr<lacerta::RefineResult> refined = lacerta::RefineModel(&model, {});
//
// All of it is inline: it is compiled with the host's own copy of tinygltf and touches nothing but its data types,
// while Lacerta's libraries contain no tinygltf. So the host alone decides on its version and its TINYGLTF_ macros. One
// thing to mind: libdraco.so may export a copy of tinygltf of its own. Compile tinygltf (TINYGLTF_IMPLEMENTATION) into
// the program and do not link libtinygltf.so beside Draco; in a shared library compile it with hidden visibility.
//
// Assets packed with the plain fallback load with any build of tinygltf. Those with the Draco fallback need one with
// TINYGLTF_ENABLE_DRACO: without it tinygltf refuses primitives whose indices have no bufferView. Assets without a
// fallback are refused by every build; unpack them with lacerta/gltf.h before.
#ifndef LACERTA_TINYGLTF_H_
#define LACERTA_TINYGLTF_H_

#ifndef TINY_GLTF_H_  // including it again after TINYGLTF_IMPLEMENTATION would define everything twice
#include <tiny_gltf.h>
#endif

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <locale>
#include <map>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "lacerta/parsed_gltf.h"

namespace lacerta {

struct RefineOptions {
  std::optional<int> max_level;  // stop there (0 is the base); empty: as far as the data goes
  DecodeLimits limits;
};

struct RefineResult {
  int num_refined = 0;  // primitives that show their stream now
  // Which primitives kept their fallback or are coarser than was asked for, each with its mesh and the reason.
  std::vector<std::string> notes;
};

namespace tinygltf_internal {

inline constexpr char kProgressive[] = "LACERTA_mesh_progressive";
inline constexpr char kDraco[] = "KHR_draco_mesh_compression";

// The extensions that are written have ASCII strings only; what else somebody put there becomes a question mark.
inline void WriteString(const std::string& text, std::ostream* out) {
  *out << '"';
  for (const char c : text) {
    if (c == '"' || c == '\\') *out << '\\';
    *out << (c >= ' ' && c <= '~' ? c : '?');
  }
  *out << '"';
}

inline void WriteNumber(double number, std::ostream* out) {
  if (std::isfinite(number)) {
    *out << number;
  } else {
    *out << "null";
  }
}

inline void WriteValue(const tinygltf::Value& value, std::ostream* out) {
  const char* separator = "";
  if (value.IsInt()) {
    *out << value.Get<int>();
  } else if (value.IsNumber()) {
    WriteNumber(value.Get<double>(), out);
  } else if (value.IsBool()) {
    *out << (value.Get<bool>() ? "true" : "false");
  } else if (value.IsString()) {
    WriteString(value.Get<std::string>(), out);
  } else if (value.IsArray()) {
    *out << '[';
    for (const tinygltf::Value& element : value.Get<tinygltf::Value::Array>()) {
      *out << std::exchange(separator, ",");
      WriteValue(element, out);
    }
    *out << ']';
  } else if (value.IsObject()) {
    *out << '{';
    for (const auto& [key, element] : value.Get<tinygltf::Value::Object>()) {
      *out << std::exchange(separator, ",");
      WriteString(key, out);
      *out << ':';
      WriteValue(element, out);
    }
    *out << '}';
  } else {
    *out << "null";
  }
}

// The two extensions that matter, of those that are there.
inline void WriteExtensions(const tinygltf::ExtensionMap& extensions, std::ostream* out) {
  *out << "\"extensions\":{";
  const char* separator = "";
  for (const char* name : {kProgressive, kDraco}) {
    const auto found = extensions.find(name);
    if (found == extensions.end()) continue;
    *out << std::exchange(separator, ",") << '"' << name << "\":";
    WriteValue(found->second, out);
  }
  *out << '}';
}

inline void WriteAccessor(const tinygltf::Accessor& accessor, std::ostream* out) {
  *out << "{\"count\":" << accessor.count;
  if (accessor.bufferView >= 0) *out << ",\"bufferView\":" << accessor.bufferView;
  for (const auto& [key, values] : {std::pair("min", &accessor.minValues), std::pair("max", &accessor.maxValues)}) {
    if (values->empty()) continue;
    *out << ",\"" << key << "\":[";
    const char* separator = "";
    for (const double value : *values) {
      *out << std::exchange(separator, ",");
      WriteNumber(value, out);
    }
    *out << ']';
  }
  *out << '}';
}

inline void WriteView(const tinygltf::BufferView& view, std::ostream* out) {
  *out << "{\"buffer\":" << view.buffer << ",\"byteOffset\":" << view.byteOffset
       << ",\"byteLength\":" << view.byteLength << '}';
}

inline void WriteReferences(const std::map<std::string, int>& accessors, std::ostream* out) {
  *out << '{';
  const char* separator = "";
  for (const auto& [name, accessor] : accessors) {
    *out << std::exchange(separator, ",");
    WriteString(name, out);
    *out << ':' << accessor;
  }
  *out << '}';
}

inline void WritePrimitive(const tinygltf::Primitive& primitive, std::ostream* out) {
  const char* separator = "";
  *out << "{\"attributes\":";
  WriteReferences(primitive.attributes, out);
  if (primitive.indices >= 0) *out << ",\"indices\":" << primitive.indices;
  if (!primitive.targets.empty()) {
    *out << ",\"targets\":[";
    separator = "";
    for (const std::map<std::string, int>& target : primitive.targets) {
      *out << std::exchange(separator, ",");
      WriteReferences(target, out);
    }
    *out << ']';
  }
  *out << ',';
  WriteExtensions(primitive.extensions, out);
  *out << '}';
}

inline void WriteMesh(const tinygltf::Mesh& mesh, std::ostream* out) {
  *out << "{\"primitives\":[";
  const char* separator = "";
  for (const tinygltf::Primitive& primitive : mesh.primitives) {
    *out << std::exchange(separator, ",");
    WritePrimitive(primitive, out);
  }
  *out << "]}";
}

template <typename Element>
void WriteArray(const char* key, const std::vector<Element>& elements,
                void (*write)(const Element& element, std::ostream* out), std::ostream* out) {
  *out << ",\"" << key << "\":[";
  const char* separator = "";
  for (const Element& element : elements) {
    *out << std::exchange(separator, ",");
    write(element, out);
  }
  *out << ']';
}

// As much of the asset's JSON as RefineParsedGltf asks for.
inline std::string WriteJson(const tinygltf::Model& model) {
  std::ostringstream out;
  out.imbue(std::locale::classic());
  out.precision(17);
  out << "{\"asset\":{\"version\":\"2.0\"},";
  WriteExtensions(model.extensions, &out);
  WriteArray("bufferViews", model.bufferViews, WriteView, &out);
  WriteArray("accessors", model.accessors, WriteAccessor, &out);
  WriteArray("meshes", model.meshes, WriteMesh, &out);
  out << '}';
  return out.str();
}

// Appends `bytes` to the buffer at the end of the model, with a view and an accessor of their own, and returns the
// accessor, still without its bounds.
inline int AddAccessor(const Bytes& bytes, int component_type, int type, uint64_t count, int target,
                       tinygltf::Model* model) {
  std::vector<unsigned char>& data = model->buffers.back().data;
  tinygltf::BufferView view;
  view.buffer = static_cast<int>(model->buffers.size()) - 1;
  view.byteOffset = data.size();
  view.byteLength = bytes.size();
  view.target = target;
  data.insert(data.end(), bytes.begin(), bytes.end());
  data.resize((data.size() + 3) / 4 * 4);
  model->bufferViews.push_back(std::move(view));
  tinygltf::Accessor accessor;
  accessor.bufferView = static_cast<int>(model->bufferViews.size()) - 1;
  accessor.byteOffset = 0;
  accessor.normalized = false;
  accessor.componentType = component_type;
  accessor.type = type;
  accessor.count = static_cast<size_t>(count);
  model->accessors.push_back(std::move(accessor));
  return static_cast<int>(model->accessors.size()) - 1;
}

// Of rows of three floats, at least one.
inline void SetBounds(const Bytes& values, tinygltf::Accessor* accessor) {
  std::vector<float> numbers(values.size() / sizeof(float));
  std::memcpy(numbers.data(), values.data(), numbers.size() * sizeof(float));
  accessor->minValues.assign(numbers.begin(), numbers.begin() + 3);
  accessor->maxValues = accessor->minValues;
  for (size_t i = 0; i < numbers.size(); ++i) {
    accessor->minValues[i % 3] = std::min(accessor->minValues[i % 3], static_cast<double>(numbers[i]));
    accessor->maxValues[i % 3] = std::max(accessor->maxValues[i % 3], static_cast<double>(numbers[i]));
  }
}

inline void ShowGeometry(const RefinedGeometry& geometry, tinygltf::Model* model) {
  std::map<std::string, int> attributes;
  const int position = AddAccessor(geometry.positions, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3,
                                   geometry.num_vertices, TINYGLTF_TARGET_ARRAY_BUFFER, model);
  tinygltf::Accessor& bounds = model->accessors.back();
  bounds.minValues = {geometry.min.x, geometry.min.y, geometry.min.z};
  bounds.maxValues = {geometry.max.x, geometry.max.y, geometry.max.z};
  attributes["POSITION"] = position;
  if (!geometry.normals.empty()) {
    attributes["NORMAL"] = AddAccessor(geometry.normals, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3,
                                       geometry.num_vertices, TINYGLTF_TARGET_ARRAY_BUFFER, model);
  }
  for (const RefinedAttribute& attribute : geometry.attributes) {
    // tinygltf's TINYGLTF_TYPE_VEC2 to VEC4 are the numbers of components.
    const int type = attribute.components == 1 ? TINYGLTF_TYPE_SCALAR : static_cast<int>(attribute.components);
    attributes[attribute.name] = AddAccessor(attribute.values, static_cast<int>(attribute.component_type), type,
                                             geometry.num_vertices, TINYGLTF_TARGET_ARRAY_BUFFER, model);
  }
  std::vector<std::map<std::string, int>> targets;
  for (const std::vector<RefinedAttribute>& target : geometry.targets) {
    targets.emplace_back();
    for (const RefinedAttribute& offsets : target) {
      targets.back()[offsets.name] = AddAccessor(offsets.values, TINYGLTF_COMPONENT_TYPE_FLOAT, TINYGLTF_TYPE_VEC3,
                                                 geometry.num_vertices, TINYGLTF_TARGET_ARRAY_BUFFER, model);
      if (offsets.name == "POSITION") SetBounds(offsets.values, &model->accessors.back());
    }
  }
  const int indices = AddAccessor(geometry.indices, static_cast<int>(geometry.index_type), TINYGLTF_TYPE_SCALAR,
                                  geometry.num_indices, TINYGLTF_TARGET_ELEMENT_ARRAY_BUFFER, model);
  for (const PrimitiveIndex& index : geometry.primitives) {
    tinygltf::Primitive& primitive =
        model->meshes[static_cast<size_t>(index.mesh)].primitives[static_cast<size_t>(index.primitive)];
    primitive.attributes = attributes;
    primitive.indices = indices;
    primitive.targets = targets;
    primitive.mode = TINYGLTF_MODE_TRIANGLES;
    primitive.extensions.erase(kProgressive);
    primitive.extensions.erase(kDraco);
  }
}

// Takes `name` off the lists of the asset when no primitive has it any more.
inline void DropUnusedExtension(const char* name, tinygltf::Model* model) {
  for (const tinygltf::Mesh& mesh : model->meshes) {
    for (const tinygltf::Primitive& primitive : mesh.primitives) {
      if (primitive.extensions.count(name) > 0) return;
    }
  }
  for (std::vector<std::string>* list : {&model->extensionsUsed, &model->extensionsRequired}) {
    list->erase(std::remove(list->begin(), list->end(), name), list->end());
  }
  model->extensions.erase(name);
}

inline std::string Describe(const tinygltf::Model& model, const RefinedGeometry& geometry) {
  const PrimitiveIndex& index = geometry.primitives[0];
  const std::string& name = model.meshes[static_cast<size_t>(index.mesh)].name;
  return "mesh " + std::to_string(index.mesh) + (name.empty() ? "" : " (" + name + ")") + ", primitive " +
         std::to_string(index.primitive) + ": " + geometry.note;
}

}  // namespace tinygltf_internal

// Gives every primitive with LACERTA_mesh_progressive the geometry of its stream: new accessors for POSITION, for the
// indices, for what else the stream carries, morph targets among it, and, where the extension says so, for NORMAL, in a
// new buffer at the end of the model. The primitive loses the extension, and KHR_draco_mesh_compression with it; both
// leave extensionsUsed and extensionsRequired when nothing uses them any more. All else stays as it is, the stream's
// bytes and the accessors of the fallback included. Primitives whose stream is damaged, or does not fit the fallback
// any more, keep their fallback and the extension, and are named in the notes. Bytes of the stream that are missing end
// in a coarser level and a note. Fails, with the model untouched, with kInvalidArgument for a negative level and with
// kInvalidData or kUnsupported where a primitive has neither a usable stream nor a fallback. Safe on untrusted models.
inline StatusOr<RefineResult> RefineModel(tinygltf::Model* model, const RefineOptions& options) {
  namespace internal = tinygltf_internal;
  std::vector<Span<const uint8_t>> buffers;
  for (const tinygltf::Buffer& buffer : model->buffers) buffers.push_back(buffer.data);
  UnpackOptions unpack;
  unpack.level = options.max_level;
  unpack.limits = options.limits;
  LACERTA_ASSIGN_OR_RETURN(const std::vector<RefinedGeometry> geometries,
                           RefineParsedGltf(internal::WriteJson(*model), buffers, unpack));
  RefineResult result;
  for (const RefinedGeometry& geometry : geometries) {
    if (!geometry.note.empty()) result.notes.push_back(internal::Describe(*model, geometry));
    if (geometry.from_fallback) continue;
    if (result.num_refined == 0) model->buffers.emplace_back();
    internal::ShowGeometry(geometry, model);
    result.num_refined += static_cast<int>(geometry.primitives.size());
  }
  if (result.num_refined > 0) {
    internal::DropUnusedExtension(internal::kProgressive, model);
    internal::DropUnusedExtension(internal::kDraco, model);
  }
  return result;
}

}  // namespace lacerta

#endif  // LACERTA_TINYGLTF_H_
