#include <gtest/gtest.h>

#include "bench/heap_meter.h"
#include "remesh/attribute_fit.h"
#include "shapes/attributed_shapes.h"

namespace lacerta {
namespace {

// Dozens of faces of a dense original are near every sample; one of them is looked at.
TEST(FitAttributesMemoryTest, DoesNotGrowWithTheFacesNearASample) {
  const AttributedMesh original = WeldSoups({shapes::TexturedGrid(240, 240)}).value();
  AttributedMesh mesh = WeldSoups({shapes::TexturedGrid(12, 12)}).value();
  const GroupSurface surface(original);
  AttributeFitOptions options;
  options.num_samples = 60'000;
  options.seam_distance = 0.02;  // 5 squares
  const size_t before = HeapInUse();
  ResetHeapPeak();
  FitAttributes(surface, options, &mesh);
  const double bytes_each = static_cast<double>(HeapPeak() - before) / static_cast<double>(options.num_samples);
  EXPECT_GT(bytes_each, 50.0);
  EXPECT_LT(bytes_each, 400.0);  // 49 points take 980
}

}  // namespace
}  // namespace lacerta
