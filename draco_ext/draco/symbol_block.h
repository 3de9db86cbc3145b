// Blocks of symbols and of bits in stock Draco streams, written in fewer bytes than Draco's own encoder takes for them.
#ifndef LACERTA_DRACO_SYMBOL_BLOCK_H_
#define LACERTA_DRACO_SYMBOL_BLOCK_H_

#include <cstdint>

#include "lacerta/mesh.h"

namespace lacerta {

// What draco::DecodeSymbols reads `symbols` from, with Draco's two schemes and its rANS coder [Duda 2013]. Against draco::EncodeSymbols
//   the scheme is the one that takes fewer bytes, not the one that an estimate says does;
//   probabilities are chosen with what the table takes for them: below 64 a byte, else two, from 2^14 on three;
//   the coder begins near 0 rather than at the state from which on its decoder reads bytes, for which decoders look no more once there are none;
//   lengths of values that hardly occur are those of longer ones.
//   symbols     < 2^31, as draco::EncodeSymbols requires
//   components  of a value: the tagged scheme has one length for all; divides the number of symbols, which is not 0
Bytes EncodeSymbolBlock(Span<const uint32_t> symbols, uint32_t components);

// Bits (0 or 1) of a symbol, the number of which Draco takes for its length: 1 .. 32, of 0 too.
uint32_t SymbolLength(uint32_t symbol);

// What draco::RAnsBitDecoder reads `bits` (0 or 1 each) from. As above it begins near 0. bits: not empty.
Bytes EncodeBitBlock(Span<const uint8_t> bits);

}  // namespace lacerta

#endif  // LACERTA_DRACO_SYMBOL_BLOCK_H_
