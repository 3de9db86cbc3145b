#include <gtest/gtest.h>

#include "bench/heap_meter.h"
#include "draco/zero_level_search.h"
#include "shapes/base_meshes.h"
#include "shapes/shapes.h"

namespace lacerta {
namespace {

// However many sizes are tried, one of them is kept, and none has more than its triangles where there are too many to be fitted.
TEST(ZeroLevelMemoryTest, IsThatOfAFewMeshes) {
  const TriangleMesh mesh = shapes::Scattered(shapes::Tetrahedron(), 25'000);
  const SurfaceDistanceMeter meter = SurfaceDistanceMeter::Create(mesh).value();
  const size_t before = HeapInUse();
  ResetHeapPeak();
  const ZeroLevelStream stream = CodeZeroLevel(mesh, meter, {false, 0, 62}).value();
  EXPECT_TRUE(stream.meets_target);
  const double bytes_each = static_cast<double>(HeapPeak() - before) / static_cast<double>(mesh.triangles.size());
  EXPECT_GT(bytes_each, 100.0);
  EXPECT_LT(bytes_each, 600.0);  // 2,000 with all sizes kept
}

}  // namespace
}  // namespace lacerta
