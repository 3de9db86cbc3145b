#include "bench/gltf_surfaces.h"

#include <cstdio>
#include <filesystem>
#include <utility>

#include "document/place.h"
#include "document/primitive.h"
#include "lacerta/file_io.h"

namespace lacerta {
namespace {

AttributeKind KindOf(const std::string& name) {
  const auto begins_with = [&](const char* prefix) { return name.rfind(prefix, 0) == 0; };
  if (begins_with("TEXCOORD_")) return AttributeKind::kTextureCoordinates;
  if (begins_with("COLOR_")) return AttributeKind::kColor;
  if (name == "NORMAL") return AttributeKind::kNormal;
  return name == "TANGENT" ? AttributeKind::kTangent : AttributeKind::kGeneric;
}

}  // namespace

VertexSoup ToSoup(const Primitive& primitive) {
  VertexSoup soup;
  TriangleMesh surface = Surface(primitive);
  soup.positions = std::move(surface.positions);
  soup.triangles = std::move(surface.triangles);
  for (const Attribute& attribute : primitive.attributes) {
    if (attribute.name == "POSITION" || attribute.name.rfind("JOINTS", 0) == 0 || attribute.name.rfind("WEIGHTS", 0) == 0) continue;
    VertexSoup::Attribute own{attribute.name, KindOf(attribute.name), attribute.data.components, {}};
    for (uint64_t v = 0; v < primitive.num_vertices; ++v) {
      for (uint32_t c = 0; c < own.components; ++c) own.values.push_back(attribute.data.Float(v, c));
    }
    soup.attributes.push_back(std::move(own));
  }
  return soup;
}

StatusOr<std::vector<NamedSurface>> ReadGltfSurfaces(const std::string& path) {
  LACERTA_ASSIGN_OR_RETURN(const Bytes bytes, ReadFile(path));
  LACERTA_ASSIGN_OR_RETURN(const GltfDocument document, ParseGltf(bytes, std::filesystem::path(path).parent_path().string()));
  std::vector<NamedSurface> result;
  for (uint64_t m = 0; m < ArraySize(document.json, "meshes"); ++m) {
    std::vector<VertexSoup> soups;
    for (const Place& place : AllPlaces(document)) {
      if (place.mesh != m) continue;
      const StatusOr<Primitive> primitive = ReadPrimitive(document, PrimitiveAt(document, place), DecodeLimits());
      if (primitive.ok()) {
        soups.push_back(ToSoup(primitive.value()));
      } else if (primitive.status().code() != StatusCode::kUnsupported) {
        return primitive.status().WithContext(PlaceName(document, place));
      }
    }
    if (soups.empty()) continue;
    LACERTA_ASSIGN_OR_RETURN(AttributedMesh mesh, WeldSoups(soups));
    result.push_back({std::filesystem::path(path).stem().string() + ":" + std::to_string(m), std::move(mesh)});
  }
  return result;
}

int ReportSurfaces(CLI::App* options, int argc, char** argv, const std::function<Status(const NamedSurface&)>& report) {
  std::vector<std::string> paths;
  options->add_option("FILE", paths, "glTF assets")->required();
  CLI11_PARSE(*options, argc, argv);
  int failures = 0;
  for (const std::string& path : paths) {
    const StatusOr<std::vector<NamedSurface>> surfaces = ReadGltfSurfaces(path);
    if (!surfaces.ok()) {
      std::fprintf(stderr, "%s\n", surfaces.status().message().c_str());
      ++failures;
      continue;
    }
    for (const NamedSurface& surface : surfaces.value()) {
      const Status status = report(surface);
      if (!status.ok()) std::fprintf(stderr, "%s\n", status.WithContext(surface.name).message().c_str());
    }
  }
  return failures == 0 ? 0 : 1;
}

}  // namespace lacerta
