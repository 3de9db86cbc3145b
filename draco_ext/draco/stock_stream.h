// Stock Draco mesh streams: what Draco's own encoders write and every Draco decoder reads.
#ifndef LACERTA_DRACO_STOCK_STREAM_H_
#define LACERTA_DRACO_STOCK_STREAM_H_

#include <draco/compression/config/compression_shared.h>
#include <draco/compression/expert_encode.h>
#include <draco/core/decoder_buffer.h>
#include <draco/mesh/mesh.h>

#include <cstddef>
#include <cstdint>
#include <memory>

#include "lacerta/decoder.h"
#include "lacerta/mesh.h"
#include "lacerta/status.h"

namespace lacerta {

// Bytes of the header that every Draco stream begins with: "DRACO", major, minor, geometry type, method, u16 flags.
inline constexpr size_t kDracoHeaderSize = 11;

// How Draco is asked to code a mesh.
struct StockSettings {
  enum class Connectivity { kEdgebreaker, kEdgebreakerValence, kSequential };
  enum class Prediction { kDifference, kParallelogram };  // others are found afterwards (RecodeStream)

  Connectivity connectivity = Connectivity::kEdgebreaker;
  Prediction prediction = Prediction::kParallelogram;
  // Draco's speed, 0..10. It picks the vertex traversal (0: by prediction degree, else depth first) and the size of the
  // entropy coder's tables; the two choices above are made explicitly.
  int speed = 0;
};

// Has `mesh` coded by edgebreaker, in the way that a draco::MeshEdgebreakerConnectivityEncodingMethod is for connectivity. Draco 1.5.5 does not read what its
// SetEncodingSubmethod sets. Draco's encoder goes around each vertex once for each of its triangles, which takes minutes where these are a million:
// kUnsupported where a vertex has more than 2^18.
Status SetEdgebreaker(const draco::Mesh& mesh, int method, draco::ExpertEncoder* encoder);

// Codes a mesh whose positions are the integers 0 .. 2^bits - 1, held as floats; 1 <= bits <= 24. A decoder gets the
// very integers back, in Draco's order of vertices and faces. The mesh must pass CheckEncodable.
// Fails where SetEdgebreaker does.
StatusOr<Bytes> EncodeIntegerPositions(const draco::Mesh& mesh, int bits, const StockSettings& settings);

// Where a decoder puts the integers: p = origin + integer * (range / (2^bits - 1)), in float arithmetic.
struct QuantizationGrid {
  Vec3f origin;        // model units
  float range = 1.0f;  // model units, > 0
};

// The range for which range / (2^bits - 1) is `step` exactly in float, 1 <= bits <= 24; the nearest one where there is none.
float RangeForStep(float step, int bits);

// Writes the grid over the one of `stream`, a result of EncodeIntegerPositions on a mesh with no other attribute.
// Draco's options cannot carry it: they store floats as decimal text with six digits after the point.
Status SetQuantizationGrid(const QuantizationGrid& grid, Bytes* stream);

// Ends a stream of positions alone that has none yet. bits: of the integers.
void AppendQuantizationGrid(const QuantizationGrid& grid, int bits, Bytes* stream);

// Reads the header of a mesh stream of any method, and skips the metadata that may follow it. Fails with kInvalidData,
// or with kUnsupported on a point cloud and on a bitstream version other than 2.2, which Draco writes since 2017.
StatusOr<draco::DracoHeader> ReadMeshHeader(draco::DecoderBuffer* buffer);

// For streams that this library wrote itself.
inline constexpr DecodeLimits kNoDecodeLimits = {~uint64_t{0}, ~uint64_t{0}};

struct StockMesh {
  std::unique_ptr<draco::Mesh> mesh;
  size_t bytes_used = 0;  // length of the stock stream at the front of the input
};

// Decodes the stock mesh stream at the front of `stream` with Draco's own decoder. Counts are read and checked against
// `limits`, and against what a stream of this length can hold at all, before Draco takes memory for them. Fails with
// kInvalidData, kUnsupported (as ReadMeshHeader, or a method that is not Draco's) or kLimitExceeded.
// Indices and positions of the result are not checked yet: FromDracoMesh does that.
StatusOr<StockMesh> DecodeStockStream(Span<const uint8_t> stream, const DecodeLimits& limits);

}  // namespace lacerta

#endif  // LACERTA_DRACO_STOCK_STREAM_H_
