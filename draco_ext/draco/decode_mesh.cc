#include "draco/decode_mesh.h"

#include <string>
#include <utility>

#include "draco/base_mesh_codec.h"
#include "lacerta/decoder.h"

namespace lacerta {
namespace {

// Takes the levels of `refinement` into `result`, which holds the base. base_step: as in RefineBase.
Status Refine(Span<const uint8_t> refinement, const DecodeOptions& options, float base_step, DecodedMesh* result) {
  LACERTA_ASSIGN_OR_RETURN(const RefinementInfo info, ReadRefinementInfo(refinement));
  result->num_levels = info.num_levels;
  result->has_layers = info.has_layers;
  if (info.base_step != 0) base_step = info.base_step;
  if (base_step == 0) return InvalidData("neither the base mesh nor the refinement header tells the step of the base lattice");
  LACERTA_ASSIGN_OR_RETURN(const BaseMesh base, BaseMeshFromPositions(result->mesh, base_step));
  RefinementOptions refinement_options;
  refinement_options.max_level = options.max_level;
  refinement_options.limits = options.limits;
  LACERTA_ASSIGN_OR_RETURN(ProgressiveDecoder decoder, ProgressiveDecoder::Create(base, refinement_options));
  const Status refined = decoder.Append(refinement);
  result->level = decoder.level();
  result->state = decoder.state();
  const bool is_complete = decoder.is_complete();
  if (result->level > 0) {
    result->mesh.triangles = decoder.Triangles();
    result->mesh.positions = std::move(decoder).TakeMesh().positions;
  }
  LACERTA_RETURN_IF_ERROR(refined);
  if (is_complete) return {};
  if (result->level < info.num_levels) {
    return InvalidData("stream ends within level " + std::to_string(result->level + 1) + " of " +
                       std::to_string(info.num_levels));
  }
  return InvalidData("stream ends before the last quality layer");
}

}  // namespace

Status CheckDecodeOptions(const DecodeOptions& options) {
  if (options.max_level.has_value() && *options.max_level < 0) {
    return InvalidArgument("max_level is " + std::to_string(*options.max_level) + "; it must not be negative");
  }
  return {};
}

DecodedMesh RefineBase(TriangleMesh base, Span<const uint8_t> refinement, const DecodeOptions& options, float base_step) {
  DecodedMesh result;
  result.mesh = std::move(base);
  if (!refinement.empty()) result.refinement = Refine(refinement, options, base_step, &result);
  return result;
}

StatusOr<DecodedMesh> DecodeCustomFormParts(const StreamParts& parts, const DecodeOptions& options) {
  auto base = DecodeBaseOf(parts, options.limits);
  if (!base.ok()) return base.status().WithContext("base of the custom form");
  return RefineBase(std::move(base.value().mesh), parts.refinement, options, base.value().step);
}

StatusOr<DecodedMesh> DecodeMesh(Span<const uint8_t> stream, const DecodeOptions& options) {
  LACERTA_RETURN_IF_ERROR(CheckDecodeOptions(options));
  if (IsCustomForm(stream)) {
    LACERTA_ASSIGN_OR_RETURN(const StreamParts parts, SplitCustomForm(stream));
    return DecodeCustomFormParts(parts, options);
  }
  LACERTA_ASSIGN_OR_RETURN(DecodedBase base, DecodeBaseMesh(stream, options.limits));
  return RefineBase(std::move(base.mesh), stream.Subspan(base.bytes_used), options);
}

}  // namespace lacerta
