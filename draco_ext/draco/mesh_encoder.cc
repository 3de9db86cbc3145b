#include "draco/mesh_encoder.h"

#include "lacerta/mesh.h"

namespace lacerta {

draco::Status ProgressiveMeshEncoder::EncodeConnectivity() {
  const Bytes payload = CustomFormPayload(parts_);
  if (!buffer()->Encode(payload.data(), payload.size())) return draco::ErrorStatus("buffer is in bit mode");
  return draco::OkStatus();
}

}  // namespace lacerta
