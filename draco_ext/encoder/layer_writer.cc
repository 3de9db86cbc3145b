#include "encoder/layer_writer.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <utility>

#include "common/layer_coding.h"
#include "encoder/byte_writer.h"
#include "encoder/range_encoder.h"

namespace lacerta {
namespace {

// The surface with all coefficients zero.
CodedSurface WithoutDetails(CodedSurface surface) {
  for (LevelSteps& steps : surface.steps) steps = steps.Silent();
  for (QuantizedLevel& level : surface.levels) {
    std::fill(level.normal.begin(), level.normal.end(), 0);
    std::fill(level.tangential.begin(), level.tangential.end(), 0);
  }
  return surface;
}

// About the bits of a segment that turns `before`, on steps 2^drop times larger, into `after`.
double BitsOfChange(const QuantizedLevel& before, const QuantizedLevel& after, int drop) {
  double bits = 8 * 5;  // of a segment without payload
  const auto add = [&](const std::vector<int32_t>& from, const std::vector<int32_t>& to) {
    for (size_t i = 0; i < to.size(); ++i) {
      const int32_t residual = to[i] - from[i] * (1 << drop);
      bits += residual != 0 ? 3.0 + 2.0 * std::log2(static_cast<double>(Magnitude(residual))) : from[i] != 0 ? 0.8 : 0.2;
    }
  };
  add(before.normal, after.normal);
  add(before.tangential, after.tangential);
  return bits;
}

Status CheckSegments(Span<const Topology> topologies, const std::vector<LevelSteps>& steps, const std::vector<QuantizedLevel>& levels,
                     const std::vector<LayerValues>& segments) {
  constexpr int kNotBegun = kMaxLayerShift + 1;
  std::vector<int> shifts(levels.size(), kNotBegun);
  for (const LayerValues& s : segments) {
    const std::string where = "segment of level " + std::to_string(s.segment.level);
    if (s.segment.level < 1 || static_cast<size_t>(s.segment.level) > levels.size()) return InvalidArgument(where + ": no such level");
    const auto i = static_cast<size_t>(s.segment.level) - 1;
    if (steps[i].is_silent() || s.segment.shift < 0 || s.segment.shift >= shifts[i] || !CanShift(steps[i], s.segment.shift))
      return InvalidArgument(where + ": the shift does not follow upon the one before, or the level has no step");
    for (size_t below = 0; below < i; ++below) {
      if (shifts[below] == kNotBegun && !steps[below].is_silent()) return InvalidArgument(where + " before a coarser one");
    }
    LACERTA_RETURN_IF_ERROR(CheckCoefficients(s.segment.level, topologies[i], steps[i], s.values));
    if (s.segment.shift == 0 && (s.values.normal != levels[i].normal || s.values.tangential != levels[i].tangential))
      return InvalidArgument(where + " does not end with its coefficients");
    shifts[i] = s.segment.shift;
  }
  for (size_t i = 0; i < levels.size(); ++i) {
    if (!steps[i].is_silent() && shifts[i] != 0) return InvalidArgument("level " + std::to_string(i + 1) + " is not brought to its steps");
  }
  if (!segments.empty() && segments.back().segment.waits) return InvalidArgument("the last segment waits for another");
  return Status();
}

}  // namespace

std::vector<LayerValues> OrderSegments(const SurfaceTarget& target, const std::vector<QualityLayer>& layers) {
  const std::vector<LevelSteps>& steps = layers.back().surface.steps;
  constexpr int kNotBegun = kMaxLayerShift + 1;
  std::vector<int> shifts(steps.size(), kNotBegun);
  std::vector<LayerValues> result;
  CodedSurface shown = WithoutDetails(layers.back().surface);
  double present = SurfaceDistortion(target, Synthesize(target, shown)), least = std::numeric_limits<double>::infinity();
  const auto take = [&](const QualityLayer& layer, size_t i, CodedSurface* surface) {
    surface->steps[i] = ShiftedSteps(steps[i], *layer.shifts[i]);
    surface->levels[i] = layer.surface.levels[i];
  };
  for (const QualityLayer& layer : layers) {
    std::vector<size_t> missing;
    for (size_t i = 0; i < steps.size(); ++i) {
      if (layer.shifts[i] && shifts[i] != *layer.shifts[i]) missing.push_back(i);
    }
    while (!missing.empty()) {
      size_t best = 0;
      double best_gain = -std::numeric_limits<double>::infinity(), distortion = present;
      for (size_t k = 0; k < missing.size(); ++k) {
        const size_t i = missing[k];
        CodedSurface tried = shown;
        take(layer, i, &tried);
        const double tried_distortion = SurfaceDistortion(target, Synthesize(target, tried));
        const double gain = (present - tried_distortion) / BitsOfChange(shown.levels[i], layer.surface.levels[i], shifts[i] - *layer.shifts[i]);
        if (gain > best_gain) {
          best = k;
          best_gain = gain;
          distortion = tried_distortion;
        }
        if (shifts[i] == kNotBegun) break;  // finer ones come after it
      }
      const size_t i = missing[best];
      missing.erase(missing.begin() + static_cast<std::ptrdiff_t>(best));
      shifts[i] = *layer.shifts[i];
      take(layer, i, &shown);
      present = distortion;
      constexpr double kGain = 0.98;  // less is within the noise of what planes tell
      const bool waits = !(present < kGain * least);
      if (!waits) least = present;
      result.push_back({{static_cast<int>(i) + 1, shifts[i], waits}, layer.surface.levels[i]});
    }
  }
  if (!result.empty()) result.back().segment.waits = false;
  return result;
}

StatusOr<RefinementBytes> WriteLayers(const BaseMesh& base, Span<const Topology> topologies, const std::vector<LevelSteps>& steps,
                                      const std::vector<QuantizedLevel>& levels, const std::vector<LayerValues>& segments,
                                      const BaseTags& tags, BaseStepField base_step) {
  RefinementBytes result;
  LACERTA_ASSIGN_OR_RETURN(result.bytes, WriteLayeredHeader(base, topologies, steps, levels, tags, base_step));
  LACERTA_RETURN_IF_ERROR(CheckSegments(topologies, steps, levels, segments));
  LayerState state;
  state.levels.resize(steps.size());
  size_t part_begin = 0;
  for (const LayerValues& s : segments) {
    const auto i = static_cast<size_t>(s.segment.level) - 1;
    RangeEncoder encoder;
    CodeLayerSegment(topologies[i], i > 0 ? &topologies[i - 1] : nullptr, steps[i], s.segment, &state, s.values, &encoder);
    const Bytes payload = encoder.Finish();
    const uint8_t what = LayerSegmentByte(s.segment);
    result.bytes.push_back(what);
    PutVarint(payload.size(), &result.bytes);
    PutWord16(SegmentChecksum(what, payload), &result.bytes);
    result.bytes.insert(result.bytes.end(), payload.begin(), payload.end());
    if (s.segment.waits) continue;
    result.part_sizes.push_back(result.bytes.size() - part_begin);
    part_begin = result.bytes.size();
  }
  return result;
}

}  // namespace lacerta
