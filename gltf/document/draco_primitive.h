// A whole primitive as a stock Draco mesh stream: what KHR_draco_mesh_compression holds.
#ifndef LACERTA_DOCUMENT_DRACO_PRIMITIVE_H_
#define LACERTA_DOCUMENT_DRACO_PRIMITIVE_H_

#include <cstdint>
#include <string>
#include <vector>

#include "document/primitive.h"
#include "lacerta/decoder.h"
#include "lacerta/mesh.h"
#include "lacerta/status.h"

namespace lacerta {

struct DracoAttributeId {
  std::string name;  // glTF attribute semantic
  uint32_t id = 0;   // Draco's unique id
};

// Decodes a stock stream; bytes after it are ignored. Attributes come in the order of `ids`.
// Fails with kInvalidData on a damaged stream, a missing attribute or an index out of range, and with kLimitExceeded.
StatusOr<Primitive> DecodeDracoPrimitive(Span<const uint8_t> bytes, const std::vector<DracoAttributeId>& ids,
                                         const DecodeLimits& limits);

// The unique id of the position attribute of a stock stream.
StatusOr<uint32_t> DracoPositionId(Span<const uint8_t> bytes);

// The lattice that float positions are rounded to: origin + k * range / (2^bits - 1). All primitives of a mesh share
// one, so that no crack opens along their common borders.
struct PositionGrid {
  Vec3f origin;
  float range = 1.0f;     // model units, > 0
  int bits = 14;          // 1..30
  bool shareable = true;  // false: too small for Draco's options to carry; every primitive gets a grid of its own
};

// The coarsest grid over a box that keeps the surface within `psnr` dB: rounding moves a vertex by an RMS of half a
// step.
PositionGrid MakePositionGrid(const Vec3f& min, const Vec3f& max, double psnr);

struct DracoEncoded {
  Bytes bytes;
  std::vector<DracoAttributeId> ids;  // in the order of the primitive's attributes
  Primitive decoded;                  // what a stock decoder makes of `bytes`
};

// Encodes with edgebreaker. Float positions are rounded to `grid`, float normals and tangents to 10 bits, float texture
// coordinates, colours and weights to 12 bits of their range; integers and application attributes stay exact. Vertices
// that agree in all attributes become one, degenerate triangles and unused vertices are dropped. Fails with
// kUnsupported when Draco refuses the primitive.
StatusOr<DracoEncoded> EncodeDracoPrimitive(const Primitive& primitive, const PositionGrid& grid);

}  // namespace lacerta

#endif  // LACERTA_DOCUMENT_DRACO_PRIMITIVE_H_
