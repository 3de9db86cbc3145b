// The points that the values of an attribute may go to, by their coordinates on a lattice.
#ifndef LACERTA_PACK_LATTICE_POINTS_H_
#define LACERTA_PACK_LATTICE_POINTS_H_

#include <draco/compression/attributes/normal_compression_utils.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <optional>

#include "document/lattice.h"
#include "pack/attribute_value.h"

namespace lacerta {

using LatticePoint = std::array<int32_t, 4>;

// Octahedral coordinates of directions.
class LatticeDirections {
 public:
  explicit LatticeDirections(int bits) { box_.SetQuantizationBits(bits); }

  static constexpr int kReach = 2;  // steps that are worth looking at
  static constexpr uint32_t coordinates() { return 2; }
  static constexpr uint32_t components() { return 3; }

  LatticePoint Nearest(const AttributeValue& wanted) const {
    const float direction[3] = {static_cast<float>(wanted[0]), static_cast<float>(wanted[1]), static_cast<float>(wanted[2])};
    LatticePoint point = {};
    box_.FloatVectorToQuantizedOctahedralCoords(direction, point.data(), point.data() + 1);
    return point;
  }

  // Nothing where there is no such point.
  std::optional<AttributeValue> At(const LatticePoint& point) const {
    if (std::min(point[0], point[1]) < 0 || std::max(point[0], point[1]) > box_.max_value()) return std::nullopt;
    int32_t s = 0, t = 0;
    box_.CanonicalizeOctahedralCoords(point[0], point[1], &s, &t);
    if (s != point[0] || t != point[1]) return std::nullopt;
    float direction[3];
    box_.QuantizedOctahedralCoordsToUnitVector(point[0], point[1], direction);
    return AttributeValue{direction[0], direction[1], direction[2], 0.0};
  }

  AttributeValue Stored(const LatticePoint& point) const { return *At(point); }
  const draco::OctahedronToolBox& box() const { return box_; }

 private:
  draco::OctahedronToolBox box_;
};

// Coordinates on a lattice; of TANGENT, a direction and a sign, the first three.
class LatticeNumbers {
 public:
  LatticeNumbers(const Lattice& lattice, uint32_t components, bool is_direction)
      : lattice_(lattice), components_(components), is_direction_(is_direction),
        step_(static_cast<double>(lattice.range) / static_cast<double>(Last())) {}

  static constexpr int kReach = 1;
  uint32_t coordinates() const { return components_; }
  uint32_t components() const { return components_; }
  double step() const { return step_; }

  LatticePoint Nearest(const AttributeValue& wanted) const {
    LatticePoint point = {};
    for (uint32_t c = 0; c < components_; ++c) point[c] = static_cast<int32_t>(lattice_.Round(static_cast<float>(wanted[c]), c));
    return point;
  }

  AttributeValue Stored(const LatticePoint& point) const {
    AttributeValue value = {};
    for (uint32_t c = 0; c < components_; ++c) value[c] = lattice_.At(point[c], c);
    return value;
  }

  std::optional<AttributeValue> At(const LatticePoint& point) const {
    for (uint32_t c = 0; c < components_; ++c) {
      if (point[c] < 0 || point[c] > Last()) return std::nullopt;
    }
    AttributeValue value = Stored(point);
    if (!is_direction_) return value;
    const double length = std::sqrt(Dot(value, value)), most = std::sqrt(0.75) * step_;  // as far from 1 as rounding could make it
    if (std::fabs(length - 1.0) > most || !(length > 0.0)) return std::nullopt;
    for (double& x : value) x /= length;
    return value;
  }

 private:
  int64_t Last() const { return (int64_t{1} << lattice_.bits) - 1; }

  Lattice lattice_;
  uint32_t components_;
  bool is_direction_;
  double step_;
};

}  // namespace lacerta

#endif  // LACERTA_PACK_LATTICE_POINTS_H_
