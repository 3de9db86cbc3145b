// One attribute of a stream as its levels come.
#ifndef LACERTA_DECODER_ATTRIBUTE_DECODER_H_
#define LACERTA_DECODER_ATTRIBUTE_DECODER_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/attribute_coding.h"
#include "common/attribute_layout.h"
#include "common/attribute_prediction.h"
#include "common/attribute_wedges.h"
#include "decoder/range_decoder.h"
#include "lacerta/attributed_levels.h"
#include "lacerta/decoder.h"
#include "lacerta/status.h"

namespace lacerta {

class AttributeDecoder {
 public:
  // base: level 0 of it; still: of the base triangles. Fails where the wedge mesh is no manifold.
  static StatusOr<AttributeDecoder> Create(AttributeHeader header, const LevelAttribute& base, const std::vector<uint8_t>& still);

  // Fails with kLimitExceeded where the next level has more rows or triangles than allowed, or its floats together with `num_floats`, to which
  // they are added, are more than 64 for each vertex allowed.
  Status CheckNextFits(const DecodeLimits& limits, uint64_t* num_floats);

  // Decodes the next level and appends its rows to `attribute`; surface: the finer level, decoded. Fails with kInvalidData where a
  // value is not finite; nothing has been appended then.
  Status AddLevel(const SurfaceLevel& surface, RangeDecoder* coder, LevelAttribute* attribute);

  // Rows at the corners of the split triangles of `level`, kNoValue x 3 where the group has not got the attribute. level: the finest one
  // of the mesh, which is the one before that of AddLevel where another attribute failed there.
  std::vector<Triangle> Corners(int level, size_t num_split) const;

 private:
  AttributeDecoder(AttributeHeader header, AttributeWedges wedges)
      : header_(std::move(header)), wedges_(std::move(wedges)), state_(CodedComponents(header_.precision)) {}
  void ReachFinestLevel();

  AttributeHeader header_;
  AttributeWedges wedges_;  // of the finest level, or of the one before: tables are large, and not wanted after the last level
  int num_levels_ = 0;      // above the base, so far
  AttributeCodingState state_;
};

}  // namespace lacerta

#endif  // LACERTA_DECODER_ATTRIBUTE_DECODER_H_
