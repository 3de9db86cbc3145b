#include "stream_decoder.h"

#include <algorithm>
#include <string>
#include <utility>

#include "base_reader.h"
#include "decoder/level_limits.h"
#include "decoder/stream_reader.h"

namespace lacerta {
Status StreamDecoder::Append(Span<const uint8_t> bytes) {
  LACERTA_RETURN_IF_ERROR(failure_);
  if (finished_) return InvalidArgument("the stream was finished; later bytes are ignored");
  if (bytes.empty()) return Status();
  shown_.Forget();
  if (decoder_) return failure_ = decoder_->Append(bytes);
  pending_.insert(pending_.end(), bytes.begin(), bytes.end());
  return failure_ = Advance();
}

Status StreamDecoder::Finish() {
  LACERTA_RETURN_IF_ERROR(failure_);
  finished_ = true;
  if (decoder_ || needs_base_) return Status();
  next_attempt_ = 0;  // a last time
  failure_ = Advance();
  if (failure_.ok() && !has_base() && !decoder_ && !needs_base_) {
    failure_ = InvalidData("the stream ends within its base: " + std::to_string(pending_.size()) + " bytes are there");
  }
  return failure_;
}

Status StreamDecoder::CheckMaySetBase() const {
  LACERTA_RETURN_IF_ERROR(failure_);
  if (!has_base() && !decoder_ && (pending_.empty() || needs_base_)) return Status();
  return InvalidArgument("a base is set before the first byte, or when the decoder asks for one");
}

Status StreamDecoder::SetBase(TriangleMesh base) {
  LACERTA_RETURN_IF_ERROR(CheckMaySetBase());
  if (is_grouped()) return InvalidArgument("a stream with attributes has a base for each group");
  LACERTA_RETURN_IF_ERROR(CheckBaseFits(base.positions.size(), base.triangles.size(), options_.refinement.limits));
  base_ = std::move(base);
  return failure_ = std::exchange(needs_base_, false) ? Advance() : Status();
}

Status StreamDecoder::SetBaseGroup(size_t group, VertexSoup base) {
  LACERTA_RETURN_IF_ERROR(CheckMaySetBase());
  const size_t count = options_.groups.sizes.size();
  groups_.resize(count);
  is_group_set_.resize(count);
  if (group >= count || is_group_set_[group] != 0) return InvalidArgument("base " + std::to_string(group) + " is set already, or the stream has no such group");
  LACERTA_RETURN_IF_ERROR(AddGroup(base, options_.groups, options_.refinement.limits, &totals_));
  groups_[group] = std::move(base);
  is_group_set_[group] = 1;
  if (++num_groups_set_ < count) return Status();
  return failure_ = std::exchange(needs_base_, false) ? Advance() : Status();
}

Span<const uint8_t> StreamDecoder::base_section() const {
  if (!needs_base_) return {};
  if (is_grouped()) return pending().First(static_cast<size_t>(options_.base_size));
  const auto section = FindBaseSection(pending());
  if (!section.ok() || !section.value()) return {};
  const size_t begin = section.value()->begin;
  const size_t end = section.value()->size ? begin + *section.value()->size : options_.base_size != 0 ? options_.base_size : pending_.size();
  return pending().First(std::min(end, pending_.size())).Subspan(std::min(begin, pending_.size()));
}

Status StreamDecoder::Advance() {
  if (!has_base()) LACERTA_RETURN_IF_ERROR(is_grouped() ? TakeGroups() : TakeBase());
  if (has_base() && !base_passed_) LACERTA_RETURN_IF_ERROR(TakeHostBase());
  if (has_base() && base_passed_ && !decoder_ && !pending_.empty()) LACERTA_RETURN_IF_ERROR(TakeStep());
  return Status();
}

Status StreamDecoder::TakeBase() {
  LACERTA_ASSIGN_OR_RETURN(const std::optional<BaseSection> section, FindBaseSection(pending()));
  if (!section) return Status();
  if (section->form == BaseForm::kStock) return TakeStockBase(*section);
  if (pending_.size() - section->begin < *section->size) return Status();
  const Span<const uint8_t> bytes = pending().Subspan(section->begin).First(*section->size);
  LACERTA_ASSIGN_OR_RETURN(const CompactBase base, DecodeCompactBase(bytes, options_.refinement.limits));
  Drop(section->begin + *section->size);
  base_passed_ = true;
  base_ = base.ToMesh();
  has_offset_ = base.offset != Vec3f{};
  if (!has_offset_) LACERTA_RETURN_IF_ERROR(StartRefinement(base.mesh));
  return Status();
}

Status StreamDecoder::TakeStockBase(const BaseSection& section) {
  // Where its end is known, it is tried once: when it is there.
  const uint64_t end = section.size ? section.begin + *section.size : options_.base_size;
  const bool knows_end = end != 0;
  if (knows_end && pending_.size() < end && !finished_) return Status();
  if (!CanReadStockBase()) {
    needs_base_ = true;
    return Status();
  }
  if (pending_.size() < next_attempt_) return Status();
  const size_t available = knows_end ? static_cast<size_t>(std::min<uint64_t>(end, pending_.size())) : pending_.size();
  StatusOr<StockBase> base = ReadStockBase(pending().First(available).Subspan(section.begin), options_.refinement.limits);
  if (!base.ok()) {
    const bool may_end_early = base.status().code() == StatusCode::kInvalidData && !knows_end && !finished_;
    next_attempt_ = pending_.size() + pending_.size() / 4;
    return may_end_early ? Status() : base.status();
  }
  Drop(knows_end ? available : base.value().bytes_used);
  base_passed_ = true;
  base_ = std::move(base.value().mesh);
  return Status();
}

Status StreamDecoder::TakeGroups() {
  if (pending_.size() < options_.base_size) return Status();
  if (!CanReadStockBase()) {
    needs_base_ = true;
    return Status();
  }
  LACERTA_ASSIGN_OR_RETURN(groups_, ReadGroups(pending(), options_.groups, options_.refinement.limits, &totals_));
  num_groups_set_ = groups_.size();
  Drop(static_cast<size_t>(options_.base_size));
  base_passed_ = true;
  return Status();
}

// Passes over the base section that the host has decoded.
Status StreamDecoder::TakeHostBase() {
  const auto section = FindBaseSection(pending());
  const bool is_whole_stream = section.ok();
  uint64_t size = options_.base_size;
  if (is_whole_stream && size == 0) {
    if (!section.value()) return Status();
    if (section.value()->size) size = section.value()->begin + *section.value()->size;
    if (size == 0) {
      const std::optional<size_t> found = FindRefinement(pending(), *base_, &searched_);
      if (!found) return Status();
      size = *found;
    }
  }
  if (pending_.size() < size) return Status();
  Drop(static_cast<size_t>(size));
  base_passed_ = true;
  return Status();
}

Status StreamDecoder::TakeStep() {
  if (has_offset_) return InvalidData("a refinement follows a base that lies on no lattice");
  const uint64_t max_tag_bytes = base_ ? MaxTagBytes(base_->positions.size(), base_->triangles.size()) : MaxTagBytes(totals_.vertices, totals_.triangles);
  LACERTA_ASSIGN_OR_RETURN(const std::optional<ReadHeader> read, ReadRefinementHeader(pending(), max_tag_bytes));
  if (!read) return Status();
  if (is_grouped()) {
    LACERTA_ASSIGN_OR_RETURN(const AttributedBase base, BaseOfGroups(groups_, options_.groups, read->header));
    return StartRefinement(base);
  }
  if (read->header.base_step == 0) return InvalidData("neither the base mesh nor the refinement header tells the step of the base lattice");
  LACERTA_ASSIGN_OR_RETURN(const BaseMesh base, BaseMeshFromPositions(*base_, read->header.base_step));
  return StartRefinement(base);
}

template <typename Base>
Status StreamDecoder::StartRefinement(const Base& base) {
  LACERTA_ASSIGN_OR_RETURN(decoder_, ProgressiveDecoder::Create(base, options_.refinement));
  base_.reset();
  const Status status = decoder_->Append(pending());
  Drop(pending_.size());
  pending_.shrink_to_fit();
  return status;
}

void StreamDecoder::Drop(size_t size) {
  base_bytes_ += decoder_ ? 0 : size;
  pending_.erase(pending_.begin(), pending_.begin() + static_cast<ptrdiff_t>(size));
}

int StreamDecoder::level() const { return decoder_ ? decoder_->level() : has_base() ? 0 : -1; }

int StreamDecoder::num_levels() const {
  if (decoder_ && decoder_->num_levels() > 0) return decoder_->num_levels();
  return finished_ && level() == 0 ? 0 : -1;
}

bool StreamDecoder::is_complete() const {
  if (decoder_ && decoder_->is_complete()) return true;
  const bool only_base = options_.refinement.max_level == 0 || num_levels() == 0;
  return level() == 0 && failure_.ok() && only_base;
}

StatusOr<LevelView> StreamDecoder::ViewOf(int level, std::optional<size_t> group) {
  if (level < 0 || level > this->level()) {
    return InvalidArgument("level " + std::to_string(level) + " is not there; the finest complete one is " + std::to_string(this->level()));
  }
  if (group && *group >= num_groups()) {
    return InvalidArgument("group " + std::to_string(*group) + " is not there; the stream has " + std::to_string(num_groups()));
  }
  if (!is_grouped()) {
    if (decoder_) return shown_.Plain(*decoder_, level);
    return LevelView{base_->positions, base_->triangles};
  }
  const std::vector<VertexSoup>* groups = &groups_;
  if (level > 0) {
    LACERTA_ASSIGN_OR_RETURN(groups, shown_.Groups(*decoder_, level, num_groups()));
  }
  if (!group) joined_ = JoinedGroups(*groups);
  const VertexSoup& soup = group ? (*groups)[*group] : joined_;
  return LevelView{soup.positions, soup.triangles, &soup.attributes};
}

}  // namespace lacerta
