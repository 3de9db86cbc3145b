// The values that Draco's quantization leaves of an attribute, computed without Draco's coder, vertex by vertex: what
// precision costs can be measured in the order of the input.
#ifndef LACERTA_DOCUMENT_LATTICE_H_
#define LACERTA_DOCUMENT_LATTICE_H_

#include <array>
#include <cstdint>

#include "document/accessor.h"
#include "lacerta/mesh.h"

namespace lacerta {

inline constexpr int kMostLatticeBits = 24;  // beyond, floats have no more bits to keep

// value = origin[c] + k * range / (2^bits - 1) with k = 0 .. 2^bits - 1, in float arithmetic as Draco's decoder has it.
struct Lattice {
  std::array<float, 4> origin = {};
  float range = 1.0f;  // > 0
  int bits = 0;        // 1..kMostLatticeBits

  int64_t Round(float value, uint32_t component) const;  // k
  float At(int64_t k, uint32_t component) const;
};

// The lattice that Draco itself chooses for float data: the least value of every component, and the largest extent.
Lattice FitLattice(const AccessorData& data, int bits);

// From the same origin over the same range at least, in other steps; 0 < step.
Lattice LatticeOfStep(const Lattice& box, float step);

// Every component of float data at its lattice point.
AccessorData RoundToLattice(const AccessorData& data, const Lattice& lattice);

// The same with the components of every element going up or down so that their sum is the lattice point nearest to the sum
// there was: weights keep the sum 1. Float data not below 0, a lattice from the origin 0.
AccessorData RoundKeepingSums(const AccessorData& data, const Lattice& lattice);

// Unit vectors (float, VEC3) as Draco's octahedral coding of `bits` per coordinate, 2..30, returns them.
AccessorData RoundOctahedral(const AccessorData& normals, int bits);

// The same numbers as floats: normalized integers are scaled.
AccessorData AsFloat(const AccessorData& data);

}  // namespace lacerta

#endif  // LACERTA_DOCUMENT_LATTICE_H_
