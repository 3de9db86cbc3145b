#include "encoder/quantizer.h"

#include <limits>

namespace lacerta {

BaseMesh RoundToLattice(const TriangleMesh& mesh, float step) {
  float extent = 0;
  for (const Vec3f& p : mesh.positions) extent = std::max({extent, std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
  // Lattice values below 2^16 times a step of 8 bits are exact in the 24 bits of a float.
  constexpr float kMaxLatticePoint = 65535.0f;
  const float least = std::max(extent / kMaxLatticePoint * 1.01f, std::numeric_limits<float>::min());
  int exponent = 0;
  const float wanted = std::min(std::max(least, step), std::numeric_limits<float>::max());  // in this order NaN gives `least`
  const float significand = std::frexp(wanted, &exponent);
  const float shortened = std::ldexp(std::floor(std::ldexp(significand, 8)), exponent - 8);
  BaseMesh base;
  base.step = shortened >= least ? shortened : std::ldexp(std::ceil(std::ldexp(significand, 8)), exponent - 8);
  base.triangles = mesh.triangles;
  for (const Vec3f& p : mesh.positions) {
    std::array<int32_t, 3> q;
    for (int c = 0; c < 3; ++c) q[static_cast<size_t>(c)] = static_cast<int32_t>(std::lround(p[c] / base.step));
    base.lattice.push_back(q);
  }
  return base;
}

}  // namespace lacerta
