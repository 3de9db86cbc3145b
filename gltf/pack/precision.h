// The fewest bits that keep what was asked for, found by measuring.
#ifndef LACERTA_PACK_PRECISION_H_
#define LACERTA_PACK_PRECISION_H_

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "document/draco_encode.h"
#include "document/primitive.h"
#include "lacerta/gltf.h"
#include "lacerta/status.h"

namespace lacerta {

// Bits for every float attribute but positions, and the errors that they lead to. `texels_per_unit` tells the scale of
// TEXCOORD_n. Attributes that nobody gave a tolerance for (application attributes, JOINTS) get no bits: they stay exact.
struct AttributePrecision {
  std::map<std::string, int> bits;
  std::vector<AttributeReport> reports;
};
AttributePrecision FindAttributeBits(const Primitive& primitive, const AttributeTargets& targets,
                                     const std::function<double(uint64_t set)>& texels_per_unit);

// One lattice for surfaces that touch.
struct SharedLattice {
  Lattice lattice;
  double error = 0.0;     // d_S between the surfaces as they were and at the lattice, measured, in their unit
  double flipped = 0.0;   // share of their area that looks to the other side
};

// The coarsest lattice of `least_bits` (2..kMostLatticeBits) or more over `surface` (all that touches, in one mesh) that
// keeps d_S at or below `error` and no more than one part in two thousand of the area flipped; the finest that floats
// can use where none does.
SharedLattice FindPositionLattice(const TriangleMesh& surface, double error, int least_bits = 2);

}  // namespace lacerta

#endif  // LACERTA_PACK_PRECISION_H_
