#include "encoder/stream_writer.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "common/attribute_coding.h"
#include "common/base_tags_coding.h"
#include "common/coefficient_coding.h"
#include "common/crc16.h"
#include "common/length_classes.h"
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

int NumCurved(const std::vector<LevelSteps>& steps) {
  return static_cast<int>(std::count_if(steps.begin(), steps.end(), [](const LevelSteps& s) { return s.is_curved; }));
}

void PutAttributes(const std::vector<CodedAttribute>& attributes, Bytes* bytes) {
  PutVarint(attributes.size(), bytes);
  for (const CodedAttribute& attribute : attributes) {
    const auto& [precision, prediction, steps, is_chained] = attribute.header;
    bytes->push_back(static_cast<uint8_t>(precision.kind));
    bytes->push_back(static_cast<uint8_t>(static_cast<uint8_t>(prediction) | (is_chained ? kChainedFlag : 0)));
    PutVarint(precision.components, bytes);
    bytes->push_back(static_cast<uint8_t>(precision.name.size()));
    bytes->insert(bytes->end(), precision.name.begin(), precision.name.end());
    if (precision.kind == AttributeKind::kNormal) {
      bytes->push_back(static_cast<uint8_t>(precision.octahedral_bits));
    } else {
      PutWord16(StepToBits(precision.step), bytes);
    }
    uint32_t coded_levels = 0;
    for (size_t i = 0; i < steps.size(); ++i) coded_levels |= static_cast<uint32_t>(steps[i] > 0) << i;
    PutVarint(coded_levels, bytes);
    int before = kFirstAttributeStepBits;
    for (const float step : steps) {
      if (step > 0) PutSignedVarint(StepToBits(step) - std::exchange(before, StepToBits(step)), bytes);
    }
  }
}

Bytes WriteHeader(const BaseMesh& base, const std::vector<LevelSteps>& steps, const Bytes& tags, BaseStepField base_step, bool has_layers,
                  const WrittenAttributes* attributes) {
  Bytes bytes(kRefinementMagic.begin(), kRefinementMagic.end());
  bytes.push_back(static_cast<uint8_t>(kRefinementVersion | NumCurved(steps) << 4));
  const bool has_base_step = base_step == BaseStepField::kWritten;
  bytes.push_back(static_cast<uint8_t>(steps.size() | (tags.empty() ? 0 : kHasTags) | (has_base_step ? kHasBaseStep : 0) |
                                       (has_layers ? kHasLayers : 0) | (attributes != nullptr ? kHasAttributes : 0)));
  if (has_base_step) PutWord16(StepToBits(base.step), &bytes);
  PutWord16(attributes != nullptr ? attributes->base_checksum : BaseChecksum(base), &bytes);
  PutSteps(steps, &bytes);
  if (!tags.empty()) PutVarint(tags.size(), &bytes);
  bytes.insert(bytes.end(), tags.begin(), tags.end());
  if (attributes != nullptr) PutAttributes(attributes->coded, &bytes);
  Crc16 crc;
  crc.Add(bytes);
  PutWord16(crc.value(), &bytes);
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

Status CheckAttribute(const CodedAttribute& attribute, AttributeWedges wedges, size_t num_levels) {
  const auto& [precision, prediction, steps, is_chained] = attribute.header;
  const std::string where = "attribute " + precision.name;
  if (!HasLegalComponents(precision) || precision.name.size() > kMostNameBytes) return InvalidArgument(where + " has illegal components or too long a name");
  if (prediction == AttributePrediction::kGeometry && precision.kind != AttributeKind::kNormal) return InvalidArgument(where + " has no normals to take from the geometry");
  if (is_chained && !HasChain(precision)) return InvalidArgument(where + " has no colors to chain");
  const bool is_normal = precision.kind == AttributeKind::kNormal;
  if (!is_normal && (!(precision.step > 0) || RoundStep(precision.step) != precision.step)) return InvalidArgument(where + ": the base step is not rounded");
  if (steps.size() != num_levels || attribute.residuals.size() != num_levels) return InvalidArgument(where + " has not the levels of the surface");
  for (size_t i = 0; i < num_levels; ++i) {
    if (i > 0) RefineWedges(&wedges);
    const size_t wanted = steps[i] > 0 ? size_t{CodedComponents(precision)} * wedges.topology.num_edges() : attribute.residuals[i].size();
    LACERTA_RETURN_IF_ERROR(CheckSet(where.c_str(), static_cast<int>(i) + 1, attribute.residuals[i], wanted, steps[i], 0));
  }
  return Status();
}

Status CheckAttributes(const WrittenAttributes& attributes, size_t num_levels) {
  if (attributes.coded.size() != attributes.wedges.size()) return InvalidArgument("numbers of attributes and wedge meshes differ");
  uint64_t num_components = 0;
  for (size_t i = 0; i < attributes.coded.size(); ++i) {
    num_components += attributes.coded[i].header.precision.components;
    LACERTA_RETURN_IF_ERROR(CheckAttribute(attributes.coded[i], attributes.wedges[i], num_levels));
  }
  if (num_components <= kMostComponents) return Status();
  return InvalidArgument("the attributes have " + std::to_string(num_components) + " components together; " + std::to_string(kMostComponents) + " are possible");
}

// The header, where all that goes into the stream keeps to the rules of WriteRefinement; no byte where there is no level.
StatusOr<Bytes> CheckAndWriteHeader(const BaseMesh& base, Span<const Topology> topologies, const std::vector<LevelSteps>& steps,
                                    const std::vector<QuantizedLevel>& levels, const BaseTags& tags, BaseStepField base_step, bool has_layers,
                                    const WrittenAttributes* attributes) {
  if (topologies.size() != levels.size() || steps.size() != levels.size()) {
    return InvalidArgument("numbers of topologies, steps and levels differ");
  }
  if (!(base.step > 0) || RoundStep(base.step) != base.step) return InvalidArgument("the base step must be a positive number of 8 significant bits");
  if (levels.empty()) return Bytes();
  for (size_t i = 1; i < steps.size(); ++i) {
    if (steps[i].is_curved && !steps[i - 1].is_curved) return InvalidArgument("level " + std::to_string(i + 1) + " is curved, and a coarser one is not");
  }
  LACERTA_ASSIGN_OR_RETURN(const Bytes coded_tags, WriteTags(base, tags, topologies[0]));
  for (size_t i = 0; i < levels.size(); ++i) {
    LACERTA_RETURN_IF_ERROR(CheckCoefficients(static_cast<int>(i) + 1, topologies[i], steps[i], levels[i]));
  }
  if (attributes != nullptr) LACERTA_RETURN_IF_ERROR(CheckAttributes(*attributes, levels.size()));
  return WriteHeader(base, steps, coded_tags, base_step, has_layers, attributes);
}

// Codes the attributes level by level.
class AttributeWriter {
 public:
  explicit AttributeWriter(const WrittenAttributes& attributes) : attributes_(attributes.coded), wedges_(attributes.wedges) {
    for (const CodedAttribute& a : attributes_) states_.emplace_back(CodedComponents(a.header.precision));
  }

  // Codes the next level; returns whether there was anything to code.
  bool WriteLevel(RangeEncoder* encoder) {
    bool any = false;
    for (size_t a = 0; a < attributes_.size(); ++a) {
      const std::vector<float>& steps = attributes_[a].header.steps;
      if (level_ > 0) RefineWedges(&wedges_[a]);
      std::vector<int32_t> residuals = attributes_[a].residuals[level_];
      const bool continues = level_ + 1 < steps.size() && steps[level_ + 1] > 0;
      CodeAttributeLevel(wedges_[a].topology, steps[level_], continues, &states_[a], &residuals, encoder);
      any = any || steps[level_] > 0;
    }
    ++level_;
    return any;
  }

 private:
  const std::vector<CodedAttribute>& attributes_;
  std::vector<AttributeWedges> wedges_;
  std::vector<AttributeCodingState> states_;
  size_t level_ = 0;
};

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
  return CheckAndWriteHeader(base, topologies, steps, levels, tags, base_step, true, nullptr);
}

StatusOr<RefinementBytes> WriteRefinement(const BaseMesh& base, Span<const Topology> topologies,
                                          const std::vector<LevelSteps>& steps,
                                          const std::vector<QuantizedLevel>& levels, const BaseTags& tags, BaseStepField base_step,
                                          const WrittenAttributes* attributes) {
  RefinementBytes result;
  LACERTA_ASSIGN_OR_RETURN(result.bytes, CheckAndWriteHeader(base, topologies, steps, levels, tags, base_step, false, attributes));
  size_t part_begin = 0;
  CodingState state;
  if (!levels.empty()) state.length_classes = LengthClasses(topologies[0], base.lattice);
  std::optional<AttributeWriter> writer;
  if (attributes != nullptr) writer.emplace(*attributes);
  for (size_t i = 0; i < levels.size(); ++i) {
    RangeEncoder encoder;
    QuantizedLevel coefficients = levels[i];
    CodeLevel(topologies[i], steps[i], &state, &coefficients, &encoder);
    const bool has_residuals = writer && writer->WriteLevel(&encoder);
    if (!steps[i].is_silent() || has_residuals) PutSegment(static_cast<int>(i) + 1, encoder.Finish(), &result.bytes);
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
