#include "document/references.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>
#include <string>

namespace lacerta {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::StartsWith;

// Arrays of one element each, which all references refer to; no other number is 0.
Json Document() {
  return Json::parse(R"({
    "scene": 0,
    "scenes": [{"nodes": [0]}],
    "nodes": [{"children": [0], "mesh": 0, "skin": 0, "camera": 0,
               "extensions": {"KHR_lights_punctual": {"light": 0}, "EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": 0}}}}],
    "cameras": [{"type": "perspective"}],
    "skins": [{"joints": [0], "skeleton": 0, "inverseBindMatrices": 0}],
    "animations": [{"samplers": [{"input": 0, "output": 0}], "channels": [{"sampler": 0, "target": {"node": 0, "path": "weights"}}]}],
    "meshes": [{"primitives": [{"indices": 0, "attributes": {"POSITION": 0}, "targets": [{"POSITION": 0}], "material": 0,
                "extensions": {"KHR_draco_mesh_compression": {"bufferView": 0, "attributes": {"POSITION": 7}},
                               "KHR_materials_variants": {"mappings": [{"material": 0, "variants": [0]}]}}}]}],
    "materials": [{"pbrMetallicRoughness": {"baseColorTexture": {"index": 0, "texCoord": 7}}, "normalTexture": {"index": 0},
                   "extensions": {"KHR_materials_sheen": {"sheenColorTexture": {"index": 0}}}, "extras": {"oldTexture": {"index": 5}}}],
    "textures": [{"source": 0, "sampler": 0, "extensions": {"KHR_texture_basisu": {"source": 0}, "EXT_texture_webp": {"source": 0},
                  "EXT_texture_avif": {"source": 0}, "MSFT_texture_dds": {"source": 0}}}],
    "images": [{"bufferView": 0}],
    "samplers": [{"wrapS": 10497}],
    "accessors": [{"bufferView": 0, "count": 3, "sparse": {"count": 1, "indices": {"bufferView": 0}, "values": {"bufferView": 0}}}],
    "bufferViews": [{"buffer": 0}],
    "buffers": [{"byteLength": 40}],
    "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point"}]}, "KHR_materials_variants": {"variants": [{"name": "red"}]}}})");
}

TEST(References, EachIsFoundWhereWhatItRefersToIsMissing) {
  const Json document = Document();
  EXPECT_THAT(DanglingReferences(document), IsEmpty());
  EXPECT_TRUE(CheckReferences(document).ok());
  const Json leaves = document.flatten();
  int num_references = 0;
  for (const auto& [pointer, value] : leaves.items()) {
    if (value != 0) continue;
    ++num_references;
    Json changed = document;
    Json& reference = changed[Json::json_pointer(pointer)];
    reference = 1;
    EXPECT_THAT(DanglingReferences(changed), ElementsAre(StartsWith(pointer + " refers to /"))) << pointer;
    reference = std::numeric_limits<uint64_t>::max();
    EXPECT_THAT(DanglingReferences(changed), ElementsAre(HasSubstr("18446744073709551615"))) << pointer;
    for (const Json& no_index : {Json(-1), Json("0"), Json(nullptr), Json(0.5), Json::object()}) {
      reference = no_index;
      EXPECT_THAT(DanglingReferences(changed), IsEmpty()) << pointer;
    }
  }
  EXPECT_EQ(num_references, 36);
}

TEST(References, MissingArraysAreEmpty) {
  Json document = Document();
  document.erase("materials");
  document["bufferViews"] = "none";
  const Status status = CheckReferences(document);
  EXPECT_EQ(status.code(), StatusCode::kInvalidData);
  EXPECT_THAT(status.message(), HasSubstr("/meshes/0/primitives/0/material refers to /materials/0, which does not exist, and 6 more like it"));
  EXPECT_THAT(DanglingReferences(Json::object()), IsEmpty());
  EXPECT_THAT(DanglingReferences(Json(7)), IsEmpty());
}

}  // namespace
}  // namespace lacerta
