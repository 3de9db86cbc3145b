#include "pack/replace_geometry.h"

#include <utility>

#include "decoder/smooth_normals.h"
#include "document/buffer_edit.h"
#include "extension/progressive.h"

namespace lacerta {

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
    const Json* draco = PrimitiveExtension(PrimitiveAt(document, place), kDracoName);
    if (draco == nullptr) continue;
    if (const std::optional<uint64_t> view = AsIndex(Find(*draco, "bufferView")); view.has_value()) views.insert(*view);
  }
  return views;
}

void DeclareDraco(GltfDocument* document) {
  const bool used = !DracoViews(*document).empty();
  for (const char* list : {"extensionsUsed", "extensionsRequired"}) {
    if (used) {
      AddExtension(list, kDracoName, document);
    } else {
      RemoveExtension(list, kDracoName, document);
    }
  }
}

}  // namespace lacerta
