// Any bytes as an asset, through every way of reading it. What is read is sound, and what is unpacked can be read again. Seeds are
// in seeds/glb_extension_fuzzer. Part of the time goes to stock Draco's own decoder.
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "fuzz/fuzz_input.h"
#include "lacerta/gltf.h"

namespace {

void CheckMesh(const lacerta::TriangleMesh& mesh) {
  for (const lacerta::Triangle& triangle : mesh.triangles) {
    for (const uint32_t index : triangle) FUZZ_CHECK(index < mesh.positions.size());
  }
  for (const lacerta::Vec3f& p : mesh.positions) {
    FUZZ_CHECK(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  const lacerta::Span<const uint8_t> asset(data, size);
  lacerta::UnpackOptions options;
  options.folder = "/nonexistent";  // external buffers are not for this test
  options.limits.max_vertices = options.limits.max_triangles = 1 << 16;

  const auto info = lacerta::DescribeGltf(asset, options.folder);
  FUZZ_CHECK(info.ok() || !info.status().message().empty());
  const auto surfaces = lacerta::ReadProgressive(asset, options);
  if (surfaces.ok()) {
    for (const lacerta::ProgressiveSurface& surface : surfaces.value()) CheckMesh(surface.surface);
  }
  const auto flat = lacerta::FlattenGltf(asset, options);
  if (flat.ok()) CheckMesh(flat.value().mesh);
  const auto unpacked = lacerta::UnpackGltf(asset, options);
  if (unpacked.ok()) {
    const auto again = lacerta::DescribeGltf(unpacked.value().glb, options.folder);
    FUZZ_CHECK(again.ok() && again.value().streams.empty());
  }
  return 0;
}
