// Values of an attribute as vectors whose differences are errors.
#ifndef LACERTA_PACK_ATTRIBUTE_VALUE_H_
#define LACERTA_PACK_ATTRIBUTE_VALUE_H_

#include <array>
#include <cstdint>
#include <cstring>

#include "document/accessor.h"

namespace lacerta {

inline constexpr uint32_t kMostComponents = 4;

using AttributeValue = std::array<double, kMostComponents>;

inline AttributeValue operator-(const AttributeValue& a, const AttributeValue& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2], a[3] - b[3]}; }
inline AttributeValue operator+(const AttributeValue& a, const AttributeValue& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2], a[3] + b[3]}; }
inline AttributeValue operator*(double s, const AttributeValue& a) { return {s * a[0], s * a[1], s * a[2], s * a[3]}; }
inline double Dot(const AttributeValue& a, const AttributeValue& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]; }

// Mean over a triangle of |e|^2 with e linear between its corners.
inline double MeanSquare(const AttributeValue& a, const AttributeValue& b, const AttributeValue& c) {
  return (Dot(a, a) + Dot(b, b) + Dot(c, c) + Dot(a, b) + Dot(b, c) + Dot(c, a)) / 6.0;
}

// Of directions the first three components, of length 1 or 0; up to four of others.
inline AttributeValue ValueAt(const AccessorData& data, uint64_t element, bool is_direction) {
  if (is_direction) {
    const Vec3d unit = Normalized(Vec3Cast<double>(VectorAt(data, element)));
    return {unit.x, unit.y, unit.z, 0.0};
  }
  AttributeValue value = {};
  for (uint32_t c = 0; c < data.components; ++c) value[c] = data.Float(element, c);
  return value;
}

// The first `components` of a value in float data.
inline void StoreValue(const AttributeValue& value, uint32_t components, uint64_t element, AccessorData* data) {
  for (uint32_t c = 0; c < components; ++c) {
    const auto number = static_cast<float>(value[c]);
    std::memcpy(data->bytes.data() + (element * data->components + c) * sizeof(float), &number, sizeof(number));
  }
}

}  // namespace lacerta

#endif  // LACERTA_PACK_ATTRIBUTE_VALUE_H_
