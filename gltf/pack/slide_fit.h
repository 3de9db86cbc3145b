// What the values of an attribute have to be at vertices that slid along the surface: within a triangle everything is linear, and what moves within its
// plane would take its values with it.
#ifndef LACERTA_PACK_SLIDE_FIT_H_
#define LACERTA_PACK_SLIDE_FIT_H_

#include <utility>
#include <vector>

#include "document/primitive.h"
#include "lacerta/mesh.h"
#include "pack/rounded_attributes.h"

namespace lacerta {

struct SlideFit {
  std::vector<AccessorData> values;                // of each part of the attribute, in the order of its primitive's vertices
  std::vector<std::pair<double, double>> squares;  // of each triangle with area what they are off all the same, squared, and its area
};

// Least squares over the surface.
//   surfaces  of the primitives
//   moved     their positions now
SlideFit FitToSlides(const std::vector<const Primitive*>& primitives, const std::vector<TriangleMesh>& surfaces, const RoundedAttribute& attribute,
                     const std::vector<std::vector<Vec3f>>& moved);

}  // namespace lacerta

#endif  // LACERTA_PACK_SLIDE_FIT_H_
