#include "pack/single_mesh.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "document/buffer_edit.h"
#include "document/merge_buffers.h"
#include "lacerta/attributed_mesh.h"
#include "lacerta/gltf.h"
#include "pack/replace_geometry.h"

namespace lacerta {
namespace {

// A scene with one node that shows a mesh of these primitives.
void AddScene(Json primitives, const Vec3d& origin, const std::string& name, GltfDocument* document) {
  document->json["asset"] = {{"version", "2.0"}, {"generator", "Lacerta"}};
  document->json["scene"] = 0;
  document->json["scenes"] = Json::array({{{"nodes", {0}}}});
  Json node = {{"mesh", 0}};
  if (origin != Vec3d{}) node["translation"] = {origin.x, origin.y, origin.z};
  Json mesh = {{"primitives", std::move(primitives)}};
  if (!name.empty()) node["name"] = mesh["name"] = name;
  document->json["nodes"] = Json::array({std::move(node)});
  document->json["meshes"] = Json::array({std::move(mesh)});
}

Json AddPrimitive(NewGeometry geometry, GltfDocument* document) {
  Json attributes = Json::object();
  for (NamedAccessor& attribute : geometry.attributes) attributes[attribute.name] = AddAccessor(std::move(attribute.json), document);
  return {{"attributes", std::move(attributes)}, {"indices", AddAccessor(std::move(geometry.indices), document)}};
}

Primitive ToPrimitive(const VertexSoup& soup) {
  Primitive primitive;
  primitive.num_vertices = soup.positions.size();
  primitive.triangles = soup.triangles;
  primitive.attributes.push_back({"POSITION", MakeFloatAccessor(soup.positions)});
  for (const VertexSoup::Attribute& attribute : soup.attributes) {
    primitive.attributes.push_back({attribute.name, MakeFloatAccessor(attribute.values, attribute.components)});
  }
  return primitive;
}

// Every image is a texture of the same index.
Json MaterialJson(const FileMaterial& material) {
  Json surface = {{"baseColorFactor", material.base_color}, {"metallicFactor", material.metallic}, {"roughnessFactor", material.roughness}};
  if (material.base_color_image) surface["baseColorTexture"] = {{"index", *material.base_color_image}};
  Json json = {{"pbrMetallicRoughness", std::move(surface)}};
  if (!material.name.empty()) json["name"] = material.name;
  if (material.emissive != std::array<double, 3>{}) json["emissiveFactor"] = material.emissive;
  if (material.emissive_image) json["emissiveTexture"] = {{"index", *material.emissive_image}};
  if (material.normal_image) json["normalTexture"] = {{"index", *material.normal_image}};
  if (material.base_color[3] < 1) json["alphaMode"] = "BLEND";
  return json;
}

// Surfaces without texture coordinates may not show a texture.
FileMaterial WithoutImages(FileMaterial material) {
  material.base_color_image = material.emissive_image = material.normal_image = std::nullopt;
  return material;
}

// The material of each group as an index of the asset's, or nothing.
std::vector<std::optional<size_t>> AddMaterials(const FileMesh& mesh, const std::vector<VertexSoup>& soups, GltfDocument* document) {
  std::map<std::pair<uint32_t, bool>, size_t> known;  // with images or without
  std::vector<std::optional<size_t>> result;
  for (size_t g = 0; g < soups.size(); ++g) {
    result.emplace_back();
    const uint32_t index = mesh.group_materials[g];
    if (index == FileMesh::kNoMaterial) continue;
    const FileMaterial& material = mesh.materials[index];
    const bool is_textured = std::any_of(soups[g].attributes.begin(), soups[g].attributes.end(), [](const VertexSoup::Attribute& attribute) {
      return attribute.kind == AttributeKind::kTextureCoordinates;
    });
    const auto [found, is_new] = known.emplace(std::make_pair(index, is_textured), known.size());
    if (is_new) document->json["materials"].push_back(MaterialJson(is_textured ? material : WithoutImages(material)));
    result.back() = found->second;
  }
  return result;
}

void AddImages(const FileMesh& mesh, GltfDocument* document) {
  for (size_t i = 0; i < mesh.images.size(); ++i) {
    const FileImage& image = mesh.images[i];
    const uint64_t view = AddBufferView(AddBuffer(image.bytes, document), 0, image.bytes.size(), document);
    document->json["images"].push_back({{"bufferView", view}, {"mimeType", image.mime_type}, {"name", image.name}});
    document->json["textures"].push_back({{"source", i}});
  }
}

StatusOr<Bytes> Format(GltfDocument document) {
  LACERTA_RETURN_IF_ERROR(MergeBuffers(&document));
  return FormatGlb(document);
}

}  // namespace

GltfDocument SingleMeshDocument(const TriangleMesh& mesh, const std::string& name, const Vec3d& origin) {
  GltfDocument document;
  Json primitive = AddPrimitive(PlainGeometry(mesh, false, &document), &document);
  AddScene(Json::array({std::move(primitive)}), origin, name, &document);
  return document;
}

GltfDocument SingleMeshDocument(const FileMesh& mesh, const std::string& name) {
  const bool is_plain = mesh.mesh.attributes.empty() && mesh.group_materials == std::vector<uint32_t>{FileMesh::kNoMaterial};
  if (is_plain) return SingleMeshDocument(mesh.mesh.surface, name, mesh.origin);
  GltfDocument document;
  Json primitives = Json::array();
  const std::vector<VertexSoup> soups = SplitIntoSoups(mesh.mesh, static_cast<uint32_t>(mesh.group_materials.size()));
  const std::vector<std::optional<size_t>> materials = AddMaterials(mesh, soups, &document);
  for (size_t g = 0; g < soups.size(); ++g) {
    primitives.push_back(AddPrimitive(PlainGeometry(ToPrimitive(soups[g]), &document), &document));
    if (materials[g]) primitives.back()["material"] = *materials[g];
  }
  AddImages(mesh, &document);
  AddScene(std::move(primitives), mesh.origin, name, &document);
  return document;
}

StatusOr<Bytes> FormatPlainGlb(const TriangleMesh& mesh, const std::string& name, const Vec3d& origin) {
  return Format(SingleMeshDocument(mesh, name, origin));
}

StatusOr<Bytes> FormatPlainGlb(const FileMesh& mesh, const std::string& name) { return Format(SingleMeshDocument(mesh, name)); }

}  // namespace lacerta
