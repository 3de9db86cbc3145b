#include "baselines/coders.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "baselines/edge_trees.h"
#include "baselines/zerotree.h"
#include "encoder/paper_mode.h"
#include "encoder/quantizer.h"
#include "encoder/stream_writer.h"

namespace lacerta::baselines {
namespace {

constexpr size_t kThresholdBytes = 2;  // the form in which steps travel in the product's streams
constexpr float kLargestMagnitude = 1 << 29;

float ScaleOf(int component, double tangential_scale) {
  return component < 2 ? static_cast<float>(tangential_scale) : 1.0f;
}

}  // namespace

StatusOr<CodedMesh> CodeWithModel(const CodedBase& base, const Transform& transform, const Decomposition& mesh,
                                  double lambda) {
  const std::vector<Topology>& topologies = transform.topologies();
  SemiRegularMesh coefficients = {
      base.mesh.triangles, static_cast<uint32_t>(mesh.base.size()), static_cast<int>(topologies.size()), mesh.base, {}};
  coefficients.positions.resize(topologies.back().num_vertices + topologies.back().num_edges());
  LACERTA_ASSIGN_OR_RETURN(const CodedSurface coded,
                           CodeByModel(coefficients, mesh.levels, transform.energies(), lambda));
  LACERTA_ASSIGN_OR_RETURN(const Bytes base_bytes, RecodeBaseMesh(base, coded.base));
  LACERTA_ASSIGN_OR_RETURN(const RefinementBytes refinement,
                           WriteRefinement(coded.base, topologies, coded.steps, coded.levels));

  Decomposition decoded = {coded.base.ToMesh().positions, mesh.levels};
  for (size_t i = 0; i < coded.levels.size(); ++i) {
    const LevelSteps& steps = coded.steps[i];
    const QuantizedLevel& level = coded.levels[i];
    for (size_t e = 0; e < level.normal.size(); ++e) {
      decoded.levels[i].detail[e] = {
          Dequantize(level.tangential[2 * e], steps.tangential_step, steps.tangential_bias),
          Dequantize(level.tangential[2 * e + 1], steps.tangential_step, steps.tangential_bias),
          Dequantize(level.normal[e], steps.normal_step, steps.normal_bias)};
    }
  }
  CodedMesh result;
  result.bytes = base_bytes.size() + refinement.bytes.size();
  LACERTA_ASSIGN_OR_RETURN(result.positions, transform.Synthesize(decoded));
  return result;
}

StatusOr<CodedMesh> CodeWithZerotrees(const CodedBase& base, const Transform& transform, const Decomposition& mesh,
                                      const ZerotreeOptions& options) {
  const EdgeTrees trees = BuildEdgeTrees(transform.topologies());
  const float threshold = RoundStep(static_cast<float>(options.threshold));
  if (!(threshold > 0) || !(options.tangential_scale > 0))
    return InvalidArgument("thresholds and scales have to be positive");
  std::vector<float> steps;  // by level
  for (const double energy : transform.energies()) steps.push_back(threshold / static_cast<float>(std::sqrt(energy)));

  std::vector<std::vector<int32_t>> sets(3);
  for (size_t level = 0; level < mesh.levels.size(); ++level) {
    for (const Vec3f& detail : mesh.levels[level].detail) {
      for (int c = 0; c < 3; ++c) {
        const float planes = detail[c] * ScaleOf(c, options.tangential_scale) / steps[level + 1];
        sets[c].push_back(static_cast<int32_t>(std::clamp(planes, -kLargestMagnitude, kLargestMagnitude)));
      }
    }
  }
  const Bytes stream = EncodeZerotrees(trees, sets);
  const BaseMesh lattice = RoundToLattice({mesh.base, base.mesh.triangles}, steps[0]);
  LACERTA_ASSIGN_OR_RETURN(const Bytes base_bytes, RecodeBaseMesh(base, lattice));

  const std::vector<ZerotreePrefix> known = DecodeZerotrees(trees, sets.size(), stream);
  Decomposition decoded = {lattice.ToMesh().positions, mesh.levels};
  uint32_t node = 0;
  for (size_t level = 0; level < decoded.levels.size(); ++level) {
    for (Vec3f& detail : decoded.levels[level].detail) {
      for (int c = 0; c < 3; ++c) {
        const auto value = static_cast<float>(known[c].values[node]);
        const float middle =
            value == 0 ? 0.0f : std::copysign(0.5f * std::ldexp(1.0f, known[c].unknown_bits[node]), value);
        detail[c] = (value + middle) * steps[level + 1] / ScaleOf(c, options.tangential_scale);
      }
      ++node;
    }
  }
  CodedMesh result;
  result.bytes = base_bytes.size() + kThresholdBytes + stream.size();
  LACERTA_ASSIGN_OR_RETURN(result.positions, transform.Synthesize(decoded));
  return result;
}

}  // namespace lacerta::baselines
