// Embedded coding of bit planes with zerotrees, the coefficient coder of [Khodakovsky, Schroeder, Sweldens 2000] and,
// over the details of normal meshes, of [Khodakovsky, Guskov 2002]: set partitioning in hierarchical trees [Said,
// Pearlman 1996], every decision through an adaptive arithmetic coder.
//
// A plane asks, from coarse nodes to fine ones: of a node that was zero so far, whether it is still; of a set of
// descendants that was all zero so far, whether it is still. Sets are D(n), all descendants of n, and, once D(n) has
// opened, L(n), those without its children; the sets D of the children exist only once L(n) has opened.
//
// Departs from the papers: nodes are visited level by level instead of by lists, with the same questions in each plane;
// signs are not modelled, and the models know the level.
#ifndef LACERTA_TESTS_BASELINES_ZEROTREE_H_
#define LACERTA_TESTS_BASELINES_ZEROTREE_H_

#include <cstdint>
#include <limits>
#include <vector>

#include "baselines/edge_trees.h"
#include "lacerta/mesh.h"

namespace lacerta::baselines {

// What a decoder knows of one set after any number of decisions: |coefficient| is in [|value|, |value| +
// 2^unknown_bits).
struct ZerotreePrefix {
  std::vector<int32_t> values;        // #nodes, with sign
  std::vector<uint8_t> unknown_bits;  // #nodes
};

// Codes sets that share their trees plane by plane, each set with trees and models of its own.
//   sets           magnitudes below 2^30
//   num_decisions  where the stream is cut; the stream of more decisions decodes to the same after as many
// The stream holds the number of planes of each set (a byte each), then the decisions of the range coder.
Bytes EncodeZerotrees(const EdgeTrees& trees, const std::vector<std::vector<int32_t>>& sets,
                      uint64_t num_decisions = std::numeric_limits<uint64_t>::max());

// The twin; the stream has to be one of EncodeZerotrees for the same trees.
std::vector<ZerotreePrefix> DecodeZerotrees(const EdgeTrees& trees, size_t num_sets, Span<const uint8_t> stream,
                                            uint64_t num_decisions = std::numeric_limits<uint64_t>::max());

}  // namespace lacerta::baselines

#endif  // LACERTA_TESTS_BASELINES_ZEROTREE_H_
