#include "pack/family_stream.h"

#include <algorithm>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "draco/attributed_candidate.h"
#include "lacerta/attributed_base.h"
#include "remesh/attributed_still.h"

namespace lacerta {
namespace {

// Streams name attributes as glTF does, so what is of one name and unlike scales cannot be in one.
StatusOr<AttributedMesh> PlainNames(AttributedMesh mesh) {
  std::set<std::string> names;
  for (MeshAttribute& attribute : mesh.attributes) {
    attribute.name = attribute.name.substr(0, attribute.name.find('/'));
    if (!names.insert(attribute.name).second) {
      return Unsupported("its parts have " + attribute.name + " of unlike scales or sizes");
    }
  }
  return mesh;
}

// Tries bases of `coarsest` vertices times powers of two: from one whose third level is as fine as the input downhill, by
// bytes, to either side.
class BaseSearch {
 public:
  BaseSearch(const AttributedSurface& input, const ErrorTargets& targets, size_t coarsest, size_t most)
      : input_(input), targets_(targets), coarsest_(coarsest), most_(most) {}

  std::optional<AttributedTrial> Run() {
    constexpr size_t kStartShare = 48;  // of the input's triangles: twice as many faces, times 64 at level 3, are a bit more
    const size_t num_triangles = input_.original.surface.triangles.size();
    int start = 0;
    while (SizeAt(start + 1) <= std::min(num_triangles / kStartShare, most_)) ++start;
    std::optional<AttributedTrial> best = At(start);
    bool is_downhill = false;
    for (int i = start - 1; i >= 0 && best.has_value() && Take(At(i), &best); --i) is_downhill = true;
    for (int i = start + 1; !is_downhill && SizeAt(i) <= most_; ++i) {
      if (!Take(At(i), &best) && best.has_value()) break;
    }
    return best;
  }

 private:
  size_t SizeAt(int i) const { return coarsest_ << i; }

  std::optional<AttributedTrial> At(int i) const {
    constexpr int kTries = 4;
    constexpr uint64_t kSamples = 100'000;
    const size_t vertices = SizeAt(i);
    int levels = 1;
    for (size_t faces = 8 * vertices; faces < 2 * input_.original.surface.triangles.size() && levels < 4; faces *= 4) ++levels;
    const StatusOr<AttributedCandidate> candidate =
        AttributedCandidate::Create(input_, static_cast<uint32_t>(vertices), levels);
    if (!candidate.ok()) return std::nullopt;
    const bool can_meet = candidate.value().CanMeet(targets_);
    if (!can_meet) return std::nullopt;
    StatusOr<AttributedTrial> trial = candidate.value().Meet(targets_, {kTries, 3, kSamples});
    if (!trial.ok() || trial.value().ratio > 1.0) return std::nullopt;
    return std::move(trial).value();
  }

  // Whether it is the better one, and taken.
  static bool Take(std::optional<AttributedTrial> trial, std::optional<AttributedTrial>* best) {
    if (!trial.has_value() || (best->has_value() && trial->stream.size() >= (*best)->stream.size())) return false;
    *best = std::move(trial);
    return true;
  }

  const AttributedSurface& input_;
  const ErrorTargets& targets_;
  const size_t coarsest_;
  const size_t most_;
};

std::vector<std::string> NamesOf(const AttributedBase& base) {
  std::vector<std::string> names;
  for (const BaseAttribute& attribute : base.attributes) names.push_back(attribute.precision.name);
  return names;
}

Status DescribeLevels(const AttributedStream& stream, const SurfaceErrorMeter& meter, size_t num_groups,
                      ProgressiveStream* description) {
  constexpr uint64_t kSamples = 100'000;
  for (int level = 0; level <= stream.decoded.surface.num_levels; ++level) {
    LACERTA_ASSIGN_OR_RETURN(const AttributedMesh mesh, AttributedMeshAtLevel(stream.decoded, level));
    uint64_t vertices = 0;
    for (const VertexSoup& soup : SplitIntoSoups(mesh, static_cast<uint32_t>(num_groups))) vertices += soup.positions.size();
    LACERTA_ASSIGN_OR_RETURN(const SurfaceErrors errors, meter.Measure(mesh, kSamples));
    description->vertex_counts.push_back(vertices);
    description->triangle_counts.push_back(mesh.surface.triangles.size());
    description->errors.push_back(errors.distance);
    description->min = description->max = mesh.surface.positions[mesh.surface.triangles[0][0]];
    for (const Triangle& t : mesh.surface.triangles) {
      for (const uint32_t v : t) {
        for (int axis = 0; axis < 3; ++axis) {
          const float x = mesh.surface.positions[v][axis];
          description->min[axis] = std::min(description->min[axis], x);
          description->max[axis] = std::max(description->max[axis], x);
        }
      }
    }
  }
  return Status();
}

StatusOr<FamilyStream> ToFamilyStream(const AttributedTrial& trial, const SurfaceErrorMeter& meter, const FamilyMeter& family) {
  const AttributedStream& stream = trial.stream;
  FamilyStream result;
  result.description.attributes = NamesOf(stream.base);
  LACERTA_RETURN_IF_ERROR(DescribeLevels(stream, meter, stream.bases.size(), &result.description));
  for (size_t g = 0; g < stream.bases.size(); ++g) {
    const Bytes& base = stream.bases[g];
    result.description.base_lengths.push_back(base.size());
    result.bytes.insert(result.bytes.end(), base.begin(), base.end());
    FamilyStream::Group group;
    group.ids.push_back({"POSITION", 0});
    std::vector<AttributeReport> reports;
    for (size_t a = 0; a < stream.base.attributes.size(); ++a) {
      const BaseAttribute& attribute = stream.base.attributes[a];
      if (attribute.in_group[g] == 0) continue;
      group.ids.push_back({attribute.precision.name, static_cast<uint32_t>(a + 1)});
      const AttributeKind kind = attribute.precision.kind;
      const bool direction = IsDirection(kind);
      const bool texture = kind == AttributeKind::kTextureCoordinates;
      reports.push_back({attribute.precision.name, 0, family.Reported(trial.errors, a), direction ? "degrees" : texture ? "texels" : ""});
    }
    LACERTA_ASSIGN_OR_RETURN(group.base, DecodeDracoPrimitive(base, group.ids, DecodeLimits{}));
    result.groups.push_back(std::move(group));
    result.reports.push_back(std::move(reports));
  }
  // The vertices of the base are those of its Draco streams.
  result.description.vertex_counts[0] = 0;
  for (const FamilyStream::Group& group : result.groups) result.description.vertex_counts[0] += group.base.num_vertices;
  result.part_sizes.push_back(result.bytes.size());
  result.part_sizes.insert(result.part_sizes.end(), stream.part_sizes.begin(), stream.part_sizes.end());
  result.bytes.insert(result.bytes.end(), stream.refinement.begin(), stream.refinement.end());
  return result;
}

}  // namespace

StatusOr<FamilyStream> StreamFamily(const FamilyMeter& family, const FamilyStreamOptions& options) {
  constexpr double kMostInBase = 0.2;  // of the triangles to beat: what a base takes for the same triangles is no less
  LACERTA_RETURN_IF_ERROR(family.status());
  if (family.leaves_out()) return Unsupported("has attributes that cannot be interpolated");
  LACERTA_ASSIGN_OR_RETURN(const AttributedMesh original, PlainNames(family.original()));
  const double texel_side = family.meter().texture_size();
  LACERTA_ASSIGN_OR_RETURN(AttributedParts parts, SplitAttributedSurface(original));
  LACERTA_ASSIGN_OR_RETURN(const CollapseHistory history, DecimateAttributed(parts));
  const size_t coarsest = history.FacesAt(history.num_collapses()).size();
  const auto budget = static_cast<double>(options.triangles_to_beat);
  if (options.triangles_to_beat > 0 && static_cast<double>(coarsest) > kMostInBase * budget) {
    return Unsupported("its seams and creases leave no coarse base");
  }
  LACERTA_RETURN_IF_ERROR(SimplifyStill(family.targets(), texel_side, &parts));
  if (options.triangles_to_beat > 0 && static_cast<double>(coarsest + parts.still.surface.triangles.size()) > kMostInBase * budget) {
    return Unsupported("most of it are small parts");
  }
  LACERTA_ASSIGN_OR_RETURN(const SurfaceErrorMeter meter, SurfaceErrorMeter::Create(original, texel_side));
  const InputSurface surface(parts.refined.surface, parts.topology);
  const size_t most = std::max<size_t>(parts.refined.surface.triangles.size() / 8, 80);
  const AttributedSurface input{original, meter, parts, surface, history};
  const std::optional<AttributedTrial> trial = BaseSearch(input, family.targets(), std::max<size_t>(coarsest / 2, 40), most).Run();
  if (!trial.has_value()) return Unsupported("no base makes a remesh that is close enough");
  if (options.bytes_to_beat > 0 && trial->stream.size() >= options.bytes_to_beat) {
    return Unsupported("as a stream it would be larger (" + std::to_string(trial->stream.size()) + " bytes)");
  }
  return ToFamilyStream(*trial, meter, family);
}

}  // namespace lacerta
