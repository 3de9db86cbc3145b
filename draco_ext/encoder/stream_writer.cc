#include "encoder/stream_writer.h"

#include <algorithm>
#include <string>
#include <utility>

#include "common/base_tags_coding.h"
#include "common/coefficient_coding.h"
#include "common/crc32.h"
#include "common/step_forecast.h"
#include "common/stream_layout.h"
#include "encoder/byte_writer.h"
#include "encoder/range_encoder.h"

namespace lacerta {
namespace {

// A step beside the code that is expected of it.
struct ToldStep {
  bool is_coded;
  int bits, expected;

  bool is_expected() const { return !is_coded || bits == expected; }
};

ToldStep Tell(float step, int expected) { return {step > 0, StepToBits(step), expected}; }

// Code of the normal step of level 1, or, where it has none, of one from which later steps come out as expected.
int FirstStepBits(const std::vector<LevelSteps>& steps) {
  size_t i = 0;
  while (i < steps.size() && steps[i].is_silent()) ++i;
  if (i == steps.size()) return kLeastStepBits;
  const LevelSteps& coded = steps[i];
  int bits = coded.normal_step > 0 ? StepToBits(coded.normal_step)
                                   : std::max(kLeastStepBits, StepToBits(coded.tangential_step) - TangentialStepBits(0));
  for (; i > 0; --i) {
    int before = bits;
    while (before > kLeastStepBits && NextStepBits(before) > bits) --before;
    bits = before;
  }
  return bits;
}

void PutSteps(const std::vector<LevelSteps>& steps, Bytes* bytes) {
  Bytes flags, fields;
  int normal_bits = FirstStepBits(steps);
  PutWord16(static_cast<uint32_t>(normal_bits), &fields);
  for (const LevelSteps& s : steps) {
    const ToldStep normal = Tell(s.normal_step, normal_bits);
    if (normal.is_coded) normal_bits = normal.bits;
    const ToldStep tangential = Tell(s.tangential_step, TangentialStepBits(normal_bits));
    const int biases = (normal.is_coded ? s.normal_bias : 0) | (tangential.is_coded ? s.tangential_bias << 4 : 0);
    const bool differs = !normal.is_expected() || !tangential.is_expected();
    flags.push_back(static_cast<uint8_t>((normal.is_coded ? kCodesNormal : 0) | (tangential.is_coded ? kCodesTangential : 0) |
                                         (differs ? kHasDifferences : 0) | (biases != 0 ? kHasBiases : 0)));
    for (const ToldStep& step : {normal, tangential}) {
      if (differs && step.is_coded) PutSignedVarint(step.bits - step.expected, &fields);
    }
    if (biases != 0) fields.push_back(static_cast<uint8_t>(biases));
    normal_bits = NextStepBits(normal_bits);
  }
  flags.resize(flags.size() + flags.size() % 2);
  for (size_t i = 0; i < flags.size(); i += 2) bytes->push_back(static_cast<uint8_t>(flags[i] | flags[i + 1] << 4));
  bytes->insert(bytes->end(), fields.begin(), fields.end());
}

Bytes WriteHeader(const BaseMesh& base, const std::vector<LevelSteps>& steps, const Bytes& tags, BaseStepField base_step, bool has_layers) {
  Bytes bytes(kRefinementMagic.begin(), kRefinementMagic.end());
  bytes.push_back(kRefinementVersion);
  const bool has_base_step = base_step == BaseStepField::kWritten;
  bytes.push_back(static_cast<uint8_t>(steps.size() | (tags.empty() ? 0 : kHasTags) | (has_base_step ? kHasBaseStep : 0) |
                                       (has_layers ? kHasLayers : 0)));
  if (has_base_step) PutWord16(StepToBits(base.step), &bytes);
  PutWord16(BaseChecksum(base), &bytes);
  PutSteps(steps, &bytes);
  if (!tags.empty()) PutVarint(tags.size(), &bytes);
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

// The header, where all that goes into the stream keeps to the rules of WriteRefinement; no byte where there is no level.
StatusOr<Bytes> CheckAndWriteHeader(const BaseMesh& base, Span<const Topology> topologies, const std::vector<LevelSteps>& steps,
                                    const std::vector<QuantizedLevel>& levels, const BaseTags& tags, BaseStepField base_step, bool has_layers) {
  if (topologies.size() != levels.size() || steps.size() != levels.size()) {
    return InvalidArgument("numbers of topologies, steps and levels differ");
  }
  if (!(base.step > 0) || RoundStep(base.step) != base.step) return InvalidArgument("the base step must be a positive number of 8 significant bits");
  if (levels.empty()) return Bytes();
  LACERTA_ASSIGN_OR_RETURN(const Bytes coded_tags, WriteTags(base, tags, topologies[0]));
  for (size_t i = 0; i < levels.size(); ++i) {
    LACERTA_RETURN_IF_ERROR(CheckCoefficients(static_cast<int>(i) + 1, topologies[i], steps[i], levels[i]));
  }
  return WriteHeader(base, steps, coded_tags, base_step, has_layers);
}

}  // namespace

Status CheckCoefficients(int level, const Topology& t, const LevelSteps& steps, const QuantizedLevel& q) {
  for (uint32_t e = 0; e < t.num_edges() && e < q.normal.size() && 2 * size_t{e} + 1 < q.tangential.size(); ++e) {
    if (!t.is_copy(e) || (q.normal[e] == 0 && q.tangential[2 * size_t{e}] == 0 && q.tangential[2 * size_t{e} + 1] == 0)) continue;
    return InvalidArgument("edge " + std::to_string(e) + " of level " + std::to_string(level) + " is a copy and has coefficients");
  }
  LACERTA_RETURN_IF_ERROR(CheckSet("normal", level, q.normal, t.num_edges(), steps.normal_step, steps.normal_bias));
  return CheckSet("tangential", level, q.tangential, size_t{2} * t.num_edges(), steps.tangential_step,
                  steps.tangential_bias);
}

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

StatusOr<Bytes> WriteLayeredHeader(const BaseMesh& base, Span<const Topology> topologies, const std::vector<LevelSteps>& steps,
                                   const std::vector<QuantizedLevel>& levels, const BaseTags& tags, BaseStepField base_step) {
  return CheckAndWriteHeader(base, topologies, steps, levels, tags, base_step, true);
}

StatusOr<RefinementBytes> WriteRefinement(const BaseMesh& base, Span<const Topology> topologies,
                                          const std::vector<LevelSteps>& steps,
                                          const std::vector<QuantizedLevel>& levels, const BaseTags& tags, BaseStepField base_step) {
  RefinementBytes result;
  LACERTA_ASSIGN_OR_RETURN(result.bytes, CheckAndWriteHeader(base, topologies, steps, levels, tags, base_step, false));
  size_t part_begin = 0;
  CodingState state;
  for (size_t i = 0; i < levels.size(); ++i) {
    RangeEncoder encoder;
    QuantizedLevel coefficients = levels[i];
    CodeLevel(topologies[i], steps[i], &state, &coefficients, &encoder);
    if (!steps[i].is_silent()) PutSegment(static_cast<int>(i) + 1, encoder.Finish(), &result.bytes);
    result.part_sizes.push_back(result.bytes.size() - part_begin);
    part_begin = result.bytes.size();
  }
  return result;
}

StatusOr<RefinementBytes> WriteRefinement(const BaseMesh& base, const std::vector<LevelSteps>& steps,
                                          const std::vector<QuantizedLevel>& levels, const BaseTags& tags, BaseStepField base_step) {
  LACERTA_ASSIGN_OR_RETURN(const std::vector<Topology> topologies,
                           BuildTopologies(base, static_cast<int>(levels.size()), tags));
  return WriteRefinement(base, topologies, steps, levels, tags, base_step);
}

}  // namespace lacerta
