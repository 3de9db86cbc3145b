// The original mesh coded in one piece [Touma, Gotsman 1998]: connectivity by the product's valence coder, quantized
// positions by parallelograms. Departs from the paper, which bends the parallelogram by an estimated crease angle.
#ifndef LACERTA_TESTS_BASELINES_SINGLE_RATE_H_
#define LACERTA_TESTS_BASELINES_SINGLE_RATE_H_

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/subdivision.h"
#include "lacerta/mesh.h"
#include "lacerta/status.h"

namespace lacerta::baselines {

using Point = std::array<int32_t, 3>;

// The points of a mesh whose vertices are in the order in which its triangles were grown: each is expected at the
// fourth corner of a parallelogram over a triangle of earlier vertices, where there is one, else at an earlier
// neighbor, else at the origin.
Bytes EncodeByParallelograms(const Topology& topology, const std::vector<Point>& points);
std::vector<Point> DecodeByParallelograms(const Topology& topology, Span<const uint8_t> stream);

struct SingleRateMesh {
  size_t bytes = 0;   // connectivity and positions
  TriangleMesh mesh;  // as decoded
};

// bits: of the longest side of the bounding box, 1 to 20. Fails as EncodeCompactBase does.
StatusOr<SingleRateMesh> CodeSingleRate(const TriangleMesh& mesh, int bits);

}  // namespace lacerta::baselines

#endif  // LACERTA_TESTS_BASELINES_SINGLE_RATE_H_
