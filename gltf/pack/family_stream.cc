#include "pack/family_stream.h"

#include <algorithm>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "draco/attributed_search.h"
#include "extension/target_channels.h"
#include "lacerta/attributed_base.h"
#include "lacerta/surface_distance.h"
#include "pack/weighted_family.h"

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

std::vector<std::string> NamesOf(const AttributedBase& base) {
  std::vector<std::string> names;
  for (const BaseAttribute& attribute : base.attributes) names.push_back(attribute.precision.name);
  return names;
}

std::vector<std::string> NamesOf(const AttributedMesh& mesh) {
  std::vector<std::string> names;
  for (const MeshAttribute& attribute : mesh.attributes) names.push_back(attribute.name);
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

EncodeReport ReportOf(const AttributedTrial& trial, const FamilyStream& stream, const FamilyMeter& family) {
  EncodeReport report;
  for (const Primitive* primitive : family.primitives()) report.input_vertices += primitive->num_vertices;
  report.input_triangles = family.original().surface.triangles.size();
  report.diagonal = family.meter().diagonal();
  report.progressive = true;
  report.remesh_psnr = Psnr(trial.remesh_distance, report.diagonal);
  report.measurements = trial.measurements;
  const ProgressiveStream& description = stream.description;
  uint64_t bytes = 0;
  for (size_t level = 0; level < description.errors.size(); ++level) {
    bytes += stream.part_sizes[level];
    report.levels.push_back({description.vertex_counts[level], description.triangle_counts[level], bytes,
                             description.errors[level], Psnr(description.errors[level], report.diagonal)});
  }
  return report;
}

// weighted: of a family with a skin.
StatusOr<FamilyStream> ToFamilyStream(const AttributedTrial& trial, const SurfaceErrorMeter& meter,
                                      const FamilyMeter& family, const std::optional<WeightedFamily>& weighted,
                                      const MorphChannels* morphs) {
  const AttributedStream& stream = trial.stream;
  FamilyStream result;
  result.description.attributes = NamesOf(stream.base);
  if (weighted) result.description.joints = weighted->joints;
  LACERTA_RETURN_IF_ERROR(DescribeLevels(stream, meter, stream.bases.size(), &result.description));
  std::vector<std::vector<MorphTarget>> targets(stream.bases.size());
  if (morphs != nullptr) targets = morphs->PlainTargets(stream.base);
  for (size_t g = 0; g < stream.bases.size(); ++g) {
    const Bytes& base = stream.bases[g];
    result.description.base_lengths.push_back(base.size());
    result.bytes.insert(result.bytes.end(), base.begin(), base.end());
    FamilyStream::Group group;
    group.targets = std::move(targets[g]);
    group.ids.push_back({"POSITION", 0});
    std::vector<AttributeReport> reports;
    for (size_t a = 0; a < stream.base.attributes.size(); ++a) {
      const BaseAttribute& attribute = stream.base.attributes[a];
      if (attribute.in_group[g] == 0) continue;
      if (const auto channels = ParseTargetChannels(attribute.precision.name); channels.has_value()) {
        const bool positions = channels->attribute == "POSITION";
        reports.push_back({attribute.precision.name, 0, trial.errors.attributes[a].rms_99,
                           positions ? "units in the worst target" : "radians in the worst target"});
        continue;
      }
      group.ids.push_back({attribute.precision.name, static_cast<uint32_t>(a + 1)});
      if (weighted && a == weighted->weights) {
        group.ids.push_back({kJointsName, static_cast<uint32_t>(stream.base.attributes.size() + 1)});
        reports.push_back(
            {attribute.precision.name, 0, trial.errors.attributes[a].rms * weighted->reach, "units in the worst pose"});
        continue;
      }
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
  result.encode = ReportOf(trial, result, family);
  return result;
}

}  // namespace

StatusOr<FamilyStream> StreamFamily(const FamilyMeter& family, Effort effort, size_t most_bytes,
                                    const MorphChannels* morphs) {
  LACERTA_RETURN_IF_ERROR(family.status());
  if (family.leaves_out()) return Unsupported("has attributes that cannot be interpolated");
  std::optional<WeightedFamily> weighted;
  if (family.skin() != nullptr) {
    LACERTA_ASSIGN_OR_RETURN(weighted, ToWeightedFamily(family));
  }
  // The family's own surface has no joints' weights.
  LACERTA_ASSIGN_OR_RETURN(const AttributedMesh surface, PlainNames(weighted ? weighted->original : family.simplifiable()));
  LACERTA_ASSIGN_OR_RETURN(const SurfaceErrorMeter meter, weighted ? SurfaceErrorMeter::Create(surface, family.meter().texture_size())
                                                                   : StatusOr<SurfaceErrorMeter>(family.meter().WithNames(NamesOf(surface))));
  AttributedSearchOptions search;
  search.effort = effort;
  search.most_bytes = most_bytes;
  if (weighted) {
    search.meaning.joints = weighted->joints;
    search.meaning.factors = [&](const AttributedSemiRegularMesh& mesh, size_t attribute) {
      return FactorsInPoses(family, *weighted, mesh, attribute);
    };
  }
  search.meaning.correct = [&](const AttributedMesh& mesh, uint64_t num_samples, SurfaceErrors* errors) {
    if (weighted) LACERTA_RETURN_IF_ERROR(MeasureInPoses(family, *weighted, mesh, num_samples, errors));
    return morphs == nullptr ? Status() : morphs->Measure(mesh, num_samples, errors);
  };
  if (morphs != nullptr) {
    search.meaning.beside = [&](const AttributedBase& base) { return morphs->BytesOfPlainTargets(base); };
  }
  LACERTA_ASSIGN_OR_RETURN(
      const AttributedTrial trial,
      SmallestAttributedStream(surface, meter, weighted ? weighted->targets : family.targets(), search));
  return ToFamilyStream(trial, meter, family, weighted, morphs);
}

}  // namespace lacerta
