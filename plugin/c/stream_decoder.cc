#include "stream_decoder.h"

#include <algorithm>
#include <string>
#include <utility>

#include "base_reader.h"
#include "decoder/stream_reader.h"

namespace lacerta {
namespace {

Status CheckBase(const TriangleMesh& base, const DecodeLimits& limits) {
  if (base.positions.size() > limits.max_vertices || base.triangles.size() > limits.max_triangles) {
    return LimitExceeded("the base mesh (" + std::to_string(base.positions.size()) + " vertices, " +
                         std::to_string(base.triangles.size()) + " triangles) is over the decode limits");
  }
  return Status();
}

}  // namespace

Status StreamDecoder::Append(Span<const uint8_t> bytes) {
  LACERTA_RETURN_IF_ERROR(failure_);
  if (finished_) return InvalidArgument("the stream was finished; later bytes are ignored");
  if (bytes.empty()) return Status();
  shown_.reset();
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
  if (failure_.ok() && !base_ && !decoder_ && !needs_base_) {
    failure_ = InvalidData("the stream ends within its base: " + std::to_string(pending_.size()) + " bytes are there");
  }
  return failure_;
}

Status StreamDecoder::SetBase(TriangleMesh base) {
  LACERTA_RETURN_IF_ERROR(failure_);
  if (base_ || decoder_ || (!pending_.empty() && !needs_base_)) {
    return InvalidArgument("a base is set before the first byte, or when the decoder asks for one");
  }
  LACERTA_RETURN_IF_ERROR(CheckBase(base, options_.refinement.limits));
  shown_.reset();
  base_ = std::move(base);
  const bool asked_for = std::exchange(needs_base_, false);
  base_passed_ = false;
  return failure_ = asked_for ? Advance() : Status();
}

Span<const uint8_t> StreamDecoder::base_section() const {
  if (!needs_base_) return {};
  const auto section = FindBaseSection(pending());
  if (!section.ok() || !section.value()) return {};
  const size_t begin = section.value()->begin;
  const size_t end = section.value()->size ? begin + *section.value()->size : options_.base_size != 0 ? options_.base_size : pending_.size();
  return pending().First(std::min(end, pending_.size())).Subspan(std::min(begin, pending_.size()));
}

Status StreamDecoder::Advance() {
  if (!base_) LACERTA_RETURN_IF_ERROR(TakeBase());
  if (base_ && !base_passed_) LACERTA_RETURN_IF_ERROR(TakeHostBase());
  if (base_ && base_passed_ && !decoder_ && !pending_.empty()) LACERTA_RETURN_IF_ERROR(TakeStep());
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
  LACERTA_ASSIGN_OR_RETURN(const std::optional<ReadHeader> read,
                           ReadRefinementHeader(pending(), MaxTagBytes(base_->positions.size(), base_->triangles.size())));
  if (!read) return Status();
  if (read->header.base_step == 0) return InvalidData("neither the base mesh nor the refinement header tells the step of the base lattice");
  LACERTA_ASSIGN_OR_RETURN(const BaseMesh base, BaseMeshFromPositions(*base_, read->header.base_step));
  return StartRefinement(base);
}

Status StreamDecoder::StartRefinement(const BaseMesh& base) {
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

int StreamDecoder::level() const { return decoder_ ? decoder_->level() : base_ ? 0 : -1; }

int StreamDecoder::num_levels() const {
  if (decoder_ && decoder_->num_levels() > 0) return decoder_->num_levels();
  return finished_ && level() == 0 ? 0 : -1;
}

bool StreamDecoder::is_complete() const {
  if (decoder_ && decoder_->is_complete()) return true;
  const bool only_base = options_.refinement.max_level == 0 || num_levels() == 0;
  return level() == 0 && failure_.ok() && only_base;
}

StatusOr<LevelView> StreamDecoder::ViewOf(int level) {
  if (level < 0 || level > this->level()) {
    return InvalidArgument("level " + std::to_string(level) + " is not there; the finest complete one is " + std::to_string(this->level()));
  }
  if (!decoder_) return LevelView{base_->positions, base_->triangles};
  const bool is_finest = level == decoder_->level();
  if (!shown_ || shown_level_ != level) {
    if (is_finest) {
      shown_ = TriangleMesh{{}, decoder_->Triangles()};
    } else {
      LACERTA_ASSIGN_OR_RETURN(shown_, MeshAtLevel(decoder_->mesh(), level));
    }
    shown_level_ = level;
  }
  return LevelView{is_finest ? decoder_->mesh().positions : shown_->positions, shown_->triangles};
}

}  // namespace lacerta
