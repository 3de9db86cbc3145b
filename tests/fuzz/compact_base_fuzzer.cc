// A compact base of arbitrary bytes: refused, or decoded within the limits to a mesh that codes to itself again.
#include <cstdlib>

#include "lacerta/decoder.h"
#include "encoder/compact_base_encoder.h"
#include "fuzz/fuzz_input.h"

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
  using namespace lacerta;
  const DecodeLimits limits = {3000, 6000};
  const StatusOr<CompactBase> decoded = DecodeCompactBase({data, size}, limits);
  if (!decoded.ok()) return 0;
  const BaseMesh& mesh = decoded.value().mesh;
  FUZZ_CHECK(mesh.lattice.size() <= limits.max_vertices && mesh.triangles.size() <= limits.max_triangles);
  const StatusOr<CompactBaseBytes> coded = EncodeCompactBase(mesh, decoded.value().offset);
  FUZZ_CHECK(coded.ok());
  const StatusOr<CompactBase> again = DecodeCompactBase(coded.value().bytes, limits);
  FUZZ_CHECK(again.ok());
  FUZZ_CHECK(again.value().mesh.triangles == coded.value().mesh.triangles);
  FUZZ_CHECK(again.value().mesh.lattice == coded.value().mesh.lattice);
  return 0;
}
