#include "pack/replace_geometry.h"

#include <utility>

#include "document/buffer_edit.h"
#include "document/normals.h"
#include "extension/progressive.h"

namespace lacerta {

NewGeometry PlainGeometry(const TriangleMesh& mesh, bool with_normals, GltfDocument* document) {
  NewGeometry geometry;
  geometry.attributes.push_back(
      {"POSITION", MakeAccessor(MakeFloatAccessor(mesh.positions), AccessorUse::kAttribute, true, document)});
  if (with_normals) {
    const AccessorData normals = MakeFloatAccessor(DeriveNormals(mesh));
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

void ReplaceGeometry(const std::vector<Place>& places, NewGeometry geometry, AccessorPool* pool,
                     GltfDocument* document) {
  const Json old = PrimitiveAt(document, places[0]);
  pool->Release(old, document);
  const Json* old_attributes = Find(old, "attributes");
  Json attributes = Json::object();
  for (NamedAccessor& attribute : geometry.attributes) {
    const std::optional<uint64_t> preferred =
        old_attributes == nullptr ? std::nullopt : AsIndex(Find(*old_attributes, attribute.name.c_str()));
    attributes[attribute.name] = pool->Put(std::move(attribute.json), preferred, document);
  }
  const uint64_t indices = pool->Put(std::move(geometry.indices), AsIndex(Find(old, "indices")), document);
  for (const Place& place : places) {
    Json& primitive = PrimitiveAt(document, place);
    primitive["attributes"] = attributes;
    primitive["indices"] = indices;
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
