// Streams that carry attributes and groups, decoded once for all primitives that show them.
#ifndef LACERTA_UNPACK_ATTRIBUTED_READER_H_
#define LACERTA_UNPACK_ATTRIBUTED_READER_H_

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "extension/progressive.h"
#include "extension/target_channels.h"
#include "lacerta/attributed_mesh.h"
#include "lacerta/gltf.h"
#include "lacerta/status.h"

namespace lacerta {

struct AttributedLevel {
  std::vector<VertexSoup> groups;    // one per group of the stream, without what is of morph targets
  std::vector<SoupTargets> targets;  // parallel
  int level = 0;
  bool is_complete = true;  // as far as was asked
  Status refinement;        // why it is not; ok: the data was cut off
};

// The parts of the base section, one stock Draco stream for each group.
std::vector<Span<const uint8_t>> BaseParts(const GatheredStream& stream, const ProgressiveStream& announced);

// Decodes as far as the bytes go, or to `options.level`. Fails with kInvalidData where the base is damaged or does not have the
// announced attributes, or a level not the announced counts.
StatusOr<AttributedLevel> DecodeAttributedLevel(const GatheredStream& stream, const ProgressiveStream& announced,
                                                const UnpackOptions& options);

// What was decoded of each stream; for one document and one level.
class AttributedCache {
 public:
  // The level of stream `index`, decoded at the first call.
  const StatusOr<AttributedLevel>& Get(uint64_t index, const GatheredStream& stream, const ProgressiveStream& announced,
                                       const UnpackOptions& options);

 private:
  std::map<uint64_t, StatusOr<AttributedLevel>> levels_;
};

}  // namespace lacerta

#endif  // LACERTA_UNPACK_ATTRIBUTED_READER_H_
