#include "draco/mesh_decoder.h"

#include <utility>

#include "draco/custom_form.h"
#include "draco/decode_mesh.h"
#include "draco/mesh_conversion.h"

namespace lacerta {

bool ProgressiveMeshDecoder::DecodeConnectivity() {
  status_ = DecodePayload();
  return status_.ok();
}

Status ProgressiveMeshDecoder::DecodePayload() {
  const Span<const uint8_t> payload(reinterpret_cast<const uint8_t*>(buffer()->data_head()),
                                    static_cast<size_t>(buffer()->remaining_size()));
  LACERTA_ASSIGN_OR_RETURN(const StreamParts parts, SplitCustomFormPayload(payload));
  LACERTA_ASSIGN_OR_RETURN(DecodedMesh decoded, DecodeCustomFormParts(parts, options_));
  level_ = decoded.level;
  num_levels_ = decoded.num_levels;
  refinement_ = std::move(decoded.refinement);
  FillDracoMesh(decoded.mesh, mesh());
  buffer()->Advance(buffer()->remaining_size());
  return {};
}

}  // namespace lacerta
