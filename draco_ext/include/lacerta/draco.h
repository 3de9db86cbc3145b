// Encoder and decoder in Draco's manner: draco::Mesh in and out of draco::EncoderBuffer and draco::DecoderBuffer. The
// only public header that includes Draco; compile it with the headers of the very Draco library that is linked.
#ifndef LACERTA_DRACO_H_
#define LACERTA_DRACO_H_

#include <draco/core/decoder_buffer.h>
#include <draco/core/encoder_buffer.h>
#include <draco/core/status.h>
#include <draco/core/status_or.h>
#include <draco/mesh/mesh.h>

#include <memory>

#include "lacerta/codec.h"
#include "lacerta/status.h"

namespace lacerta {

// Codes the positions and triangles of Draco meshes as progressive streams.
//   EncodeOptions options;
//   options.target = {EncodeTarget::Kind::kBytes, 20000};
//   Encoder encoder(options);
//   draco::EncoderBuffer buffer;
//   if (const draco::Status status = encoder.EncodeMeshToBuffer(mesh, &buffer); !status.ok()) ...
class Encoder {
 public:
  Encoder() = default;
  explicit Encoder(const EncodeOptions& options) : options_(options) {}

  EncodeOptions& options() { return options_; }

  // Appends the stream to `out_buffer`. The custom form keeps the metadata of the mesh. Fails as EncodeMesh
  // (lacerta/codec.h) does, and on meshes without a POSITION attribute of three components.
  draco::Status EncodeMeshToBuffer(const draco::Mesh& mesh, draco::EncoderBuffer* out_buffer);

  // Of the last mesh that was coded.
  const EncodeReport& report() const { return report_; }

 private:
  EncodeOptions options_;
  EncodeReport report_;
};

// Decodes streams in Draco form and custom form, and any stock Draco mesh stream. Safe on untrusted bytes as DecodeMesh
// is.
//   Decoder decoder;
//   auto mesh = decoder.DecodeMeshFromBuffer(&buffer);
//   if (!mesh.ok()) ...
class Decoder {
 public:
  Decoder() = default;
  explicit Decoder(const DecodeOptions& options) : options_(options) {}

  DecodeOptions& options() { return options_; }

  // Takes all bytes of the buffer. The mesh has a POSITION attribute of float32; a stream without refinement keeps what
  // else it holds (attributes, metadata), and so does level 0 of any other in Draco form.
  draco::StatusOr<std::unique_ptr<draco::Mesh>> DecodeMeshFromBuffer(draco::DecoderBuffer* in_buffer);

  // Of the last mesh that was decoded, as in DecodedMesh.
  int level() const { return level_; }
  int num_levels() const { return num_levels_; }
  const Status& refinement() const { return refinement_; }

 private:
  DecodeOptions options_;
  int level_ = 0;
  int num_levels_ = 0;
  Status refinement_;
};

}  // namespace lacerta

#endif  // LACERTA_DRACO_H_
