#include "decoder/layer_decoder.h"

#include <algorithm>
#include <string>
#include <utility>

#include "decoder/level_limits.h"
#include "decoder/range_decoder.h"
#include "decoder/synthesis.h"

namespace lacerta {
namespace {

constexpr int kLevelsAhead = 2;

}  // namespace

LayerDecoder::LayerDecoder(std::vector<LevelSteps> steps, Topology base, size_t num_still, int last_level, const DecodeLimits& limits)
    : steps_(std::move(steps)), num_still_(num_still), last_level_(last_level), limits_(limits), stencils_(base) {
  topologies_.push_back(std::move(base));
  state_.levels.resize(steps_.size());
  for (size_t i = 0; i < steps_.size(); ++i) state_.levels[i].steps = steps_[i].Silent();
}

Status LayerDecoder::CheckOrder(const std::vector<LayerPayload>& segments) const {
  constexpr int kNotBegun = kMaxLayerShift + 1;
  std::vector<int> shifts;
  for (const LayeredLevel& level : state_.levels) shifts.push_back(level.has_begun ? level.shift : kNotBegun);
  for (const LayerPayload& s : segments) {
    const std::string where = "a segment of level " + std::to_string(s.segment.level);
    if (s.segment.level < 1 || static_cast<size_t>(s.segment.level) > steps_.size()) return InvalidData(where + ", which the stream does not have");
    const auto i = static_cast<size_t>(s.segment.level) - 1;
    if (steps_[i].is_silent() || !CanShift(steps_[i], s.segment.shift)) return InvalidData(where + " has no step");
    if (shifts[i] <= s.segment.shift) return InvalidData(where + " does not refine it");
    for (size_t below = 0; below < i; ++below) {
      if (!steps_[below].is_silent() && shifts[below] == kNotBegun) return InvalidData(where + " comes before a coarser one");
    }
    shifts[i] = s.segment.shift;
  }
  return Status();
}

Status LayerDecoder::Reach(int level) {
  while (static_cast<int>(topologies_.size()) < level) {
    const int next = static_cast<int>(topologies_.size());
    LACERTA_RETURN_IF_ERROR(CheckLevelFits(topologies_.back(), num_still_, next, limits_));
    topologies_.push_back(Refine(topologies_.back()));
  }
  return CheckLevelFits(topologies_[static_cast<size_t>(level) - 1], num_still_, level, limits_);
}

void LayerDecoder::Decode(const LayerPayload& segment) {
  const auto i = static_cast<size_t>(segment.segment.level) - 1;
  const Topology& coarse = topologies_[i];
  QuantizedLevel values = ZeroLevel(coarse.num_edges());
  RangeDecoder decoder(segment.payload);
  CodeLayerSegment(coarse, i > 0 ? &topologies_[i - 1] : nullptr, steps_[i], segment.segment, &state_, std::move(values), &decoder);
  lowest_changed_ = std::min(lowest_changed_, segment.segment.level);
}

Status LayerDecoder::Take(const std::vector<LayerPayload>& segments) {
  LACERTA_RETURN_IF_ERROR(CheckOrder(segments));
  for (const LayerPayload& s : segments) {
    if (s.segment.level <= last_level_) LACERTA_RETURN_IF_ERROR(Reach(s.segment.level));
  }
  for (const LayerPayload& s : segments) {
    if (s.segment.level <= last_level_) {
      Decode(s);
    } else {  // not wanted, but known to have come
      LayeredLevel& level = state_.levels[static_cast<size_t>(s.segment.level) - 1];
      level.has_begun = true;
      level.shift = s.segment.shift;
    }
  }
  return Status();
}

bool LayerDecoder::is_complete() const {
  for (size_t i = 0; i < static_cast<size_t>(last_level_); ++i) {
    if (!steps_[i].is_silent() && (!state_.levels[i].has_begun || state_.levels[i].shift > 0)) return false;
  }
  return true;
}

Status LayerDecoder::Show(SemiRegularMesh* mesh) {
  int finest = 0;
  for (int level = 1; level <= last_level_; ++level) finest = state_.levels[static_cast<size_t>(level) - 1].has_begun ? level : finest;
  int wanted = is_complete() ? last_level_ : std::min(last_level_, finest + kLevelsAhead);
  Status fits = Reach(std::max(1, finest));
  // Levels beyond those that have begun are a courtesy, within the limits.
  for (int level = finest + 1; level <= wanted && fits.ok(); ++level) {
    fits = Reach(level);
    if (!fits.ok()) wanted = level - 1;
  }
  const int first = std::min(lowest_changed_, shown_ + 1);
  std::vector<Vec3f> positions = mesh->positions;
  for (int level = first; level <= wanted; ++level) {
    const auto i = static_cast<size_t>(level) - 1;
    positions.resize(topologies_[i].num_vertices);
    const LayeredLevel& known = state_.levels[i];
    SynthesizeLevel(topologies_[i], stencils_, known.steps, known.values, &positions);
  }
  if (!AreFinite(positions)) return InvalidData("a segment makes positions that are not finite");
  mesh->positions = std::move(positions);
  mesh->num_levels = shown_ = std::max(shown_, wanted);
  lowest_changed_ = last_level_ + 1;
  return is_complete() && !fits.ok() ? fits : Status();
}

}  // namespace lacerta
