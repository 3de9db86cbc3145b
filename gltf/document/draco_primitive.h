// A whole primitive out of a stock Draco mesh stream: what KHR_draco_mesh_compression holds. Its twin is draco_encode.h.
#ifndef LACERTA_DOCUMENT_DRACO_PRIMITIVE_H_
#define LACERTA_DOCUMENT_DRACO_PRIMITIVE_H_

#include <cstdint>
#include <string>
#include <vector>

#include "document/primitive.h"
#include "lacerta/decoder.h"
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

// What a stock stream has besides positions, by Draco's own names of kinds ("NORMAL", "TEX_COORD", "COLOR", "GENERIC").
StatusOr<std::vector<std::string>> DracoAttributeKinds(Span<const uint8_t> bytes);

// The unique id of the position attribute of a stock stream.
StatusOr<uint32_t> DracoPositionId(Span<const uint8_t> bytes);

// The positions and triangles of a stock stream.
struct DracoShape {
  std::vector<DracoAttributeId> ids;  // of POSITION alone
  Primitive primitive;
};
StatusOr<DracoShape> DecodeDracoShape(Span<const uint8_t> bytes);

}  // namespace lacerta

#endif  // LACERTA_DOCUMENT_DRACO_PRIMITIVE_H_
