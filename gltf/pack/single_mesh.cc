#include "pack/single_mesh.h"

#include <utility>

#include "document/buffer_edit.h"
#include "lacerta/gltf.h"
#include "pack/replace_geometry.h"

namespace lacerta {

GltfDocument SingleMeshDocument(const TriangleMesh& mesh, const std::string& name) {
  GltfDocument document;
  document.json["asset"] = {{"version", "2.0"}, {"generator", "Lacerta"}};
  document.json["scene"] = 0;
  document.json["scenes"] = Json::array({{{"nodes", {0}}}});
  Json node = {{"mesh", 0}};
  Json mesh_json = Json::object();
  if (!name.empty()) {
    node["name"] = name;
    mesh_json["name"] = name;
  }
  document.json["nodes"] = Json::array({std::move(node)});
  NewGeometry geometry = PlainGeometry(mesh, false, &document);
  const uint64_t position = AddAccessor(std::move(geometry.attributes[0].json), &document);
  const uint64_t indices = AddAccessor(std::move(geometry.indices), &document);
  mesh_json["primitives"] = Json::array({{{"attributes", {{"POSITION", position}}}, {"indices", indices}}});
  document.json["meshes"] = Json::array({std::move(mesh_json)});
  return document;
}

StatusOr<Bytes> FormatPlainGlb(const TriangleMesh& mesh, const std::string& name) {
  GltfDocument document = SingleMeshDocument(mesh, name);
  LACERTA_RETURN_IF_ERROR(MergeBuffers(&document));
  return FormatGlb(document);
}

}  // namespace lacerta
