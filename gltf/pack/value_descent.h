// Which lattice points the values of an attribute go to: not those next to them, but those of the least squared error + slope * bits
// (rate-distortion optimized quantization). Bits are those of stock Draco's predictions, about.
#ifndef LACERTA_PACK_VALUE_DESCENT_H_
#define LACERTA_PACK_VALUE_DESCENT_H_

#include <memory>
#include <vector>

#include "document/primitive.h"
#include "lacerta/mesh.h"
#include "pack/rounded_attributes.h"

namespace lacerta {

class ValueDescent {
 public:
  // An attribute of `primitives` that is shown, whose parts should be `values`, in the steps of `level`, at most kMostLevel; `positions` are those of each
  // primitive, rounded. Values go no farther off than `most_error` (in the unit of the attribute's target), but for those that are farther from the lattice
  // point next to them, and normals turn from no triangle that they do not turn from there. What parts have in common, where primitives touch, goes to the point
  // next to it.
  ValueDescent(const std::vector<const Primitive*>& primitives, const std::vector<std::vector<Vec3f>>& positions, const RoundedAttribute& attribute,
               const std::vector<AccessorData>& values, int level, double most_error);
  ~ValueDescent();

  // Of each part the values, on lattice points, in the order of its primitive's vertices. slope: what a bit is worth, as mean over the area of the squared error
  // in the unit of the target; >= 0.
  std::vector<AccessorData> At(double slope) const;

  // How many values the parts have once those that are equal at a vertex are one.
  size_t num_values() const;

 private:
  class Part;
  template <typename Points, typename Prediction>
  class PartOf;
  static std::unique_ptr<Part> MakePart(const Primitive& primitive, const std::vector<Vec3f>& positions, const RoundedAttribute& attribute,
                                        const RoundedAttribute::Part& part, const AccessorData& values, int level);
  void FixCommonValues(const std::vector<float>& rows);

  double unit_;   // of the target, of a difference of 1
  double most2_;  // of a squared difference
  double area_ = 0.0;
  std::vector<std::unique_ptr<Part>> parts_;
};

}  // namespace lacerta

#endif  // LACERTA_PACK_VALUE_DESCENT_H_
