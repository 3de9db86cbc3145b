// Meshes for the tests of the Draco layer: small shapes with one property each, and the real ones where they are to be
// had.
#ifndef LACERTA_TESTS_DRACO_EXT_DRACO_TEST_MESHES_H_
#define LACERTA_TESTS_DRACO_EXT_DRACO_TEST_MESHES_H_

#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "draco_ext/encoder/test_streams.h"
#include "lacerta/decoder.h"
#include "lacerta/mesh.h"
#include "shapes/real_meshes.h"

namespace lacerta::testing {

// Two closed components; the second one shares all lattice points with the first but no vertex.
inline BaseMesh TwoOctahedra() {
  BaseMesh base = Octahedron();
  const auto count = static_cast<uint32_t>(base.lattice.size());
  const BaseMesh one = base;
  base.lattice.insert(base.lattice.end(), one.lattice.begin(), one.lattice.end());
  for (const Triangle& t : one.triangles) base.triangles.push_back({{t[0] + count, t[1] + count, t[2] + count}});
  return base;
}

// A closed real mesh rounded to a lattice of 2^bits steps along its longest side.
inline BaseMesh OnLattice(const TriangleMesh& mesh, int bits, float (*round_step)(float)) {
  float low = mesh.positions[0].x, high = low;
  for (const Vec3f& p : mesh.positions) {
    for (int c = 0; c < 3; ++c) {
      low = std::fmin(low, p[c]);
      high = std::fmax(high, p[c]);
    }
  }
  BaseMesh base;
  base.step = round_step(std::ldexp(high - low, -bits));
  for (const Vec3f& p : mesh.positions) {
    std::array<int32_t, 3> point{};
    for (int c = 0; c < 3; ++c) point[static_cast<size_t>(c)] = static_cast<int32_t>(std::lround(p[c] / base.step));
    base.lattice.push_back(point);
  }
  base.triangles = mesh.triangles;
  return base;
}

// Whether two floats are the same bits.
inline bool SameBits(const std::vector<Vec3f>& a, const std::vector<Vec3f>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(Vec3f)) == 0;
}

}  // namespace lacerta::testing

#endif  // LACERTA_TESTS_DRACO_EXT_DRACO_TEST_MESHES_H_
