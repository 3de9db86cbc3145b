// Finding the base section at the front of a stream that may end anywhere (docs/format.md, "Base section"), without Draco.
#ifndef LACERTA_PLUGIN_C_BASE_SECTION_H_
#define LACERTA_PLUGIN_C_BASE_SECTION_H_

#include <cstddef>
#include <optional>

#include "lacerta/decoder.h"
#include "lacerta/mesh.h"
#include "lacerta/status.h"

namespace lacerta {

enum class BaseForm {
  kStock,    // a stock Draco stream, of unknown length unless it stands in the custom form
  kCompact,  // lacerta/decoder.h, DecodeCompactBase
};

struct BaseSection {
  BaseForm form = BaseForm::kStock;
  size_t begin = 0;            // of the base itself in the bytes
  std::optional<size_t> size;  // of the base itself; empty: only a Draco decoder can tell
};

// Nothing where `bytes` ends before it can be told. Fails with kInvalidData where this is no stream of ours or Draco's, and with
// kUnsupported on an unknown version or coding.
StatusOr<std::optional<BaseSection>> FindBaseSection(Span<const uint8_t> bytes);

// Where the refinement of `base` begins at or after `from` in a stream whose base section has an unknown length: the place of a header
// whose checksums, its own and the base's, fit. Nothing where there is none so far. Then *from is where to go on when more bytes are there.
std::optional<size_t> FindRefinement(Span<const uint8_t> stream, const TriangleMesh& base, size_t* from);

}  // namespace lacerta

#endif  // LACERTA_PLUGIN_C_BASE_SECTION_H_
