// Linear equations of which only products with vectors are known.
#ifndef LACERTA_REMESH_CONJUGATE_GRADIENTS_H_
#define LACERTA_REMESH_CONJUGATE_GRADIENTS_H_

#include <cstddef>
#include <type_traits>
#include <utility>
#include <vector>

#include "lacerta/mesh.h"

namespace lacerta {

// About x of A x = right, from zero. A: symmetric, positive semidefinite; apply(x) is A x. Entries are numbers or Vec3d.
template <typename Entry, typename Apply>
std::vector<Entry> ConjugateGradients(std::vector<Entry> right, int rounds, const Apply& apply) {
  const auto dot = [](const std::vector<Entry>& a, const std::vector<Entry>& b) {
    double sum = 0.0;
    for (size_t i = 0; i < a.size(); ++i) {
      if constexpr (std::is_same_v<Entry, double>) {
        sum += a[i] * b[i];
      } else {
        sum += Dot(a[i], b[i]);
      }
    }
    return sum;
  };
  std::vector<Entry> x(right.size()), rest = std::move(right), direction = rest;
  double square = dot(rest, rest);
  for (int round = 0; round < rounds && square > 0.0; ++round) {
    const std::vector<Entry> image = apply(direction);
    const double curvature = dot(direction, image);
    if (!(curvature > 0.0)) break;
    const double step = square / curvature;
    for (size_t i = 0; i < x.size(); ++i) {
      x[i] += direction[i] * step;
      rest[i] -= image[i] * step;
    }
    const double next = dot(rest, rest);
    for (size_t i = 0; i < x.size(); ++i) direction[i] = rest[i] + direction[i] * (next / square);
    square = next;
  }
  return x;
}

}  // namespace lacerta

#endif  // LACERTA_REMESH_CONJUGATE_GRADIENTS_H_
