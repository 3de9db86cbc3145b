// Small assets for tests, made as JSON and bytes.
#ifndef LACERTA_TESTS_GLTF_TEST_ASSETS_H_
#define LACERTA_TESTS_GLTF_TEST_ASSETS_H_

#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "document/accessor.h"
#include "document/buffer_edit.h"
#include "document/merge_buffers.h"
#include "document/gltf_document.h"
#include "lacerta/mesh.h"

namespace lacerta::testing {

// A wavy sphere of radius about 1 around `center`: closed, smooth.
inline TriangleMesh WavySphere(uint32_t rings, uint32_t sectors, Vec3f center = {}) {
  TriangleMesh mesh;
  constexpr double kPi = 3.141592653589793;
  const auto add = [&](double polar, double azimuth) {
    const double radius = 1.0 + 0.1 * std::sin(3 * azimuth) * std::sin(polar) * std::sin(polar);
    mesh.positions.push_back(
        center + Vec3Cast<float>(Vec3d{radius * std::sin(polar) * std::cos(azimuth),
                                       radius * std::sin(polar) * std::sin(azimuth), radius * std::cos(polar)}));
  };
  add(0, 0);
  for (uint32_t r = 1; r < rings; ++r) {
    for (uint32_t s = 0; s < sectors; ++s) add(kPi * r / rings, 2 * kPi * s / sectors);
  }
  add(kPi, 0);
  const auto at = [&](uint32_t r, uint32_t s) { return 1 + (r - 1) * sectors + s % sectors; };
  const uint32_t last = 1 + (rings - 1) * sectors;
  for (uint32_t s = 0; s < sectors; ++s) {
    mesh.triangles.push_back({0, at(1, s), at(1, s + 1)});
    for (uint32_t r = 1; r + 1 < rings; ++r) {
      mesh.triangles.push_back({at(r, s), at(r + 1, s), at(r + 1, s + 1)});
      mesh.triangles.push_back({at(r, s), at(r + 1, s + 1), at(r, s + 1)});
    }
    mesh.triangles.push_back({last, at(rings - 1, s + 1), at(rings - 1, s)});
  }
  return mesh;
}

// An asset with one scene of nodes without transforms, one per mesh that is added, and things that have to pass
// through.
class AssetBuilder {
 public:
  AssetBuilder() {
    document_.json = Json::parse(R"({"asset": {"version": "2.0", "extras": {"id": 9007199254740993, "nothing": null}},
      "scene": 0, "scenes": [{"nodes": []}], "nodes": [], "meshes": [],
      "materials": [{"name": "red", "extensions": {"VENDOR_paint": {"layers": [1, 4294967295, {}]}}}],
      "animations": [], "unknownToEveryone": [1.5, "x"]})");
  }

  uint64_t AddFloats(const std::vector<Vec3f>& values, bool bounds) {
    return AddAccessor(MakeAccessor(MakeFloatAccessor(values), AccessorUse::kAttribute, bounds, &document_),
                       &document_);
  }
  uint64_t AddIndices(const TriangleMesh& mesh) {
    return AddAccessor(MakeAccessor(MakeIndexAccessor(mesh.triangles, mesh.positions.size()), AccessorUse::kIndices,
                                    false, &document_),
                       &document_);
  }
  Json Primitive(const TriangleMesh& mesh) {
    return {{"attributes", {{"POSITION", AddFloats(mesh.positions, true)}}},
            {"indices", AddIndices(mesh)},
            {"material", 0}};
  }
  void AddMesh(const std::string& name, Json primitives) {
    Json& json = document_.json;
    json["scenes"][0]["nodes"].push_back(json["nodes"].size());
    json["nodes"].push_back({{"mesh", json["meshes"].size()}, {"extras", {{"tag", name}}}});
    json["meshes"].push_back({{"name", name}, {"primitives", std::move(primitives)}});
  }
  GltfDocument& document() { return document_; }
  Bytes Glb() const {
    GltfDocument copy = document_;
    const Status status = MergeBuffers(&copy);
    return status.ok() ? FormatGlb(copy) : Bytes();
  }

 private:
  GltfDocument document_;
};

inline Json JsonOf(const Bytes& glb) { return ParseGltf(glb, "").value().json; }

}  // namespace lacerta::testing

#endif  // LACERTA_TESTS_GLTF_TEST_ASSETS_H_
