// Progressive decoding of the refinement of a base mesh that the caller already has. Integers steer, floats only follow.
// Everything here is safe on untrusted bytes: counts are checked against DecodeLimits before memory is taken.
#ifndef LACERTA_DECODER_H_
#define LACERTA_DECODER_H_

#include <array>
#include <cstdint>
#include <vector>

#include "lacerta/mesh.h"
#include "lacerta/status.h"

namespace lacerta {

// Budget of a decoder. A stream that would exceed it is refused with kLimitExceeded, or decoded up to the last level that fits.
struct DecodeLimits {
  uint64_t max_vertices = 64u << 20;
  uint64_t max_triangles = 128u << 20;
};

// A base mesh on an integer lattice: vertex v lies at `step` * lattice[v].
struct BaseMesh {
  float step = 0.0f;                           // model units, > 0 and finite
  std::vector<std::array<int32_t, 3>> lattice;  // #V0, |value| < 2^24
  std::vector<Triangle> triangles;              // #F0

  TriangleMesh ToMesh() const;
};

}  // namespace lacerta

#endif  // LACERTA_DECODER_H_
