// Coding of the tags of a base mesh in the refinement header: one piece of code for encoder and decoder, so that they cannot
// drift apart. Coder as in common/coefficient_coding.h. Specified in docs/format.md, "Base tags".
#ifndef LACERTA_COMMON_BASE_TAGS_CODING_H_
#define LACERTA_COMMON_BASE_TAGS_CODING_H_

#include <algorithm>
#include <array>
#include <cstdint>
#include <utility>
#include <vector>

#include "common/base_tags.h"
#include "common/bit_model.h"
#include "common/subdivision.h"
#include "lacerta/mesh.h"
#include "lacerta/status.h"

namespace lacerta {

// Codes a bit that says whether `flags` has a one; if so code_flags() for the rest, and if not, `flags` becomes empty.
template <typename Coder, typename CodeFlags>
void CodePresence(size_t num_flags, std::vector<uint8_t>* flags, Coder* coder, const CodeFlags& code_flags) {
  const bool present = std::any_of(flags->begin(), flags->end(), [](uint8_t flag) { return flag != 0; });
  if (!coder->CodeEven(present)) return flags->clear();
  flags->resize(num_flags);
  code_flags();
}

// One flag per triangle; its context is the flag before.
template <typename Coder>
void CodeStill(size_t num_triangles, std::vector<uint8_t>* still, Coder* coder) {
  CodePresence(num_triangles, still, coder, [&] {
    std::array<BitModel, 2> models;
    bool last = false;
    for (uint8_t& flag : *still) flag = last = coder->Code(models[last], flag != 0);
  });
}

// One flag per edge that is no border; its context is the number of curve edges known so far at either end.
template <typename Coder>
void CodeCreases(const Topology& t, std::vector<uint8_t>* crease, Coder* coder) {
  CodePresence(t.num_edges(), crease, coder, [&] {
    std::vector<uint8_t> num_curves(t.num_vertices, 0);  // limited to 2
    const auto count = [&](uint32_t e) {
      for (const uint32_t v : t.edges[e]) num_curves[v] = static_cast<uint8_t>(std::min(num_curves[v] + 1, 2));
    };
    for (uint32_t e = 0; e < t.num_edges(); ++e) {
      if (t.is_border(e)) count(e);
    }
    std::array<BitModel, 6> models;
    for (uint32_t e = 0; e < t.num_edges(); ++e) {
      uint8_t& flag = (*crease)[e];
      if (t.is_border(e)) {
        flag = 0;
        continue;
      }
      const auto [fewer, more] = std::minmax(num_curves[t.edges[e][0]], num_curves[t.edges[e][1]]);
      flag = coder->Code(models[more * (more + 1) / 2 + fewer], flag != 0);
      if (flag != 0) count(e);
    }
  });
}

// One flag per vertex with two curve edges. curves: the topology with its creases, before it has corners.
template <typename Coder>
void CodeCorners(const Topology& curves, std::vector<uint8_t>* corner, Coder* coder) {
  CodePresence(curves.num_vertices, corner, coder, [&] {
    BitModel model;
    for (uint32_t v = 0; v < curves.num_vertices; ++v) {
      uint8_t& flag = (*corner)[v];
      flag = curves.role[v] == CurveRole::kCurve && coder->Code(model, flag != 0);
    }
  });
}

// Codes the tags of a base mesh. An encoding coder leaves them as they are but for flags where no flag can be, which are
// cleared; a decoding coder writes them, empty on entry. Returns the topology of the base with its tags, or fails as
// BuildTopology does and with kInvalidData where every triangle stands still.
template <typename Coder>
StatusOr<Topology> CodeBaseTags(Span<const std::array<int32_t, 3>> lattice, const std::vector<Triangle>& triangles,
                                BaseTags* tags, Coder* coder) {
  const auto num_vertices = static_cast<uint32_t>(lattice.size());
  CodeStill(triangles.size(), &tags->still, coder);
  BaseTags known;
  known.still = tags->still;
  LACERTA_ASSIGN_OR_RETURN(Topology t, BuildTopology(num_vertices, triangles, known));
  if (t.triangles.empty()) return InvalidData("every triangle of the base stands still: there is nothing to refine");
  CodeCreases(t, &tags->crease, coder);
  known.crease = tags->crease;
  LACERTA_RETURN_IF_ERROR(SetTags(known, &t));
  CodeCorners(t, &tags->corner, coder);
  const bool joins = coder->CodeEven(JoinsAnything(tags->joined));
  tags->joined = joins ? FirstAtSamePoint(lattice) : std::vector<uint32_t>();
  *tags = NormalizedTags(std::move(*tags));
  LACERTA_RETURN_IF_ERROR(SetTags(*tags, &t));
  return t;
}

}  // namespace lacerta

#endif  // LACERTA_COMMON_BASE_TAGS_CODING_H_
