// Steps of DecodeMesh (lacerta/codec.h) that the decoder in Draco's manner shares.
#ifndef LACERTA_DRACO_DECODE_MESH_H_
#define LACERTA_DRACO_DECODE_MESH_H_

#include <cstdint>

#include "draco/custom_form.h"
#include "lacerta/codec.h"
#include "lacerta/mesh.h"
#include "lacerta/status.h"

namespace lacerta {

// kInvalidArgument where max_level is negative.
Status CheckDecodeOptions(const DecodeOptions& options);

// Refines a decoded base as far as the bytes and options go. Whatever is wrong with the refinement ends up in
// DecodedMesh::refinement; the base is always there.
//   base_step  of a compact base, or 0: the refinement tells it
DecodedMesh RefineBase(TriangleMesh base, Span<const uint8_t> refinement, const DecodeOptions& options, float base_step = 0.0f);

// Decodes base and refinement of the custom form. Fails where the base does not decode or does not fill its part.
StatusOr<DecodedMesh> DecodeCustomFormParts(const StreamParts& parts, const DecodeOptions& options);

}  // namespace lacerta

#endif  // LACERTA_DRACO_DECODE_MESH_H_
