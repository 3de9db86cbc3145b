#include "pack/replace_geometry.h"

#include <optional>
#include <utility>

#include "decoder/smooth_normals.h"
#include "document/buffer_edit.h"
#include "extension/progressive.h"

namespace lacerta {
namespace {

void Require(const char* extension, bool is_needed, GltfDocument* document) {
  for (const char* list : {"extensionsUsed", "extensionsRequired"}) {
    if (is_needed) {
      AddExtension(list, extension, document);
    } else {
      RemoveExtension(list, extension, document);
    }
  }
}

// Whether an accessor among those of attributes by name is of a type that the attribute has by KHR_mesh_quantization alone.
bool NeedQuantization(const Json* references, const GltfDocument& document) {
  if (references == nullptr || !references->is_object()) return false;
  for (const auto& [name, index] : references->items()) {
    const std::optional<uint64_t> number = AsIndex(&index);
    const Json* accessor = number.has_value() ? FindElement(document.json, "accessors", *number) : nullptr;
    if (accessor == nullptr) continue;
    const StatusOr<ComponentType> type = ParseComponentType(*accessor);
    if (!type.ok() || type.value() == ComponentType::kFloat) continue;
    if (name == "POSITION" || name == "NORMAL" || name == "TANGENT") return true;
    const bool is_core = IsTrue(Find(*accessor, "normalized")) && (type.value() == ComponentType::kUint8 || type.value() == ComponentType::kUint16);
    if (name.rfind("TEXCOORD_", 0) == 0 && !is_core) return true;
  }
  return false;
}

}  // namespace

NewGeometry PlainGeometry(const TriangleMesh& mesh, bool with_normals, GltfDocument* document) {
  NewGeometry geometry;
  geometry.attributes.push_back(
      {"POSITION", MakeAccessor(MakeFloatAccessor(mesh.positions), AccessorUse::kAttribute, true, document)});
  if (with_normals) {
    const AccessorData normals = MakeFloatAccessor(SmoothNormals(mesh.positions, mesh.triangles));
    geometry.attributes.push_back({"NORMAL", MakeAccessor(normals, AccessorUse::kAttribute, false, document)});
  }
  geometry.indices =
      MakeAccessor(MakeIndexAccessor(mesh.triangles, mesh.positions.size()), AccessorUse::kIndices, false, document);
  return geometry;
}

NewGeometry PlainGeometry(const Primitive& primitive, GltfDocument* document) {
  NewGeometry geometry;
  for (const Attribute& attribute : primitive.attributes) {
    const bool bounds = attribute.name == "POSITION";
    geometry.attributes.push_back(
        {attribute.name, MakeAccessor(attribute.data, AccessorUse::kAttribute, bounds, document)});
  }
  geometry.indices = MakeAccessor(MakeIndexAccessor(primitive.triangles, primitive.num_vertices), AccessorUse::kIndices,
                                  false, document);
  return geometry;
}

NewGeometry DescribedGeometry(const TriangleMesh& mesh) {
  NewGeometry geometry;
  geometry.attributes.push_back({"POSITION", DescribeAccessor(MakeFloatAccessor(mesh.positions), true)});
  geometry.indices = DescribeAccessor(MakeIndexAccessor(mesh.triangles, mesh.positions.size()), false);
  return geometry;
}

NewGeometry DescribedGeometry(const Primitive& primitive) {
  NewGeometry geometry;
  for (const Attribute& attribute : primitive.attributes) {
    geometry.attributes.push_back({attribute.name, DescribeAccessor(attribute.data, attribute.name == "POSITION")});
  }
  geometry.indices = DescribeAccessor(MakeIndexAccessor(primitive.triangles, primitive.num_vertices), false);
  return geometry;
}

std::vector<std::vector<NamedAccessor>> TargetAccessors(const std::vector<MorphTarget>& targets, GltfDocument* document) {
  const auto has_bounds = [](const Attribute& attribute) { return attribute.name == "POSITION"; };
  std::vector<SparseSource> sources;
  for (const MorphTarget& target : targets) {
    for (const Attribute& attribute : target) {
      if (SparseIsSmaller(attribute.data)) sources.push_back({&attribute.data, has_bounds(attribute)});
    }
  }
  std::vector<Json> sparse = MakeSparseAccessors(sources, document);
  size_t next = 0;
  std::vector<std::vector<NamedAccessor>> result;
  for (const MorphTarget& target : targets) {
    std::vector<NamedAccessor> accessors;
    for (const Attribute& attribute : target) {
      const bool is_sparse = next < sources.size() && sources[next].data == &attribute.data;
      accessors.push_back({attribute.name, is_sparse ? std::move(sparse[next++])
                                                     : MakeAccessor(attribute.data, AccessorUse::kAttribute, has_bounds(attribute), document)});
    }
    result.push_back(std::move(accessors));
  }
  return result;
}

void ReplaceGeometry(const std::vector<Place>& geometries, const std::vector<Place>& places, NewGeometry geometry,
                     AccessorPool* pool, GltfDocument* document) {
  const Json old = PrimitiveAt(document, places[0]);
  const bool with_targets = !geometry.targets.empty();
  for (const Place& place : geometries) {
    const Json released = PrimitiveAt(document, place);
    pool->Release(released, with_targets, document);
  }
  const auto put_all = [&](std::vector<NamedAccessor>& accessors, const Json* old_references) {
    Json references = Json::object();
    for (NamedAccessor& accessor : accessors) {
      const std::optional<uint64_t> preferred =
          old_references == nullptr ? std::nullopt : AsIndex(Find(*old_references, accessor.name.c_str()));
      references[accessor.name] = pool->Put(std::move(accessor.json), preferred, document);
    }
    return references;
  };
  const Json attributes = put_all(geometry.attributes, Find(old, "attributes"));
  Json targets = Json::array();
  for (size_t t = 0; t < geometry.targets.size(); ++t) {
    targets.push_back(put_all(geometry.targets[t], FindElement(old, "targets", t)));
  }
  const uint64_t indices = pool->Put(std::move(geometry.indices), AsIndex(Find(old, "indices")), document);
  for (const Place& place : places) {
    Json& primitive = PrimitiveAt(document, place);
    primitive["attributes"] = attributes;
    primitive["indices"] = indices;
    if (with_targets) primitive["targets"] = targets;
    primitive.erase("mode");  // triangles are the default
    if (Json* extensions = Find(primitive, "extensions"); extensions != nullptr && extensions->is_object()) {
      extensions->erase(kDracoName);
      extensions->erase(kProgressiveName);
      if (extensions->empty()) primitive.erase("extensions");
    }
    if (!geometry.extensions.empty()) primitive["extensions"].update(geometry.extensions);
  }
}

std::set<uint64_t> DracoViews(const GltfDocument& document) {
  std::set<uint64_t> views;
  for (const Place& place : AllPlaces(document)) {
    const Json* draco = FindExtension(PrimitiveAt(document, place), kDracoName);
    if (draco == nullptr) continue;
    if (const std::optional<uint64_t> view = AsIndex(Find(*draco, "bufferView")); view.has_value()) views.insert(*view);
  }
  return views;
}

void DeclareDraco(GltfDocument* document) { Require(kDracoName, !DracoViews(*document).empty(), document); }

void DeclareQuantization(GltfDocument* document) {
  bool is_needed = false;
  for (const Place& place : AllPlaces(*document)) {
    const Json& primitive = PrimitiveAt(*document, place);
    is_needed = is_needed || NeedQuantization(Find(primitive, "attributes"), *document);
    for (uint64_t t = 0; t < ArraySize(primitive, "targets"); ++t) {
      is_needed = is_needed || NeedQuantization(FindElement(primitive, "targets", t), *document);
    }
  }
  Require("KHR_mesh_quantization", is_needed, document);
}

}  // namespace lacerta
