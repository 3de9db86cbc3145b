// Any bytes as an asset before packing: every reader that the packer has for accessors (sparse, quantized, compressed with meshopt or
// Draco), morph targets, groups and scenes, what measures and rounds attributes and, of assets of a few triangles, the whole packer.
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "fuzz/fuzz_input.h"
#include "fuzz/strange_asset.h"
#include "lacerta/gltf.h"
#include "pack/repair.h"
#include "pack/source.h"

namespace {

using lacerta::Attribute;

// Returns the number of triangles.
size_t CheckSource(const lacerta::Source& source) {
  FUZZ_CHECK(!source.places.empty() && source.geometries.size() <= source.places.size());
  if (!source.primitive.has_value()) {
    FUZZ_CHECK(!source.reason.empty());
    return 0;
  }
  const lacerta::Primitive& primitive = *source.primitive;
  for (const lacerta::Triangle& triangle : primitive.triangles) {
    for (const uint32_t index : triangle) FUZZ_CHECK(index < primitive.num_vertices);
  }
  const auto check = [&](const Attribute& attribute) {
    FUZZ_CHECK(attribute.data.count == primitive.num_vertices);
    FUZZ_CHECK(attribute.data.bytes.size() == attribute.data.count * attribute.data.components * ComponentSize(attribute.data.type));
  };
  for (const Attribute& attribute : primitive.attributes) check(attribute);
  for (const lacerta::MorphTarget& target : source.targets) {
    for (const Attribute& attribute : target) check(attribute);
  }
  for (const lacerta::Vec3f& p : Surface(primitive).positions) {
    FUZZ_CHECK(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
  }
  return primitive.triangles.size();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const lacerta::Span<const uint8_t> asset(data, size);
  const auto document = lacerta::ParseGltf(asset, lacerta::fuzz::kNoFolder);
  if (!document.ok()) {
    FUZZ_CHECK(!document.status().message().empty());
    return 0;
  }
  lacerta::GltfDocument mended = document.value();
  const auto notes = RepairDocument(&mended);
  if (notes.ok()) {  // nothing is left to be mended, and what was read before still is
    FUZZ_CHECK(RepairDocument(&mended).ok() && RepairDocument(&mended).value().empty());
    FUZZ_CHECK(ReadSources(mended).ok() || !ReadSources(document.value()).ok());
  }
  const auto sources = ReadSources(document.value());
  const auto used = ReadSources(document.value(), {true, true});
  FUZZ_CHECK(used.ok() == sources.ok());
  if (!sources.ok()) return 0;
  for (const lacerta::Source& source : used.value()) CheckSource(source);
  size_t num_triangles = 0;
  for (const lacerta::Source& source : sources.value()) num_triangles += CheckSource(source);
  lacerta::fuzz::CheckPackingOfFew(asset, num_triangles);
  return 0;
}
