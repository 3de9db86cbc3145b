// The JSON of LACERTA_mesh_progressive as a value, and the way back.
#ifndef LACERTA_EXTENSION_PROGRESSIVE_H_
#define LACERTA_EXTENSION_PROGRESSIVE_H_

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "decoder/joint_weights.h"
#include "document/gltf_document.h"
#include "lacerta/mesh.h"
#include "lacerta/status.h"

namespace lacerta {

inline constexpr char kProgressiveName[] = "LACERTA_mesh_progressive";
inline constexpr char kDracoName[] = "KHR_draco_mesh_compression";
inline constexpr uint64_t kProgressiveVersion = 1;

struct ProgressiveStream {
  std::vector<uint64_t> vertex_counts;  // one per level, base first
  std::vector<uint64_t> triangle_counts;
  std::vector<double> errors;  // two-sided surface distance to the original, mesh units
  Vec3f min, max;              // of the finest level
  bool smooth_normals = false;
  // Of a stream that carries attributes or groups, else empty: the lengths of the base section's parts, one stock Draco
  // stream for each group, and the names of the attributes, of which attribute i has the Draco id i + 1.
  std::vector<uint64_t> base_lengths;
  std::vector<std::string> attributes;
  // Of a skinned surface: which joint of the skin each component of the stream's WEIGHTS_0 belongs to. The parts of the
  // base then have WEIGHTS_0 and, with the id after those of all attributes, JOINTS_0 as glTF does.
  JointTable joints;
};

struct Segment {
  uint64_t stream = 0;
  uint64_t length = 0;  // bytes
};

struct Progressive {
  uint64_t data = 0;              // bufferView of all segments, or of the bases
  std::optional<uint64_t> refinements;  // bufferView that goes on where `data` ends, in a file of its own
  std::vector<Segment> segments;  // in the order of their bytes
  std::vector<ProgressiveStream> streams;
};

// Reads and checks the extension at the root of a document: its version, every number, that streams have as many
// segments as levels. Fails with kNotFound where there is none, kUnsupported for another version, kInvalidData.
StatusOr<Progressive> ParseProgressive(const GltfDocument& document);
Json FormatProgressive(const Progressive& progressive);

// The bytes of all segments, as far as they are there. Fails where a bufferView is not there.
StatusOr<Bytes> TransmittedBytes(const GltfDocument& document, const Progressive& progressive);

// Puts `data`, which has to begin with the same bases, in the place of all that TransmittedBytes gave, in one bufferView.
// The bufferViews of fallbacks that are parts of it follow. Writes `progressive` to the document.
Status ReplaceTransmittedBytes(Bytes data, Progressive* progressive, GltfDocument* document);

// What is there of one stream: `bytes` may end early when the data was trimmed.
struct GatheredStream {
  Bytes bytes;
  uint64_t base_length = 0;
  uint64_t base_offset = 0;  // of the base segment in the bufferView `data`
  bool complete = true;
};
StatusOr<GatheredStream> GatherStream(const GltfDocument& document, const Progressive& progressive, uint64_t stream);

// Where the streams' parts go: all bases first, then always the next parts of the stream that lower the sum of all errors most per byte,
// up to the part behind which they do so less. part_lengths[s] and errors[s] are parallel: one per level of stream s, base first.
std::vector<Segment> OrderSegments(const std::vector<std::vector<uint64_t>>& part_lengths,
                                   const std::vector<std::vector<double>>& errors);

}  // namespace lacerta

#endif  // LACERTA_EXTENSION_PROGRESSIVE_H_
