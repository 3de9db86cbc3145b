// The entropy decoder, made here once with optimization for speed; the linker takes this instance for all sources, most of which are built for size.
#include "common/coefficient_coding.h"
#include "decoder/range_decoder.h"

namespace lacerta {

template void CodeLevel<RangeDecoder, KeepCoefficients>(const Topology&, const LevelSteps&, CodingState*, QuantizedLevel*,
                                                        RangeDecoder*, const KeepCoefficients&);

}  // namespace lacerta
