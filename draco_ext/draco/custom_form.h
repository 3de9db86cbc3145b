// The custom form of a stream (docs/format.md, "Custom form"): Draco's header with a method byte of our own, then the
// payload: our version and how the base is coded in one byte, the length of the base as a varint, the base, the refinement.
#ifndef LACERTA_DRACO_CUSTOM_FORM_H_
#define LACERTA_DRACO_CUSTOM_FORM_H_

#include <cstdint>

#include "draco/base_coding.h"
#include "lacerta/mesh.h"
#include "lacerta/status.h"

namespace lacerta {

inline constexpr uint8_t kCustomFormMethod = 0x4C;  // 'L'; stock Draco answers "Unsupported encoding method."
inline constexpr uint8_t kCustomFormVersion = 1;

// Views into a stream.
struct StreamParts {
  Span<const uint8_t> base;        // < 2^32 bytes
  Span<const uint8_t> refinement;  // as lacerta/decoder.h reads it, or empty
  BaseCoding coding = BaseCoding::kStock;  // of the base
};

// What follows Draco's header.
Bytes CustomFormPayload(const StreamParts& parts);
// Header, without metadata, and payload.
Bytes WriteCustomForm(const StreamParts& parts);

// Whether the bytes begin with a Draco header of our method.
bool IsCustomForm(Span<const uint8_t> stream);

// Splits what follows Draco's header. Fails with kUnsupported on an unknown version or coding, with kInvalidData where the base
// is cut off.
StatusOr<StreamParts> SplitCustomFormPayload(Span<const uint8_t> payload);
// Splits a whole stream, header and metadata included.
StatusOr<StreamParts> SplitCustomForm(Span<const uint8_t> stream);

}  // namespace lacerta

#endif  // LACERTA_DRACO_CUSTOM_FORM_H_
