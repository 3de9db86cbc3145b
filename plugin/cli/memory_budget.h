// Holds the command to the memory that is free: what wants more gets an error, before the machine swaps or ends it.
#ifndef LACERTA_CLI_MEMORY_BUDGET_H_
#define LACERTA_CLI_MEMORY_BUDGET_H_

#include <cstdint>
#include <optional>

namespace lacerta::cli {

// Bytes that the system can give without swapping, within the limit of the control group; none where it does not tell.
std::optional<uint64_t> FreeMemory();

// From now on allocations of this process beyond so many bytes more than it has fail with std::bad_alloc. Without effect where the system has no such limit.
void HoldToMemory(uint64_t bytes);

}  // namespace lacerta::cli

#endif  // LACERTA_CLI_MEMORY_BUDGET_H_
