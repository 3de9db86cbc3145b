// The custom form as a Draco encoding method. Twin: mesh_decoder.h.
#ifndef LACERTA_DRACO_MESH_ENCODER_H_
#define LACERTA_DRACO_MESH_ENCODER_H_

#include <draco/compression/mesh/mesh_encoder.h>

#include <cstdint>

#include "draco/custom_form.h"

namespace lacerta {

// Writes a coded mesh behind Draco's header and the metadata of the mesh that SetMesh was given. Use:
//   ProgressiveMeshEncoder encoder(parts);
//   encoder.SetMesh(mesh);
//   encoder.Encode(draco::EncoderOptions::CreateDefaultOptions(), &buffer);
class ProgressiveMeshEncoder : public draco::MeshEncoder {
 public:
  // The parts are views that must outlive the encoder.
  explicit ProgressiveMeshEncoder(const StreamParts& parts) : parts_(parts) {}

  uint8_t GetEncodingMethod() const override { return kCustomFormMethod; }

 protected:
  draco::Status EncodeConnectivity() override;
  // Positions are in the payload: there is no attribute to encode apart.
  bool EncodePointAttributes() override { return true; }
  bool GenerateAttributesEncoder(int32_t /*attribute*/) override { return true; }
  void ComputeNumberOfEncodedFaces() override { set_num_encoded_faces(mesh()->num_faces()); }
  void ComputeNumberOfEncodedPoints() override { set_num_encoded_points(mesh()->num_points()); }

 private:
  StreamParts parts_;
};

}  // namespace lacerta

#endif  // LACERTA_DRACO_MESH_ENCODER_H_
