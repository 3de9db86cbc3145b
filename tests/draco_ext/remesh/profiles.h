// Sheets that bend along straight lines only, for the tests of creases.
#ifndef LACERTA_TESTS_DRACO_EXT_REMESH_PROFILES_H_
#define LACERTA_TESTS_DRACO_EXT_REMESH_PROFILES_H_

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include "lacerta/mesh.h"

namespace lacerta::testing {

// The polygon with these turns (degrees) between sides of length 1, drawn out along y by `rows` squares. A vertex of
// the mesh is at index row * (turns + 2) + column; column i + 1 is where turn i is.
inline TriangleMesh DrawnOut(const std::vector<double>& turns, uint32_t rows) {
  std::vector<std::array<double, 2>> profile = {{0, 0}, {1, 0}};
  double direction = 0;
  for (const double turn : turns) {
    direction += turn * 3.14159265358979323846 / 180;
    profile.push_back({profile.back()[0] + std::cos(direction), profile.back()[1] + std::sin(direction)});
  }
  TriangleMesh mesh;
  const auto columns = static_cast<uint32_t>(profile.size());
  for (uint32_t r = 0; r <= rows; ++r) {
    for (const auto& [x, z] : profile) {
      mesh.positions.push_back({static_cast<float>(x), static_cast<float>(r), static_cast<float>(z)});
    }
  }
  for (uint32_t r = 0; r < rows; ++r) {
    for (uint32_t c = 0; c + 1 < columns; ++c) {
      const uint32_t a = r * columns + c, b = a + columns;
      mesh.triangles.insert(mesh.triangles.end(), {{a, a + 1, b}, {b, a + 1, b + 1}});
    }
  }
  return mesh;
}

}  // namespace lacerta::testing

#endif  // LACERTA_TESTS_DRACO_EXT_REMESH_PROFILES_H_
