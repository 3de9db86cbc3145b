// Memory that runs out while packing is an error like any other: at whatever block that happens, nothing crashes, nothing is kept.
#include <gtest/gtest.h>

#include <optional>

#include "bench/heap_meter.h"
#include "lacerta/codec.h"
#include "lacerta/gltf.h"
#include "shapes/attributed_shapes.h"
#include "shapes/shapes.h"

namespace lacerta {
namespace {

// Runs `work` with less and less memory beyond what is in use: at most what it takes there is a result, the same whenever there is one, and else the
// error. work: () -> StatusOr<Result>; bytes_of: (Result) -> its bytes.
template <typename Work, typename BytesOf>
void ExpectErrorsBelowThePeak(const Work& work, const BytesOf& bytes_of) {
  const Bytes expected = bytes_of(work().value());
  ResetHeapPeak();
  const size_t before = HeapInUse();
  (void)work();
  const size_t peak = HeapPeak() - before;
  ASSERT_GT(peak, 100'000u);
  int failures = 0;
  for (const double share : {1.5, 0.9, 0.75, 0.6, 0.45, 0.3, 0.2, 0.1, 0.05, 0.02}) {
    SCOPED_TRACE(share);
    const size_t in_use = HeapInUse();
    SetHeapLimit(in_use + static_cast<size_t>(share * static_cast<double>(peak)));
    auto result = work();
    SetHeapLimit(0);
    if (result.ok()) {
      EXPECT_EQ(bytes_of(result.value()), expected);
      continue;
    }
    ++failures;
    EXPECT_EQ(result.status().code(), StatusCode::kLimitExceeded) << result.status().message();
    EXPECT_NE(result.status().message().find("not enough memory"), std::string::npos) << result.status().message();
    EXPECT_LT(share, 1.5);
    EXPECT_LE(HeapInUse(), in_use + 100'000);
  }
  EXPECT_GE(failures, 6);
}

TEST(OutOfMemoryTest, EncodeMeshReturnsAnError) {
  const TriangleMesh mesh = shapes::BumpySphere(4);
  EncodeOptions options;
  options.effort = Effort::kFast;
  ExpectErrorsBelowThePeak([&] { return EncodeMesh(mesh, options); }, [](const EncodedMesh& encoded) { return encoded.stream; });
}

TEST(OutOfMemoryTest, PackMeshReturnsAnError) {
  FileMesh mesh;
  mesh.mesh = WeldSoups({shapes::TexturedGrid(12, 12)}).value();
  mesh.group_materials = {FileMesh::kNoMaterial};
  PackOptions options;
  options.encode.effort = Effort::kFast;
  ExpectErrorsBelowThePeak([&] { return PackMesh(mesh, "grid", options); }, [](const PackResult& packed) { return packed.glb; });
}

}  // namespace
}  // namespace lacerta
