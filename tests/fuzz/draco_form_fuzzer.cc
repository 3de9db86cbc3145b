// Any bytes as a stream of either form: decoded or refused, within the limits, and what is decoded is sound. Seeds are
// in seeds/draco_form_fuzzer. Most of the time goes to stock Draco's own decoder, which reads the base.
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "fuzz/fuzz_input.h"
#include "lacerta/codec.h"
#include "lacerta/draco.h"

namespace {

void CheckMesh(const lacerta::TriangleMesh& mesh, const lacerta::DecodeLimits& limits) {
  FUZZ_CHECK(mesh.triangles.size() <= limits.max_triangles);
  for (const lacerta::Triangle& t : mesh.triangles) {
    for (const uint32_t v : t) FUZZ_CHECK(v < mesh.positions.size());
  }
  for (const lacerta::Vec3f& p : mesh.positions) {
    FUZZ_CHECK(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  lacerta::DecodeOptions options;
  options.limits.max_vertices = options.limits.max_triangles = 1 << 16;
  const auto decoded = lacerta::DecodeMesh({data, size}, options);
  if (decoded.ok()) CheckMesh(decoded.value().mesh, options.limits);

  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(data), size);
  lacerta::Decoder decoder(options);
  const auto mesh = decoder.DecodeMeshFromBuffer(&buffer);
  FUZZ_CHECK(mesh.ok() == decoded.ok());
  if (mesh.ok()) FUZZ_CHECK(decoder.level() == decoded.value().level);
  return 0;
}
