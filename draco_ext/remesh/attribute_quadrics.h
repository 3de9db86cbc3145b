// Quadric errors of an attribute over a surface that moves [Hoppe 1999, "New quadric metric for simplifying meshes with appearance
// attributes"]: at each triangle the attribute is a linear function of space, s(x) = g . x + d, and the error of a vertex at p with
// the value s is the sum of area |g . p + d - s|^2. Given p, the best s follows, and what is left is a quadric of p alone.
#ifndef LACERTA_REMESH_ATTRIBUTE_QUADRICS_H_
#define LACERTA_REMESH_ATTRIBUTE_QUADRICS_H_

#include <array>
#include <cstdint>
#include <vector>

#include "remesh/quadric.h"

namespace lacerta {

// The sums of all nodes of one attribute, as rows of numbers so that merging nodes is adding rows.
class AttributeQuadrics {
 public:
  AttributeQuadrics(uint32_t components, size_t num_nodes)
      : components_(components), sums_(num_nodes * row_size()), triangle_(row_size()) {}

  size_t row_size() const { return kFirstComponent + 4 * size_t{components_}; }
  uint32_t components() const { return components_; }

  void Clear(uint32_t node);
  // Adds a triangle to one node. values[k]: `components` numbers at corner k.
  void AddTriangle(uint32_t node, const std::array<Vec3d, 3>& corners, const std::array<const double*, 3>& values);

  const double* row(uint32_t node) const { return sums_.data() + node * row_size(); }
  double* row(uint32_t node) { return sums_.data() + node * row_size(); }

  // Adds what is left of a row's error when its value is the best for each place.
  void AddReduced(const double* row, Quadric* quadric) const;
  // That value at p. False, and nothing written, where the row has no area.
  bool BestValue(const double* row, const Vec3d& p, double* value) const;

 private:
  // A row: sum of area g g' (xx, xy, xz, yy, yz, zz) and area d g and area d^2 over all components, the area, then for each component
  // area g and area d.
  static constexpr size_t kLinear = 6, kConstant = 9, kArea = 10, kFirstComponent = 11;

  uint32_t components_;
  std::vector<double> sums_;
  std::vector<double> triangle_;  // the row that is added
};

}  // namespace lacerta

#endif  // LACERTA_REMESH_ATTRIBUTE_QUADRICS_H_
