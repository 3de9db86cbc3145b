// A whole primitive as a stock Draco mesh stream, with a precision of its own for every attribute. Its twin is
// draco_primitive.h.
#ifndef LACERTA_DOCUMENT_DRACO_ENCODE_H_
#define LACERTA_DOCUMENT_DRACO_ENCODE_H_

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "document/draco_primitive.h"
#include "document/lattice.h"
#include "document/primitive.h"
#include "draco/smallest_predictions.h"
#include "lacerta/mesh.h"
#include "lacerta/status.h"

namespace lacerta {

// Where float attributes are rounded to. All primitives that touch take one lattice of positions, so that no crack
// opens along their common borders.
struct DracoPrecision {
  Lattice positions;
  // Of the other float attributes, by name. What is not in here stays exact, as integers do. WEIGHTS_n keep their sums; their
  // lattices begin at 0.
  std::map<std::string, Lattice> lattices;
  int normal_bits = 0;  // octahedral, of NORMAL: 2..30; 0: exact
  // By name: what float attributes become, on the points of these lattices, in the order of the primitive's vertices. Those that are not in here go to the points
  // next to their values.
  std::map<std::string, AccessorData> values = {};
};

// The lattice over a box with steps of its longest side / (2^bits - 1).
Lattice PositionLattice(const Vec3f& min, const Vec3f& max, int bits);

// What a decoder makes of the values, in the order of the input.
Primitive RoundAttributes(const Primitive& primitive, const DracoPrecision& precision);

// How stock Draco codes a primitive.
struct DracoCoding {
  enum class Connectivity { kStandard, kValence, kSequential };
  Connectivity connectivity = Connectivity::kStandard;
  Predictions predictions = {};  // empty: as Draco chooses
};

struct DracoEncoded {
  Bytes bytes;
  std::vector<DracoAttributeId> ids;  // in the order of the primitive's attributes
  Primitive decoded;                  // what a stock decoder makes of `bytes`
  DracoCoding coding;
};

enum class DracoSearch {
  kConnectivity,  // the smallest of Draco's ways to code connectivity, all with the predictions that Draco chooses
  kPredictions,   // then the smallest prediction of each attribute, and RecodeStream: three times the work, the same decoded primitive
};

// Vertices that agree in all attributes once these are rounded become one, and triangles without area by that and unused
// vertices are dropped. Fails with kUnsupported when Draco refuses the primitive or it holds values that are not
// finite.
StatusOr<DracoEncoded> EncodeDracoPrimitive(const Primitive& primitive, const DracoPrecision& precision, DracoSearch search = DracoSearch::kConnectivity);

// How many bytes it takes in one coding, as Draco's encoder writes it. Fails like EncodeDracoPrimitive.
StatusOr<uint64_t> DracoPrimitiveBytes(const Primitive& primitive, const DracoPrecision& precision, const DracoCoding& coding);

// What EncodeDracoPrimitive made of the two, in the same coding with its triangles in the order that takes the fewest bytes of some: each component after
// the one nearest to it where there are many, and from other triangles on, of primitives of few. The same values, in another order.
StatusOr<DracoEncoded> EncodeInOtherOrder(const Primitive& primitive, const DracoPrecision& precision, const DracoEncoded& encoded);

}  // namespace lacerta

#endif  // LACERTA_DOCUMENT_DRACO_ENCODE_H_
