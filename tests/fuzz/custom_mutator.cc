// Gives a fuzz target the structure-aware mutator. In builds with libFuzzer only.
#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "fuzz/structure_mutator.h"

extern "C" size_t LLVMFuzzerMutate(uint8_t* data, size_t size, size_t max_size);

extern "C" size_t LLVMFuzzerCustomMutator(uint8_t* data, size_t size, size_t max_size, unsigned seed) {
  const lacerta::Bytes changed = lacerta::fuzz::MutateStructure({data, size}, max_size, seed, LLVMFuzzerMutate);
  std::copy(changed.begin(), changed.end(), data);
  return changed.size();
}
