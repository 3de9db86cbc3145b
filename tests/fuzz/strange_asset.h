// Any bytes as an asset, for the fuzz targets of the packer.
#ifndef LACERTA_TESTS_FUZZ_STRANGE_ASSET_H_
#define LACERTA_TESTS_FUZZ_STRANGE_ASSET_H_

#include <cstddef>
#include <cstdint>

#include "fuzz/fuzz_input.h"
#include "lacerta/gltf.h"

namespace lacerta::fuzz {

inline constexpr char kNoFolder[] = "/nonexistent";  // external buffers are not for these tests

// Packs and unpacks an asset of a few triangles. A search of levels or of simplified surfaces takes a second; readers and rounding are what
// strangers' bytes reach first.
inline void CheckPackingOfFew(Span<const uint8_t> asset, size_t num_triangles) {
  constexpr size_t kMostTriangles = 8;
  if (num_triangles > kMostTriangles) return;
  PackOptions options;
  options.folder = kNoFolder;
  options.encode.effort = Effort::kFast;
  options.encode.levels = LevelChoice::kNever;
  options.simplify = false;
  const auto packed = PackGltf(asset, options);
  FUZZ_CHECK(packed.ok() || !packed.status().message().empty());
  if (packed.ok()) FUZZ_CHECK(UnpackGltf(packed.value().glb, {}).ok());
}

}  // namespace lacerta::fuzz

#endif  // LACERTA_TESTS_FUZZ_STRANGE_ASSET_H_
