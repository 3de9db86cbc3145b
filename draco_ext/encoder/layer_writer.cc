#include "encoder/layer_writer.h"

#include <limits>
#include <utility>

#include "common/layer_coding.h"
#include "encoder/byte_writer.h"
#include "encoder/range_encoder.h"

namespace lacerta {
namespace {

struct Written {
  LayerSegment segment;
  Bytes payload;
};

// All segments in order; those wait that would make the mesh no better.
std::vector<Written> CodeSegments(const SurfaceTarget& target, const std::vector<QualityLayer>& layers) {
  const std::vector<LevelSteps>& steps = layers.back().surface.steps;
  std::vector<Written> result;
  LayerState state;
  state.levels.resize(steps.size());
  CodedSurface shown = layers.back().surface;
  for (size_t i = 0; i < steps.size(); ++i) {
    shown.steps[i] = LevelSteps();
    shown.levels[i].normal.assign(shown.levels[i].normal.size(), 0);
    shown.levels[i].tangential.assign(shown.levels[i].tangential.size(), 0);
  }
  double least = std::numeric_limits<double>::infinity();
  for (const QualityLayer& layer : layers) {
    for (size_t i = 0; i < steps.size(); ++i) {
      const LayeredLevel& known = state.levels[i];
      if (!layer.shifts[i] || (known.has_begun && known.shift == *layer.shifts[i])) continue;
      LayerSegment segment{static_cast<int>(i) + 1, *layer.shifts[i], false};
      RangeEncoder encoder;
      CodeLayerSegment(target.topologies[i], i > 0 ? &target.topologies[i - 1] : nullptr, steps[i], segment, &state, layer.surface.levels[i],
                       &encoder);
      shown.steps[i] = known.steps;
      shown.levels[i] = known.values;
      constexpr double kGain = 0.98;  // less is within the noise of what planes tell
      const double distortion = SurfaceDistortion(target, Synthesize(target, shown));
      segment.waits = !(distortion < kGain * least);
      if (!segment.waits) least = distortion;
      result.push_back({segment, encoder.Finish()});
    }
  }
  if (!result.empty()) result.back().segment.waits = false;
  return result;
}

}  // namespace

StatusOr<RefinementBytes> WriteLayers(const SurfaceTarget& target, const std::vector<QualityLayer>& layers, const BaseTags& tags,
                                      BaseStepField base_step) {
  const CodedSurface& last = layers.back().surface;
  const Span<const Topology> topologies(target.topologies.data(), last.levels.size());
  RefinementBytes result;
  LACERTA_ASSIGN_OR_RETURN(result.bytes, WriteLayeredHeader(last.base, topologies, last.steps, last.levels, tags, base_step));
  size_t part_begin = 0;
  for (const Written& written : CodeSegments(target, layers)) {
    const uint8_t what = LayerSegmentByte(written.segment);
    result.bytes.push_back(what);
    PutVarint(written.payload.size(), &result.bytes);
    PutWord16(SegmentChecksum(what, written.payload), &result.bytes);
    result.bytes.insert(result.bytes.end(), written.payload.begin(), written.payload.end());
    if (written.segment.waits) continue;
    result.part_sizes.push_back(result.bytes.size() - part_begin);
    part_begin = result.bytes.size();
  }
  return result;
}

}  // namespace lacerta
