#include "bench/other_codecs.h"

#include <draco/compression/decode.h>
#include <draco/compression/encode.h>
#ifdef LACERTA_HAVE_MESHOPTIMIZER
#include <meshoptimizer.h>
#endif

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "draco/mesh_conversion.h"
#include "geometry/bounding_box.h"

namespace lacerta {

StatusOr<Bytes> EncodeByDraco(const TriangleMesh& mesh, int bits) {
  constexpr int kSpeed = 0;
  draco::Encoder encoder;
  encoder.SetSpeedOptions(kSpeed, kSpeed);
  encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, bits);
  draco::EncoderBuffer buffer;
  const draco::Status status = encoder.EncodeMeshToBuffer(*ToDracoMesh(mesh), &buffer);
  if (!status.ok()) return InvalidArgument(status.error_msg_string());
  return Bytes(buffer.data(), buffer.data() + buffer.size());
}

StatusOr<std::unique_ptr<draco::Mesh>> DecodeByDraco(const Bytes& stream) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(stream.data()), stream.size());
  draco::Decoder decoder;
  auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok()) return InvalidData(decoded.status().error_msg_string());
  return std::move(decoded).value();
}

#ifdef LACERTA_HAVE_MESHOPTIMIZER
namespace {

using Lattice = std::array<uint16_t, 4>;  // the last one is not used

}  // namespace

MeshoptStreams EncodeByMeshopt(TriangleMesh mesh, int bits) {
  MeshoptStreams coded;
  coded.num_vertices = mesh.positions.size();
  coded.num_triangles = mesh.triangles.size();
  const size_t num_indices = 3 * coded.num_triangles;
  uint32_t* const indices = mesh.triangles[0].data();
  meshopt_optimizeVertexCache(indices, indices, num_indices, coded.num_vertices);
  meshopt_optimizeVertexFetch(mesh.positions.data(), indices, num_indices, mesh.positions.data(), coded.num_vertices, sizeof(Vec3f));
  const auto [low, high] = BoundsOf(mesh.positions);
  const Vec3f extent = high - low;
  coded.corner = low;
  coded.step = std::max({extent.x, extent.y, extent.z}) / static_cast<float>((1 << bits) - 1);
  std::vector<Lattice> lattice;
  for (const Vec3f& p : mesh.positions) {
    const Vec3f q = (p - low) * (1 / coded.step);
    lattice.push_back({static_cast<uint16_t>(q.x + 0.5f), static_cast<uint16_t>(q.y + 0.5f), static_cast<uint16_t>(q.z + 0.5f), 0});
  }
  coded.vertices.resize(meshopt_encodeVertexBufferBound(coded.num_vertices, sizeof(Lattice)));
  coded.vertices.resize(meshopt_encodeVertexBuffer(coded.vertices.data(), coded.vertices.size(), lattice.data(), coded.num_vertices, sizeof(Lattice)));
  coded.indices.resize(meshopt_encodeIndexBufferBound(num_indices, coded.num_vertices));
  coded.indices.resize(meshopt_encodeIndexBuffer(coded.indices.data(), coded.indices.size(), indices, num_indices));
  return coded;
}

StatusOr<TriangleMesh> DecodeByMeshopt(const MeshoptStreams& coded) {
  std::vector<Lattice> lattice(coded.num_vertices);
  TriangleMesh mesh;
  mesh.positions.reserve(coded.num_vertices);
  mesh.triangles.resize(coded.num_triangles);
  if (meshopt_decodeVertexBuffer(lattice.data(), coded.num_vertices, sizeof(Lattice), coded.vertices.data(), coded.vertices.size()) != 0 ||
      meshopt_decodeIndexBuffer(mesh.triangles[0].data(), 3 * coded.num_triangles, sizeof(uint32_t), coded.indices.data(), coded.indices.size()) != 0) {
    return InvalidData("meshoptimizer does not decode what it coded");
  }
  for (const Lattice& q : lattice) {
    mesh.positions.push_back(coded.corner + Vec3f{static_cast<float>(q[0]), static_cast<float>(q[1]), static_cast<float>(q[2])} * coded.step);
  }
  return mesh;
}
#endif

}  // namespace lacerta
