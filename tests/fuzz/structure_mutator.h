// Structure-aware mutation of what the fuzz targets read: one part of a stream or of an asset is changed, and the lengths and checksums around
// it, which stop most changes of bytes at the door, are made right again.
#ifndef LACERTA_TESTS_FUZZ_STRUCTURE_MUTATOR_H_
#define LACERTA_TESTS_FUZZ_STRUCTURE_MUTATOR_H_

#include <cstddef>
#include <cstdint>
#include <functional>

#include "lacerta/mesh.h"

namespace lacerta::fuzz {

// Changes `size` bytes at `data`, where there is room for `max_size` > 0, without a thought, and returns their new number: libFuzzer's own mutator.
using MutateBytes = std::function<size_t(uint8_t* data, size_t size, size_t max_size)>;

// `input`, of at most max_size bytes, changed in one of these, which `seed` chooses:
// - the whole of it, by `mutate` alone: one time in two, and where no structure is found
// - of a stream: base, header, or a segment, by `mutate`; segments left out, repeated or swapped
// - of a GLB: its JSON, by `mutate` or one number of it; its data, or a stream in it, which keeps its place
Bytes MutateStructure(Span<const uint8_t> input, size_t max_size, uint32_t seed, const MutateBytes& mutate);

}  // namespace lacerta::fuzz

#endif  // LACERTA_TESTS_FUZZ_STRUCTURE_MUTATOR_H_
