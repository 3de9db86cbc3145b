#include <draco/compression/config/encoder_options.h>

#include <utility>

#include "draco/custom_form.h"
#include "draco/mesh_conversion.h"
#include "draco/mesh_encoder.h"
#include "lacerta/draco.h"

namespace lacerta {

draco::Status Encoder::EncodeMeshToBuffer(const draco::Mesh& mesh, draco::EncoderBuffer* out_buffer) {
  const StatusOr<TriangleMesh> triangles = FromDracoMesh(mesh);
  if (!triangles.ok()) return ToDracoStatus(triangles.status());
  StatusOr<EncodedMesh> result = EncodeMesh(triangles.value(), options_);
  if (!result.ok()) return ToDracoStatus(result.status());
  EncodedMesh& encoded = result.value();
  report_ = std::move(encoded.report);
  const Span<const uint8_t> stream(encoded.stream);
  if (options_.form == StreamForm::kDraco) {
    if (!out_buffer->Encode(stream.data(), stream.size())) return draco::ErrorStatus("buffer is in bit mode");
    return draco::OkStatus();
  }
  const StatusOr<StreamParts> parts = SplitCustomForm(stream);  // the same behind the metadata of `mesh`
  if (!parts.ok()) return ToDracoStatus(parts.status());
  ProgressiveMeshEncoder encoder(parts.value());
  encoder.SetMesh(mesh);
  return encoder.Encode(draco::EncoderOptions::CreateDefaultOptions(), out_buffer);
}

}  // namespace lacerta
