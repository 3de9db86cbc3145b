// The decoder on one page: bytes -> header -> per level: segment -> coefficients -> positions.
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "common/attributed_level.h"
#include "common/base_tags.h"
#include "common/base_tags_coding.h"
#include "common/butterfly.h"
#include "common/coefficient_coding.h"
#include "common/glued_base.h"
#include "common/length_classes.h"
#include "common/stream_layout.h"
#include "common/subdivision.h"
#include "decoder/attribute_decoder.h"
#include "decoder/layer_decoder.h"
#include "decoder/level_limits.h"
#include "decoder/range_decoder.h"
#include "decoder/silent_level.h"
#include "decoder/stream_reader.h"
#include "decoder/synthesis.h"
#include "lacerta/decoder.h"

namespace lacerta {
namespace {

Status CheckBase(const BaseMesh& base, const DecodeLimits& limits) {
  LACERTA_RETURN_IF_ERROR(CheckBaseFits(base.lattice.size(), base.triangles.size(), limits));
  if (!(base.step > 0) || !std::isnormal(base.step))
    return InvalidData("the step of the base mesh is not a positive number");
  for (size_t v = 0; v < base.lattice.size(); ++v) {
    for (const int32_t value : base.lattice[v]) {
      if (value >= -kMaxLatticeValue && value <= kMaxLatticeValue) continue;
      return InvalidData("vertex " + std::to_string(v) + " of the base mesh is off the lattice range of 24 bits");
    }
  }
  return Status();
}

// checksum: of the base.
Status CheckHeaderFitsBase(const RefinementHeader& header, const BaseMesh& base, uint16_t checksum) {
  const bool same_step = header.base_step == 0 || header.base_step == base.step;
  if (same_step && header.base_checksum == checksum) return Status();
  return InvalidData("the refinement was made for another base mesh: the base was edited, reordered or mixed up");
}

// A base that decodes as a different attribute would is not noticed by its checksum.
Status CheckAttributesFit(const RefinementHeader& header, const std::vector<AttributeLattice>& given) {
  const auto same = [](const AttributeHeader& a, const AttributeLattice& b) {
    const AttributeLattice& p = a.precision;
    return p.kind == b.kind && p.components == b.components && p.step == b.step && p.octahedral_bits == b.octahedral_bits;
  };
  if (std::equal(header.attributes.begin(), header.attributes.end(), given.begin(), given.end(), same)) return Status();
  return InvalidData("the attributes of the base are not those of the refinement");
}

Status CheckValences(const Topology& t) {
  for (uint32_t v = 0; v < t.num_vertices; ++v) {
    if (t.valence[v] <= kMaxBaseValence) continue;
    return InvalidData("base vertex " + std::to_string(v) + " has " + std::to_string(t.valence[v]) +
                       " edges; a refined base has at most " + std::to_string(kMaxBaseValence));
  }
  return Status();
}

// Topology of a base with the tags of its header, which are written too.
StatusOr<Topology> ReadTopology(const BaseMesh& base, Span<const uint8_t> payload, BaseTags* tags) {
  if (payload.empty()) return BuildTopology(static_cast<uint32_t>(base.lattice.size()), base.triangles);
  RangeDecoder decoder(payload);
  return CodeBaseTags(base.lattice, base.triangles, tags, &decoder);
}

}  // namespace

struct ProgressiveDecoder::State {
  SemiRegularMesh mesh;
  BaseMesh base;
  uint16_t base_checksum = 0;
  bool is_attributed = false;              // the base was an AttributedBase
  std::vector<AttributeLattice> precision;  // of its attributes
  std::vector<uint32_t> base_groups;       // #F0 then
  std::vector<LevelAttribute> attributes;
  RefinementOptions options;

  std::optional<RefinementHeader> header;
  Bytes pending;          // not yet used
  size_t bytes_used = 0;  // that left `pending`
  Status refinement;

  Topology topology;     // of level `topology_level`; made when the header has come
  int topology_level = 0;  // the finest complete level, or one or two before: tables are large, and not wanted for a silent last level nor after it
  size_t num_still = 0;  // triangles that no level splits
  std::optional<StencilTable> stencils;
  CodingState coding;
  std::vector<AttributeDecoder> attribute_decoders;
  std::optional<LayerDecoder> layers;      // where the stream has layers; topology, stencils and coding are not used then
  std::vector<LayerPayload> waiting;       // for the segment that they are to be shown with
  size_t waiting_size = 0;                 // bytes of these segments
  int num_states = 0;                      // above the base, so far

  int last_level() const {
    const int announced = static_cast<int>(header->steps.size());
    return options.max_level ? std::min(announced, *options.max_level) : announced;
  }
  bool done() const {
    return !refinement.ok() || (header && (layers ? layers->is_complete() : mesh.num_levels >= last_level()));
  }

  void Start(BaseMesh given, uint16_t checksum, const RefinementOptions& wanted);
  // Reads on in `bytes`; returns how many of them were used, or nothing where they end too early.
  StatusOr<std::optional<size_t>> TakeHeader(Span<const uint8_t> bytes);
  StatusOr<std::optional<size_t>> TakeSegment(Span<const uint8_t> bytes);
  StatusOr<std::optional<size_t>> TakeLayer(Span<const uint8_t> bytes);
  Status StartAttributes();
  bool NeedsNoTables() const;
  void ReachFinestLevel();
  Status CheckNextFits();
  Status AddLevel(const LevelSteps& steps, Span<const uint8_t> payload);
  void DecodePositions(const LevelSteps& steps, RangeDecoder* decoder);
  Status AddAttributes(RangeDecoder* decoder);
};

StatusOr<std::optional<size_t>> ProgressiveDecoder::State::TakeHeader(Span<const uint8_t> bytes) {
  LACERTA_ASSIGN_OR_RETURN(std::optional<ReadHeader> read,
                           ReadRefinementHeader(bytes, MaxTagBytes(base.lattice.size(), base.triangles.size())));
  if (!read) return std::optional<size_t>();
  if (read->header.is_attributed != is_attributed) {
    return InvalidData(is_attributed ? "the refinement has no attributes: it wants a base without" : "the refinement has attributes: it wants a base with them");
  }
  LACERTA_RETURN_IF_ERROR(CheckHeaderFitsBase(read->header, base, base_checksum));
  LACERTA_RETURN_IF_ERROR(CheckAttributesFit(read->header, precision));
  BaseTags tags;
  LACERTA_ASSIGN_OR_RETURN(topology, ReadTopology(base, read->header.tags, &tags));
  LACERTA_RETURN_IF_ERROR(CheckValences(topology));
  mesh.tags = std::move(tags);
  num_still = NumStill(mesh.tags);
  header = std::move(read->header);
  LACERTA_RETURN_IF_ERROR(StartAttributes());
  if (header->has_layers) {
    layers.emplace(header->steps, std::move(topology), num_still, last_level(), options.limits);
  } else {
    stencils.emplace(topology);
    coding.length_classes = LengthClasses(topology, base.lattice);
  }
  return std::optional<size_t>(read->size);
}

StatusOr<std::optional<size_t>> ProgressiveDecoder::State::TakeLayer(Span<const uint8_t> bytes) {
  LACERTA_ASSIGN_OR_RETURN(const std::optional<ReadLayer> read, ReadLayerSegment(bytes));
  if (!read) return std::optional<size_t>();
  waiting.push_back({read->segment, Bytes(read->payload.begin(), read->payload.end())});
  waiting_size += read->size;
  if (!read->segment.waits) {
    LACERTA_RETURN_IF_ERROR(layers->Take(std::exchange(waiting, {})));
    bytes_used += std::exchange(waiting_size, 0);
    ++num_states;
  }
  return std::optional<size_t>(read->size);
}

StatusOr<std::optional<size_t>> ProgressiveDecoder::State::TakeSegment(Span<const uint8_t> bytes) {
  const int level = mesh.num_levels + 1;
  LACERTA_RETURN_IF_ERROR(CheckNextFits());
  if (!NeedsNoTables()) ReachFinestLevel();
  const LevelSteps& steps = header->steps[static_cast<size_t>(mesh.num_levels)];
  std::optional<ReadSegment> segment = ReadSegment();  // of a silent level
  if (!header->IsSilent(static_cast<size_t>(mesh.num_levels))) {
    LACERTA_ASSIGN_OR_RETURN(segment, ReadRefinementSegment(bytes, level));
  }
  if (!segment) return std::optional<size_t>();
  LACERTA_RETURN_IF_ERROR(AddLevel(steps, segment->payload));
  return std::optional<size_t>(segment->size);
}

// Of the next level: it is the last one and nothing but midpoints, which the tables that are there tell.
bool ProgressiveDecoder::State::NeedsNoTables() const {
  const auto next = static_cast<size_t>(mesh.num_levels);
  const bool is_plain = header->IsSilent(next) && !header->steps[next].is_curved && topology.master.empty();
  return is_plain && attribute_decoders.empty() && mesh.num_levels + 1 == last_level() && topology_level < mesh.num_levels;
}

void ProgressiveDecoder::State::ReachFinestLevel() {
  if (topology_level == mesh.num_levels) return;
  topology = Refine(topology);
  ++topology_level;
}

Status ProgressiveDecoder::State::StartAttributes() {
  for (size_t i = 0; i < attributes.size(); ++i) {
    LACERTA_ASSIGN_OR_RETURN(AttributeDecoder decoder, AttributeDecoder::Create(header->attributes[i], attributes[i], mesh.tags.still));
    attribute_decoders.push_back(std::move(decoder));
  }
  return Status();
}

Status ProgressiveDecoder::State::CheckNextFits() {
  const int level = mesh.num_levels + 1;
  LACERTA_RETURN_IF_ERROR(CheckLevelFits(topology, num_still, level, options.limits, level - topology_level));
  uint64_t num_floats = 0;
  for (AttributeDecoder& decoder : attribute_decoders) LACERTA_RETURN_IF_ERROR(decoder.CheckNextFits(options.limits, &num_floats));
  return Status();
}

// Adds the level at hand to all attributes or, where one of them fails, to none.
Status ProgressiveDecoder::State::AddAttributes(RangeDecoder* decoder) {
  const SurfaceLevel surface{topology, mesh.positions};
  std::vector<size_t> before;
  for (const LevelAttribute& a : attributes) before.push_back(a.values.size());
  for (size_t i = 0; i < attributes.size(); ++i) {
    Status added = attribute_decoders[i].AddLevel(surface, decoder, &attributes[i]);
    if (added.ok()) continue;
    for (size_t k = 0; k < i; ++k) attributes[k].values.resize(before[k]);
    return added;
  }
  return Status();
}

Status ProgressiveDecoder::State::AddLevel(const LevelSteps& steps, Span<const uint8_t> payload) {
  const size_t num_before = mesh.positions.size();
  RangeDecoder decoder(payload);
  if (NeedsNoTables()) {
    PredictRefinedMidpoints(topology, *stencils, &mesh.positions);
  } else {
    DecodePositions(steps, &decoder);
  }
  const bool are_finite = AreFinite(Span<const Vec3f>(mesh.positions).Subspan(num_before));
  const Status added = are_finite ? AddAttributes(&decoder)
                                  : InvalidData("level " + std::to_string(mesh.num_levels + 1) + " has positions that are not finite");
  if (!added.ok()) {
    mesh.positions.resize(num_before);
    return added;
  }
  ++mesh.num_levels;
  ++num_states;
  return Status();
}

void ProgressiveDecoder::State::DecodePositions(const LevelSteps& steps, RangeDecoder* decoder) {
  QuantizedLevel quantized;
  if (!steps.is_silent()) quantized = ZeroLevel(topology.num_edges());
  const LevelSteps finer = mesh.num_levels + 1 < last_level() ? header->steps[mesh.num_levels + 1] : LevelSteps();
  coding.normal_continues = finer.normal_step > 0;
  coding.tangential_continues = finer.tangential_step > 0;
  CodeLevel(topology, steps, &coding, &quantized, decoder);
  SynthesizeLevel(topology, *stencils, steps, quantized, &mesh.positions);
}

void ProgressiveDecoder::State::Start(BaseMesh given, uint16_t checksum, const RefinementOptions& wanted) {
  TriangleMesh surface = given.ToMesh();
  mesh.num_base_vertices = static_cast<uint32_t>(given.lattice.size());
  mesh.base_triangles = std::move(surface.triangles);
  mesh.positions = std::move(surface.positions);
  base = std::move(given);
  base_checksum = checksum;
  options = wanted;
}

StatusOr<ProgressiveDecoder> ProgressiveDecoder::Create(const BaseMesh& base, const RefinementOptions& options) {
  LACERTA_RETURN_IF_ERROR(CheckBase(base, options.limits));
  auto state = std::make_unique<State>();
  state->Start(base, BaseChecksum(base), options);
  return ProgressiveDecoder(std::move(state));
}

StatusOr<ProgressiveDecoder> ProgressiveDecoder::Create(const AttributedBase& base, const RefinementOptions& options) {
  LACERTA_RETURN_IF_ERROR(CheckBase(base.mesh, options.limits));
  LACERTA_ASSIGN_OR_RETURN(GluedBase glued, GlueBase(base));
  auto state = std::make_unique<State>();
  state->is_attributed = true;
  for (const BaseAttribute& a : base.attributes) state->precision.push_back(a.precision);
  state->base_groups = std::move(glued.groups);
  state->attributes = std::move(glued.attributes);
  state->Start(std::move(glued.mesh), BaseChecksum(base), options);
  return ProgressiveDecoder(std::move(state));
}

Status ProgressiveDecoder::Append(Span<const uint8_t> bytes) {
  State& s = *state_;
  if (s.done()) return s.refinement;
  s.pending.insert(s.pending.end(), bytes.begin(), bytes.end());
  size_t used = 0;
  const int shown_before = s.num_states;
  size_t bytes_of_shown = s.bytes_used;
  while (!s.done()) {
    const Span<const uint8_t> rest = Span<const uint8_t>(s.pending.data(), s.pending.size()).Subspan(used);
    const bool was_header = !s.header;
    const StatusOr<std::optional<size_t>> taken = !s.header ? s.TakeHeader(rest) : s.layers ? s.TakeLayer(rest) : s.TakeSegment(rest);
    if (!taken.ok()) s.refinement = taken.status();
    if (!taken.ok() || !taken.value()) break;
    used += *taken.value();
    if (!s.layers || was_header) s.bytes_used += *taken.value();
    if (was_header) bytes_of_shown = s.bytes_used;
  }
  if (s.layers && s.num_states > shown_before) {
    const Status shown = s.layers->Show(&s.mesh);
    if (s.refinement.ok()) s.refinement = shown;
    if (shown.code() == StatusCode::kInvalidData) {  // nothing of these bytes is in the mesh
      s.num_states = shown_before;
      s.bytes_used = bytes_of_shown;
    }
  }
  s.pending.erase(s.pending.begin(), s.pending.begin() + static_cast<ptrdiff_t>(used));
  if (s.done()) s.pending = {};
  return s.refinement;
}

ProgressiveDecoder::ProgressiveDecoder(std::unique_ptr<State> state) : state_(std::move(state)) {}
ProgressiveDecoder::ProgressiveDecoder(ProgressiveDecoder&&) noexcept = default;
ProgressiveDecoder& ProgressiveDecoder::operator=(ProgressiveDecoder&&) noexcept = default;
ProgressiveDecoder::~ProgressiveDecoder() = default;

int ProgressiveDecoder::level() const { return state_->mesh.num_levels; }
int ProgressiveDecoder::num_levels() const {
  return state_->header ? static_cast<int>(state_->header->steps.size()) : 0;
}
int ProgressiveDecoder::state() const { return state_->num_states; }
bool ProgressiveDecoder::has_layers() const { return state_->header && state_->header->has_layers; }
bool ProgressiveDecoder::is_complete() const { return state_->header && state_->refinement.ok() && state_->done(); }
size_t ProgressiveDecoder::bytes_used() const { return state_->bytes_used; }
const Status& ProgressiveDecoder::refinement() const { return state_->refinement; }
const SemiRegularMesh& ProgressiveDecoder::mesh() const { return state_->mesh; }

std::vector<Triangle> ProgressiveDecoder::Triangles() const {
  const State& s = *state_;
  if (s.mesh.num_levels == 0) return s.mesh.base_triangles;
  if (s.layers) return WithStillTriangles(s.layers->ShownTriangles(), s.mesh.base_triangles, s.mesh.tags);
  const int finer = s.mesh.num_levels - s.topology_level;
  return WithStillTriangles(finer == 2   ? RefineTrianglesTwice(s.topology)
                            : finer == 1 ? RefineTriangles(s.topology)
                                         : s.topology.triangles,
                            s.mesh.base_triangles, s.mesh.tags);
}

const std::vector<LevelAttribute>& ProgressiveDecoder::attributes() const { return state_->attributes; }
const std::vector<uint32_t>& ProgressiveDecoder::base_groups() const { return state_->base_groups; }

std::vector<Triangle> ProgressiveDecoder::Corners(size_t attribute) const {
  const State& s = *state_;
  const LevelAttribute& a = s.attributes[attribute];
  if (s.mesh.num_levels == 0) return a.base_corners;
  const size_t num_split = (a.base_corners.size() - s.num_still) << 2 * s.mesh.num_levels;
  return WithStillTriangles(s.attribute_decoders[attribute].Corners(s.mesh.num_levels, num_split), a.base_corners, s.mesh.tags);
}

std::vector<uint32_t> ProgressiveDecoder::Groups() const { return GroupsAtLevel(state_->base_groups, state_->mesh.tags, state_->mesh.num_levels); }

SemiRegularMesh ProgressiveDecoder::TakeMesh() && { return std::move(state_->mesh); }

AttributedSemiRegularMesh ProgressiveDecoder::TakeAttributed() && {
  return {std::move(state_->mesh), std::move(state_->base_groups), std::move(state_->attributes)};
}

StatusOr<RefinementInfo> ReadRefinementInfo(Span<const uint8_t> refinement) {
  LACERTA_ASSIGN_OR_RETURN(const std::optional<ReadHeader> read, ReadRefinementHeader(refinement));
  if (!read) return InvalidData("the refinement header is incomplete: " + std::to_string(refinement.size()) + " bytes");
  const RefinementHeader& header = read->header;
  RefinementInfo info{static_cast<int>(header.steps.size()), header.base_step, header.has_layers, header.is_attributed, {}};
  for (const AttributeHeader& a : header.attributes) info.attributes.push_back(a.precision);
  return info;
}

StatusOr<RefinementResult> DecodeRefinement(const BaseMesh& base, Span<const uint8_t> refinement,
                                            const RefinementOptions& options) {
  LACERTA_ASSIGN_OR_RETURN(ProgressiveDecoder decoder, ProgressiveDecoder::Create(base, options));
  RefinementResult result;
  result.refinement = decoder.Append(refinement);
  result.level = decoder.level();
  result.num_levels = decoder.num_levels();
  result.state = decoder.state();
  result.is_complete = decoder.is_complete();
  result.bytes_used = decoder.bytes_used();
  result.mesh = std::move(decoder).TakeMesh();
  return result;
}

StatusOr<TriangleMesh> MeshAtLevel(const SemiRegularMesh& mesh, int level) {
  if (level < 0 || level > mesh.num_levels) {
    return InvalidArgument("the mesh has levels 0 to " + std::to_string(mesh.num_levels) + ", not " +
                           std::to_string(level));
  }
  if (level == 0) {
    const auto end = mesh.positions.begin() + mesh.num_base_vertices;
    return TriangleMesh{std::vector<Vec3f>(mesh.positions.begin(), end), mesh.base_triangles};
  }
  LACERTA_ASSIGN_OR_RETURN(Topology topology, BuildTopology(mesh.num_base_vertices, mesh.base_triangles, mesh.tags));
  const auto num_vertices = static_cast<ptrdiff_t>(SubdividedCounts({topology.num_vertices, topology.num_edges(), topology.num_faces()}, level).vertices);
  for (int i = 2; i < level; ++i) topology = Refine(topology);
  return TriangleMesh{std::vector<Vec3f>(mesh.positions.begin(), mesh.positions.begin() + num_vertices),
                      WithStillTriangles(level > 1 ? RefineTrianglesTwice(topology) : RefineTriangles(topology), mesh.base_triangles, mesh.tags)};
}

}  // namespace lacerta
