#include "encoder/stream_writer.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <string>
#include <utility>

#include "common/base_tags_coding.h"
#include "common/coefficient_coding.h"
#include "common/crc32.h"
#include "common/stream_layout.h"
#include "encoder/byte_writer.h"
#include "encoder/range_encoder.h"

namespace lacerta {
namespace {

void PutSteps(const LevelSteps& s, Bytes* bytes) {
  PutWord16(StepToBits(s.normal_step), bytes);
  PutWord16(StepToBits(s.tangential_step), bytes);
  const int normal_bias = s.normal_step > 0 ? s.normal_bias : 0;
  const int tangential_bias = s.tangential_step > 0 ? s.tangential_bias : 0;
  if (s.normal_step > 0 || s.tangential_step > 0)
    bytes->push_back(static_cast<uint8_t>(normal_bias | tangential_bias << 4));
}

Bytes WriteHeader(const BaseMesh& base, const std::vector<LevelSteps>& steps, const Bytes& tags) {
  Bytes bytes(kRefinementMagic.begin(), kRefinementMagic.end());
  bytes.push_back(kRefinementVersion);
  bytes.push_back(static_cast<uint8_t>(steps.size() | 1 << 4));  // one quality layer
  PutVarint(base.lattice.size(), &bytes);
  PutVarint(base.triangles.size(), &bytes);
  uint32_t step_bits;
  std::memcpy(&step_bits, &base.step, sizeof(step_bits));
  PutWord32(step_bits, &bytes);
  PutWord32(BaseChecksum(base), &bytes);
  for (const LevelSteps& s : steps) PutSteps(s, &bytes);
  PutVarint(tags.size(), &bytes);
  bytes.insert(bytes.end(), tags.begin(), tags.end());
  Crc32 crc;
  crc.Add(bytes);
  PutWord16(crc.low16(), &bytes);
  return bytes;
}

// Whether decoders, who see the topology `read`, know the same edges, curves and copies as the encoder.
bool SameCurves(const Topology& read, const Topology& given) {
  if (read.edges != given.edges || read.on_curve != given.on_curve || read.role != given.role) return false;
  for (uint32_t e = 0; e < read.num_edges(); ++e) {
    if (read.is_copy(e) != given.is_copy(e) || (read.is_copy(e) && read.master[e] != given.master[e])) return false;
  }
  return true;
}

StatusOr<Bytes> WriteTags(const BaseMesh& base, BaseTags tags, const Topology& topology) {
  tags = NormalizedTags(std::move(tags));
  RangeEncoder encoder;
  LACERTA_ASSIGN_OR_RETURN(const Topology read,
                           tags.empty() ? BuildTopology(static_cast<uint32_t>(base.lattice.size()), base.triangles)
                                        : CodeBaseTags(base.lattice, base.triangles, &tags, &encoder));
  if (SameCurves(read, topology)) return tags.empty() ? Bytes() : encoder.Finish();
  return InvalidArgument("the tags are not those of the topologies, or borders are joined on the base lattice that should not be, or "
                         "the other way round; take a smaller step");
}

void PutSegment(int level, const Bytes& payload, Bytes* bytes) {
  PutVarint(payload.size(), bytes);
  PutWord16(SegmentChecksum(level, payload), bytes);
  bytes->insert(bytes->end(), payload.begin(), payload.end());
}

Status CheckSet(const char* name, int level, const std::vector<int32_t>& set, size_t size, float step, uint8_t bias) {
  const std::string where = std::string(name) + " set of level " + std::to_string(level);
  if (set.size() != size) {
    return InvalidArgument(where + " has " + std::to_string(set.size()) + " coefficients, not " + std::to_string(size));
  }
  if (RoundStep(step) != step || bias > kMaxBias)
    return InvalidArgument(where + ": the step is not rounded or the bias over 15");
  uint32_t largest = 0;
  for (const int32_t q : set) largest = std::max(largest, Magnitude(q));
  if (largest <= static_cast<uint32_t>(step > 0 ? kMaxMagnitude : 0)) return Status();
  return InvalidArgument(where + " has a coefficient of magnitude " + std::to_string(largest) +
                         (step > 0 ? "; take a larger step" : " but no step"));
}

Status CheckLevel(int level, const Topology& t, const LevelSteps& steps, const QuantizedLevel& q) {
  for (uint32_t e = 0; e < t.num_edges() && e < q.normal.size() && 2 * size_t{e} + 1 < q.tangential.size(); ++e) {
    if (!t.is_copy(e) || (q.normal[e] == 0 && q.tangential[2 * size_t{e}] == 0 && q.tangential[2 * size_t{e} + 1] == 0)) continue;
    return InvalidArgument("edge " + std::to_string(e) + " of level " + std::to_string(level) + " is a copy and has coefficients");
  }
  LACERTA_RETURN_IF_ERROR(CheckSet("normal", level, q.normal, t.num_edges(), steps.normal_step, steps.normal_bias));
  return CheckSet("tangential", level, q.tangential, size_t{2} * t.num_edges(), steps.tangential_step,
                  steps.tangential_bias);
}

}  // namespace

StatusOr<std::vector<Topology>> BuildTopologies(const BaseMesh& base, int num_levels, const BaseTags& tags) {
  if (num_levels < 0 || num_levels > kMaxLevels) {
    return InvalidArgument(std::to_string(num_levels) + " levels; 0 to " + std::to_string(kMaxLevels) +
                           " are possible");
  }
  std::vector<Topology> topologies;
  if (num_levels == 0) return topologies;
  LACERTA_ASSIGN_OR_RETURN(Topology t, BuildTopology(static_cast<uint32_t>(base.lattice.size()), base.triangles, tags));
  const auto widest = std::max_element(t.valence.begin(), t.valence.end());
  if (widest != t.valence.end() && *widest > kMaxBaseValence) {
    return InvalidData("base vertex " + std::to_string(widest - t.valence.begin()) + " has " + std::to_string(*widest) +
                       " edges; a refined base has at most " + std::to_string(kMaxBaseValence));
  }
  if (2 * SubdividedCounts({t.num_vertices, t.num_edges(), t.num_faces()}, num_levels).edges >= kNone) {
    return InvalidArgument("a base of " + std::to_string(t.num_faces()) + " triangles is too large for " +
                           std::to_string(num_levels) + " levels");
  }
  topologies.push_back(std::move(t));
  while (static_cast<int>(topologies.size()) < num_levels) topologies.push_back(Refine(topologies.back()));
  return topologies;
}

StatusOr<RefinementBytes> WriteRefinement(const BaseMesh& base, Span<const Topology> topologies,
                                          const std::vector<LevelSteps>& steps,
                                          const std::vector<QuantizedLevel>& levels, const BaseTags& tags) {
  if (topologies.size() != levels.size() || steps.size() != levels.size()) {
    return InvalidArgument("numbers of topologies, steps and levels differ");
  }
  if (!(base.step > 0) || !std::isnormal(base.step)) return InvalidArgument("the base step must be a positive number");
  RefinementBytes result;
  if (levels.empty()) return result;
  LACERTA_ASSIGN_OR_RETURN(const Bytes coded_tags, WriteTags(base, tags, topologies[0]));
  result.bytes = WriteHeader(base, steps, coded_tags);
  size_t part_begin = 0;
  CodingState state;
  for (size_t i = 0; i < levels.size(); ++i) {
    const int level = static_cast<int>(i) + 1;
    LACERTA_RETURN_IF_ERROR(CheckLevel(level, topologies[i], steps[i], levels[i]));
    RangeEncoder encoder;
    QuantizedLevel coefficients = levels[i];
    CodeLevel(topologies[i], steps[i], &state, &coefficients, &encoder);
    PutSegment(level, encoder.Finish(), &result.bytes);
    result.part_sizes.push_back(result.bytes.size() - part_begin);
    part_begin = result.bytes.size();
  }
  return result;
}

StatusOr<RefinementBytes> WriteRefinement(const BaseMesh& base, const std::vector<LevelSteps>& steps,
                                          const std::vector<QuantizedLevel>& levels, const BaseTags& tags) {
  LACERTA_ASSIGN_OR_RETURN(const std::vector<Topology> topologies,
                           BuildTopologies(base, static_cast<int>(levels.size()), tags));
  return WriteRefinement(base, topologies, steps, levels, tags);
}

}  // namespace lacerta
