#include "encoder/quantizer.h"

#include <limits>

namespace lacerta {

BaseMesh RoundToLattice(const TriangleMesh& mesh, float step) {
  float extent = 0;
  for (const Vec3f& p : mesh.positions) extent = std::max({extent, std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
  // Lattice points are exact in the 24 bits of a float: far from zero, where lattice values take more than 16, the step has fewer than 8.
  constexpr int kFloatBits = 24, kMostBits = 8, kFewestBits = 2;
  const auto least_step = [&](int bits) {
    return std::max(extent / (std::ldexp(1.0f, kFloatBits - bits) - 1) * 1.01f, std::numeric_limits<float>::min());
  };
  int bits = kMostBits;
  while (bits > kFewestBits && !(step >= least_step(bits))) --bits;
  const float least = least_step(bits);
  int exponent = 0;
  const float wanted = std::min(std::max(least, step), std::numeric_limits<float>::max());  // in this order NaN gives `least`
  const float significand = std::ldexp(std::frexp(wanted, &exponent), bits);
  const float shortened = std::ldexp(std::floor(significand), exponent - bits);
  BaseMesh base;
  base.step = shortened >= least ? shortened : std::ldexp(std::ceil(significand), exponent - bits);
  base.triangles = mesh.triangles;
  for (const Vec3f& p : mesh.positions) {
    std::array<int32_t, 3> q;
    for (int c = 0; c < 3; ++c) q[static_cast<size_t>(c)] = static_cast<int32_t>(std::lround(p[c] / base.step));
    base.lattice.push_back(q);
  }
  return base;
}

}  // namespace lacerta
