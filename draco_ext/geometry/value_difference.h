// How far two values of an attribute are apart.
#ifndef LACERTA_GEOMETRY_VALUE_DIFFERENCE_H_
#define LACERTA_GEOMETRY_VALUE_DIFFERENCE_H_

#include <cmath>

#include "lacerta/attributed_mesh.h"

namespace lacerta {

inline constexpr double kDegreesPerRadian = 57.29577951308232;

inline double DegreesBetween(const Vec3d& a, const Vec3d& b) {
  const double norm_a = Norm(a), norm_b = Norm(b);
  if (norm_a == 0 && norm_b == 0) return 0;
  if (norm_a == 0 || norm_b == 0) return 90;  // a vector without direction is as far from all
  return kDegreesPerRadian * std::atan2(Norm(Cross(a, b)), Dot(a, b));
}

// In the units of AttributeError, with textures of `texture_size`. a, b: attribute.components numbers.
template <typename T>
double ErrorBetween(const MeshAttribute& attribute, double texture_size, const T* a, const T* b) {
  const auto at = [](const T* x, size_t i) { return static_cast<double>(x[i]); };
  if (IsDirection(attribute.kind) && attribute.components >= 3) {
    if (attribute.components > 3 && (a[3] < 0) != (b[3] < 0)) return 180;
    return DegreesBetween({at(a, 0), at(a, 1), at(a, 2)}, {at(b, 0), at(b, 1), at(b, 2)});
  }
  double sum = 0;
  for (size_t i = 0; i < attribute.components; ++i) sum += (at(a, i) - at(b, i)) * (at(a, i) - at(b, i));
  return std::sqrt(sum) * (attribute.kind == AttributeKind::kTextureCoordinates ? texture_size : 1.0);
}

}  // namespace lacerta

#endif  // LACERTA_GEOMETRY_VALUE_DIFFERENCE_H_
