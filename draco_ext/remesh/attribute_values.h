// What values of an attribute may be.
#ifndef LACERTA_REMESH_ATTRIBUTE_VALUES_H_
#define LACERTA_REMESH_ATTRIBUTE_VALUES_H_

#include <algorithm>
#include <cstddef>
#include <limits>
#include <vector>

#include "lacerta/attributed_mesh.h"

namespace lacerta {

// Makes blends of an attribute's values legal again: directions of unit length, weights that are not below 0 and add up to 1, colors in
// the range of those that there are.
class ValueRange {
 public:
  explicit ValueRange(const MeshAttribute& attribute)
      : kind_(attribute.kind),
        low_(attribute.components, std::numeric_limits<float>::infinity()),
        high_(attribute.components, -std::numeric_limits<float>::infinity()) {
    for (size_t i = 0; i < attribute.values.size(); ++i) {
      float &low = low_[i % attribute.components], &high = high_[i % attribute.components];
      low = std::min(low, attribute.values[i]);
      high = std::max(high, attribute.values[i]);
    }
  }

  // row: as many numbers as the attribute has components.
  void Legalize(float* row) const {
    const size_t n = low_.size();
    if ((kind_ == AttributeKind::kNormal || kind_ == AttributeKind::kTangent) && n >= 3) {
      const Vec3f unit = Normalized(Vec3f{row[0], row[1], row[2]});
      for (int i = 0; i < 3; ++i) row[i] = unit[i];
      if (n > 3) row[3] = row[3] < 0 ? -1.0f : 1.0f;
    } else if (kind_ == AttributeKind::kColor) {
      for (size_t i = 0; i < n; ++i) row[i] = std::clamp(row[i], low_[i], high_[i]);
    } else if (kind_ == AttributeKind::kWeights) {
      float sum = 0;
      for (size_t i = 0; i < n; ++i) sum += row[i] = std::max(row[i], 0.0f);
      for (size_t i = 0; i < n && sum > 0; ++i) row[i] /= sum;
    }
  }

 private:
  AttributeKind kind_;
  std::vector<float> low_, high_;  // of each component
};

}  // namespace lacerta

#endif  // LACERTA_REMESH_ATTRIBUTE_VALUES_H_
