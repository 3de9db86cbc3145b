// Bytes that operator new has handed out, counted in programs that link heap_meter.cc.
#ifndef LACERTA_TESTS_BENCH_HEAP_METER_H_
#define LACERTA_TESTS_BENCH_HEAP_METER_H_

#include <cstddef>

namespace lacerta {

size_t HeapInUse();
// The most that was in use at a time since the last ResetHeapPeak.
size_t HeapPeak();
void ResetHeapPeak();
// Has blocks of 4 kB and more refused, with bad_alloc, that would take what is in use beyond so many bytes; 0: none.
void SetHeapLimit(size_t bytes);

}  // namespace lacerta

#endif  // LACERTA_TESTS_BENCH_HEAP_METER_H_
