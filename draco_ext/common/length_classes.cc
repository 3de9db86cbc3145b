#include "common/length_classes.h"

#include <cstddef>

namespace lacerta {
namespace {

uint64_t SquaredLength(const std::array<int32_t, 3>& a, const std::array<int32_t, 3>& b) {
  uint64_t sum = 0;
  for (size_t k = 0; k < 3; ++k) {
    const int64_t d = int64_t{a[k]} - b[k];
    sum += static_cast<uint64_t>(d * d);
  }
  return sum;
}

}  // namespace

std::vector<uint8_t> LengthClasses(const Topology& base, Span<const std::array<int32_t, 3>> lattice) {
  std::vector<uint64_t> squares(base.num_edges());
  uint64_t sum = 0;  // modulo 2^64, as all that follows
  for (size_t e = 0; e < squares.size(); ++e) {
    squares[e] = SquaredLength(lattice[base.edges[e][0]], lattice[base.edges[e][1]]);
    sum += squares[e];
  }
  std::vector<uint8_t> classes(squares.size());
  for (size_t e = 0; e < squares.size(); ++e) {
    const uint64_t twice = 2 * squares[e] * squares.size();
    classes[e] = twice < sum ? kShortLength : twice > 3 * sum ? kLongLength : kUsualLength;
  }
  return classes;
}

}  // namespace lacerta
