#include "draco/stock_stream.h"

#include <draco/compression/config/compression_shared.h>
#include <draco/compression/decode.h>
#include <draco/compression/expert_encode.h>
#include <draco/compression/point_cloud/point_cloud_decoder.h>
#include <draco/core/decoder_buffer.h>
#include <draco/core/encoder_buffer.h>
#include <draco/core/varint_decoding.h>
#include <draco/metadata/geometry_metadata.h>
#include <draco/metadata/metadata_decoder.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "draco/mesh_conversion.h"

namespace lacerta {
namespace {

constexpr size_t kGridSize =
    4 * sizeof(float) + 1;  // origin, range, bits: the last bytes of a stream of positions alone

int PredictionMethod(StockSettings::Prediction prediction) {
  switch (prediction) {
    case StockSettings::Prediction::kDifference:
      return draco::PREDICTION_DIFFERENCE;
    case StockSettings::Prediction::kParallelogram:
      return draco::MESH_PREDICTION_PARALLELOGRAM;
  }
  return draco::PREDICTION_DIFFERENCE;
}

struct Counts {
  uint32_t vertices = 0;
  uint32_t triangles = 0;
};

// Reads the counts that open the connectivity. `buffer` is a copy: the decoder proper begins anew.
StatusOr<Counts> PeekCounts(draco::DecoderBuffer buffer) {
  LACERTA_ASSIGN_OR_RETURN(const draco::DracoHeader header, ReadMeshHeader(&buffer));
  Counts counts;
  if (header.encoder_method == draco::MESH_EDGEBREAKER_ENCODING) {
    uint8_t traversal = 0;
    if (buffer.Decode(&traversal) && draco::DecodeVarint(&counts.vertices, &buffer) &&
        draco::DecodeVarint(&counts.triangles, &buffer)) {
      return counts;
    }
  } else if (header.encoder_method == draco::MESH_SEQUENTIAL_ENCODING) {
    if (draco::DecodeVarint(&counts.triangles, &buffer) && draco::DecodeVarint(&counts.vertices, &buffer)) {
      return counts;
    }
  } else {
    return Unsupported("encoding method " + std::to_string(header.encoder_method) + " is not one of stock Draco's");
  }
  return InvalidData("Draco stream ends before its counts");
}

Status CheckCounts(const Counts& counts, size_t stream_size, const DecodeLimits& limits) {
  if (counts.vertices > limits.max_vertices || counts.triangles > limits.max_triangles) {
    return LimitExceeded("Draco stream announces " + std::to_string(counts.vertices) + " vertices and " +
                         std::to_string(counts.triangles) + " triangles; the decode limits are " +
                         std::to_string(limits.max_vertices) + " and " + std::to_string(limits.max_triangles));
  }
  // A coded symbol costs at least log2(4096 / 4095) = 0.00035 bits in Draco's entropy coder, which makes 22,700 symbols
  // a byte; every triangle of edgebreaker is a symbol, and every vertex three numbers. Sequential streams are bounded
  // by their vertices in the same way.
  constexpr uint64_t kMaxSymbolsPerByte = 22700;
  constexpr uint64_t kSlack = 1u << 16;
  if (std::max(counts.vertices, counts.triangles) > kSlack + kMaxSymbolsPerByte * stream_size) {
    return InvalidData("Draco stream of " + std::to_string(stream_size) + " bytes cannot hold the " +
                       std::to_string(counts.vertices) + " vertices and " + std::to_string(counts.triangles) +
                       " triangles that it announces");
  }
  if (counts.vertices == 0 || counts.triangles == 0) return InvalidData("Draco stream holds an empty mesh");
  return {};
}

Status CheckValences(const draco::Mesh& mesh) {
  constexpr uint32_t kMost = 1 << 18;
  if (mesh.num_faces() <= kMost) return {};
  const draco::PointAttribute& positions = *mesh.GetNamedAttribute(draco::GeometryAttribute::POSITION);
  std::vector<uint32_t> valences(positions.size(), 0);
  for (draco::FaceIndex f(0); f < mesh.num_faces(); ++f) {
    for (const draco::PointIndex& point : mesh.face(f)) {
      if (++valences[positions.mapped_index(point).value()] > kMost) {
        return Unsupported("a vertex of more than " + std::to_string(kMost) + " triangles takes edgebreaker too long");
      }
    }
  }
  return {};
}

}  // namespace

Status SetEdgebreaker(const draco::Mesh& mesh, int method, draco::ExpertEncoder* encoder) {
  encoder->SetEncodingMethod(draco::MESH_EDGEBREAKER_ENCODING);
  encoder->options().SetGlobalInt("edgebreaker_method", method);
  return CheckValences(mesh);
}

StatusOr<Bytes> EncodeIntegerPositions(const draco::Mesh& mesh, int bits, const StockSettings& settings) {
  const int positions = mesh.GetNamedAttributeId(draco::GeometryAttribute::POSITION);
  draco::ExpertEncoder encoder(mesh);
  encoder.SetSpeedOptions(settings.speed, settings.speed);
  if (settings.connectivity == StockSettings::Connectivity::kSequential) {
    encoder.SetEncodingMethod(draco::MESH_SEQUENTIAL_ENCODING);
  } else {
    const bool valence = settings.connectivity == StockSettings::Connectivity::kEdgebreakerValence;
    LACERTA_RETURN_IF_ERROR(
        SetEdgebreaker(mesh, valence ? draco::MESH_EDGEBREAKER_VALENCE_ENCODING : draco::MESH_EDGEBREAKER_STANDARD_ENCODING, &encoder));
  }
  const std::array<float, 3> origin = {0.0f, 0.0f, 0.0f};
  const auto range = static_cast<float>((1 << bits) - 1);
  encoder.SetAttributeExplicitQuantization(positions, bits, 3, origin.data(), range);
  if (const auto status = encoder.SetAttributePredictionScheme(positions, PredictionMethod(settings.prediction));
      !status.ok()) {
    return FromDracoStatus(status);
  }
  draco::EncoderBuffer buffer;
  if (const draco::Status status = encoder.EncodeToBuffer(&buffer); !status.ok()) return FromDracoStatus(status);
  return Bytes(buffer.data(), buffer.data() + buffer.size());
}

float RangeForStep(float step, int bits) {
  const auto divisor = static_cast<float>((1 << bits) - 1);
  const float range = step * divisor;
  for (const float candidate : {range, std::nextafter(range, 0.0f), std::nextafter(range, std::numeric_limits<float>::infinity())}) {
    if (candidate / divisor == step) return candidate;
  }
  return range;
}

Status SetQuantizationGrid(const QuantizationGrid& grid, Bytes* stream) {
  if (stream->size() < kDracoHeaderSize + kGridSize) return InternalError("Draco stream has no room for a grid");
  uint8_t* const written = stream->data() + stream->size() - kGridSize;
  const int bits = written[kGridSize - 1];
  const std::array<float, 4> expected = {0.0f, 0.0f, 0.0f, static_cast<float>((int64_t{1} << (bits & 31)) - 1)};
  if (std::memcmp(written, expected.data(), sizeof(expected)) != 0) {  // NOLINT(bugprone-suspicious-memory-comparison): the bytes are meant
    return InternalError("Draco stream does not end with its quantization grid");
  }
  stream->resize(stream->size() - kGridSize);
  AppendQuantizationGrid(grid, bits, stream);
  return {};
}

void AppendQuantizationGrid(const QuantizationGrid& grid, int bits, Bytes* stream) {
  const std::array<float, 4> place = {grid.origin.x, grid.origin.y, grid.origin.z, grid.range};
  stream->resize(stream->size() + sizeof(place));
  std::memcpy(stream->data() + stream->size() - sizeof(place), place.data(), sizeof(place));
  stream->push_back(static_cast<uint8_t>(bits));
}

StatusOr<draco::DracoHeader> ReadMeshHeader(draco::DecoderBuffer* buffer) {
  draco::DracoHeader header;
  if (const draco::Status status = draco::PointCloudDecoder::DecodeHeader(buffer, &header); !status.ok()) {
    return FromDracoStatus(status);
  }
  if (header.encoder_type != draco::TRIANGULAR_MESH) return Unsupported("Draco stream holds no triangle mesh");
  if (header.version_major != 2 || header.version_minor != 2) {
    return Unsupported("Draco bitstream version " + std::to_string(header.version_major) + "." +
                       std::to_string(header.version_minor) + " is not supported, only 2.2; encode the mesh again");
  }
  buffer->set_bitstream_version(draco::kDracoMeshBitstreamVersion);
  if ((header.flags & METADATA_FLAG_MASK) != 0) {
    draco::GeometryMetadata metadata;
    if (!draco::MetadataDecoder().DecodeGeometryMetadata(buffer, &metadata)) {
      return InvalidData("metadata of the Draco stream is damaged");
    }
  }
  return header;
}

StatusOr<StockMesh> DecodeStockStream(Span<const uint8_t> stream, const DecodeLimits& limits) {
  draco::DecoderBuffer buffer;
  buffer.Init(reinterpret_cast<const char*>(stream.data()), stream.size());
  LACERTA_ASSIGN_OR_RETURN(const Counts counts, PeekCounts(buffer));
  LACERTA_RETURN_IF_ERROR(CheckCounts(counts, stream.size(), limits));
  auto decoded = draco::Decoder().DecodeMeshFromBuffer(&buffer);
  if (!decoded.ok()) return FromDracoStatus(decoded.status());
  StockMesh result;
  result.mesh = std::move(decoded).value();
  result.bytes_used = stream.size() - static_cast<size_t>(buffer.remaining_size());
  return result;
}

}  // namespace lacerta
