// A whole stream, base section and refinement, as its bytes arrive: what the C functions wrap.
#ifndef LACERTA_PLUGIN_C_STREAM_DECODER_H_
#define LACERTA_PLUGIN_C_STREAM_DECODER_H_

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "base_section.h"
#include "caller_allocator.h"
#include "group_base.h"
#include "lacerta/decoder.h"
#include "lacerta/mesh.h"
#include "lacerta/status.h"
#include "shown_level.h"

namespace lacerta {

class StreamDecoder {
 public:
  struct Options {
    RefinementOptions refinement;
    uint64_t base_size = 0;  // of the base section; 0: not known
    GroupOptions groups;     // their sizes add up to base_size
  };
  StreamDecoder(const Options& options, const CallerAllocator<uint8_t>& allocator) : options_(options), pending_(allocator) {}

  // Twins of lacerta_decoder_append, _finish, _set_base and _set_base_group. needs_base() says whether only SetBase leads on.
  Status Append(Span<const uint8_t> bytes);
  Status Finish();
  Status SetBase(TriangleMesh base);
  Status SetBaseGroup(size_t group, VertexSoup base);
  bool needs_base() const { return needs_base_; }
  // The base section as far as it is there; none once it was used.
  Span<const uint8_t> base_section() const;

  int level() const;       // -1: no base yet
  int num_levels() const;  // -1: not known yet
  int state() const { return decoder_ ? decoder_->state() : 0; }
  bool has_layers() const { return decoder_ && decoder_->has_layers(); }
  bool is_complete() const;
  uint64_t bytes_used() const { return base_bytes_ + (decoder_ ? decoder_->bytes_used() : 0); }

  size_t num_groups() const { return is_grouped() ? options_.groups.sizes.size() : level() < 0 ? 0 : 1; }
  const std::vector<std::string>& attribute_names() const { return options_.groups.names; }
  // Floats per vertex; 0 where no group has it, or no base is there.
  uint32_t components_of(size_t attribute) const { return attribute < totals_.components.size() ? totals_.components[attribute] : 0; }

  // Of `level`, 0..level(); valid until bytes arrive or another level is asked for. group: empty: all as one.
  StatusOr<LevelView> ViewOf(int level, std::optional<size_t> group);

 private:
  bool is_grouped() const { return !options_.groups.sizes.empty(); }
  bool has_base() const { return base_ || (is_grouped() && num_groups_set_ == options_.groups.sizes.size()); }
  Status CheckMaySetBase() const;
  Status Advance();
  Status TakeBase();
  Status TakeStockBase(const BaseSection& section);
  Status TakeGroups();
  Status TakeHostBase();
  Status TakeStep();
  template <typename Base>  // BaseMesh or AttributedBase
  Status StartRefinement(const Base& base);
  void Drop(size_t size);  // from the front of what is pending
  Span<const uint8_t> pending() const { return {pending_.data(), pending_.size()}; }

  Options options_;
  std::vector<uint8_t, CallerAllocator<uint8_t>> pending_;  // not yet used; empty once decoder_ is there
  Status failure_;
  bool needs_base_ = false, finished_ = false;
  size_t next_attempt_ = 0;   // pending bytes with which a Draco base of unknown length is tried again
  size_t searched_ = 0;       // pending bytes without a refinement header that fits the host's base
  bool base_passed_ = false;  // the pending bytes are refinement
  std::optional<TriangleMesh> base_;  // until decoder_ is there
  std::vector<VertexSoup> groups_;    // in its place where the stream has attributes: stays as level 0
  GroupTotals totals_;                // of them
  std::vector<uint8_t> is_group_set_;
  size_t num_groups_set_ = 0;
  bool has_offset_ = false;           // the base is no lattice's: nothing refines it
  uint64_t base_bytes_ = 0;
  std::optional<ProgressiveDecoder> decoder_;

  ShownLevel shown_;
  VertexSoup joined_;  // of the last view of all groups as one
};

}  // namespace lacerta

#endif  // LACERTA_PLUGIN_C_STREAM_DECODER_H_
