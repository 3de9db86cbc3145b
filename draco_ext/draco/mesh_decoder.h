// The custom form as a Draco decoding method. Twin: mesh_encoder.h.
#ifndef LACERTA_DRACO_MESH_DECODER_H_
#define LACERTA_DRACO_MESH_DECODER_H_

#include <draco/compression/mesh/mesh_decoder.h>

#include <cstdint>

#include "lacerta/codec.h"
#include "lacerta/status.h"

namespace lacerta {

// Decodes a stream in custom form with draco::MeshDecoder::Decode: metadata, positions and triangles. Draco's virtual
// functions tell success only; status() says what was wrong.
class ProgressiveMeshDecoder : public draco::MeshDecoder {
 public:
  explicit ProgressiveMeshDecoder(const DecodeOptions& options) : options_(options) {}

  const Status& status() const { return status_; }
  int level() const { return level_; }                      // decoded
  int num_levels() const { return num_levels_; }            // that the stream announces
  const Status& refinement() const { return refinement_; }  // as DecodedMesh::refinement

 protected:
  bool DecodeConnectivity() override;
  // Positions come with the payload.
  bool DecodePointAttributes() override { return true; }
  bool CreateAttributesDecoder(int32_t /*decoder*/) override { return false; }

 private:
  Status DecodePayload();

  DecodeOptions options_;
  Status status_;
  Status refinement_;
  int level_ = 0;
  int num_levels_ = 0;
};

}  // namespace lacerta

#endif  // LACERTA_DRACO_MESH_DECODER_H_
