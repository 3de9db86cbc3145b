// Any bytes as a mesh file; the first byte picks the format. What is read is sound: finite, indices in range, no larger than the
// file allows, and what lies on the surface likewise. Seeds are in seeds/mesh_file_fuzzer.
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "fuzz/fuzz_input.h"
#include "lacerta/mesh_file.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  if (size == 0) return 0;
  constexpr lacerta::MeshFormat kFormats[] = {lacerta::MeshFormat::kPly, lacerta::MeshFormat::kObj, lacerta::MeshFormat::kOff,
                                              lacerta::MeshFormat::kStl};
  const lacerta::MeshFormat format = kFormats[data[0] % 4];
  const auto mesh = lacerta::ParseMesh({data + 1, size - 1}, format);
  const auto file = lacerta::ParseFileMesh({data + 1, size - 1}, format, "no-such-folder");
  FUZZ_CHECK(file.ok() == mesh.ok());
  const auto repaired = lacerta::ParseFileMesh({data + 1, size - 1}, format, "no-such-folder", true);
  FUZZ_CHECK(repaired.ok() || !mesh.ok());
  if (repaired.ok()) {
    FUZZ_CHECK(!repaired.value().mesh.surface.triangles.empty() && lacerta::CheckAttributedMesh(repaired.value().mesh).ok());
    FUZZ_CHECK(repaired.value().mesh.groups.size() == repaired.value().mesh.surface.triangles.size());
  }
  if (!mesh.ok()) {
    FUZZ_CHECK(!mesh.status().message().empty());
    return 0;
  }
  FUZZ_CHECK(!mesh.value().triangles.empty());
  FUZZ_CHECK(mesh.value().positions.size() <= size && mesh.value().triangles.size() <= size);
  for (const lacerta::Triangle& triangle : mesh.value().triangles) {
    for (const uint32_t index : triangle) FUZZ_CHECK(index < mesh.value().positions.size());
  }
  for (const lacerta::Vec3f& p : mesh.value().positions) {
    FUZZ_CHECK(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
  }
  FUZZ_CHECK(lacerta::CheckAttributedMesh(file.value().mesh).ok());
  FUZZ_CHECK(file.value().mesh.groups.size() == mesh.value().triangles.size());
  for (const uint32_t group : file.value().mesh.groups) FUZZ_CHECK(group < file.value().group_materials.size());
  return 0;
}
