#include "draco/symbol_block.h"

#include <draco/compression/bit_coders/rans_bit_decoder.h>
#include <draco/compression/bit_coders/rans_bit_encoder.h>
#include <draco/compression/entropy/symbol_decoding.h>
#include <draco/compression/entropy/symbol_encoding.h>
#include <draco/core/decoder_buffer.h>
#include <draco/core/encoder_buffer.h>
#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <random>
#include <utility>
#include <vector>

namespace lacerta {
namespace {

constexpr uint16_t kVersion = 0x0202;

// A byte follows each block, so that reading too far shows.
draco::DecoderBuffer Reader(const Bytes& bytes) {
  draco::DecoderBuffer reader;
  reader.Init(reinterpret_cast<const char*>(bytes.data()), bytes.size(), kVersion);
  return reader;
}

// The size of the block.
size_t ExpectRoundTrip(const std::vector<uint32_t>& symbols, uint32_t components) {
  Bytes bytes = EncodeSymbolBlock(symbols, components);
  bytes.push_back(0);
  draco::DecoderBuffer reader = Reader(bytes);
  std::vector<uint32_t> decoded(symbols.size());
  EXPECT_TRUE(draco::DecodeSymbols(static_cast<uint32_t>(symbols.size()), static_cast<int>(components), &reader, decoded.data()));
  EXPECT_EQ(decoded, symbols);
  EXPECT_EQ(reader.remaining_size(), 1);
  return bytes.size() - 1;
}

size_t SizeByDraco(const std::vector<uint32_t>& symbols, uint32_t components) {
  draco::EncoderBuffer buffer;
  EXPECT_TRUE(draco::EncodeSymbols(symbols.data(), static_cast<int>(symbols.size()), static_cast<int>(components), nullptr, &buffer));
  return buffer.size();
}

// Residuals, nearly exponential, of values of `components` numbers.
std::vector<uint32_t> Residuals(size_t num_values, uint32_t components, double mean, uint32_t seed) {
  std::mt19937 random(seed);
  std::exponential_distribution<double> size(1 / mean);
  std::vector<uint32_t> symbols(num_values * components);
  for (uint32_t& s : symbols) s = static_cast<uint32_t>(size(random));
  return symbols;
}

TEST(EncodeSymbolBlock, DracoReadsWhatWasWritten) {
  std::mt19937 random(3);
  for (int run = 0; run < 3000 && !::testing::Test::HasFailure(); ++run) {
    SCOPED_TRACE(run);
    const auto components = static_cast<uint32_t>(1 + random() % 4);
    std::vector<uint32_t> symbols(components * (1 + random() % (run % 7 == 0 ? 2000 : 50)));
    const auto shift = 1 + random() % 31;
    for (uint32_t& s : symbols) {
      s = static_cast<uint32_t>(random() >> shift);
      if (random() % 3 != 0) s >>= random() % 12;
      if (run % 5 == 0) s %= 2;
    }
    ExpectRoundTrip(symbols, components);
  }
}

TEST(EncodeSymbolBlock, TakesFewerBytesThanDraco) {
  double ours = 0, dracos = 0;
  for (const size_t num_values : {20, 100, 500, 3000}) {
    for (const double mean : {0.3, 2.0, 20.0, 300.0}) {
      for (const uint32_t components : {1u, 2u, 3u}) {
        const std::vector<uint32_t> symbols = Residuals(num_values, components, mean, 7);
        const size_t size = ExpectRoundTrip(symbols, components), by_draco = SizeByDraco(symbols, components);
        EXPECT_LE(size, by_draco);
        ours += static_cast<double>(size) / static_cast<double>(by_draco);
        dracos += 1;
      }
    }
  }
  EXPECT_LT(ours, 0.97 * dracos);
  EXPECT_GT(ours, 0.9 * dracos);
}

TEST(EncodeSymbolBlock, SymbolsThatTellNothingTakeAFewBytes) {
  for (const uint32_t symbol : {0u, 1u, 700u}) {
    EXPECT_LE(ExpectRoundTrip(std::vector<uint32_t>(10000, symbol), 1), 9 + symbol / 64);  // the table is a byte longer for every 64 that do not occur
  }
}

TEST(EncodeSymbolBlock, LargeSymbolsAreTagged) {
  EXPECT_LE(ExpectRoundTrip({(1u << 31) - 1, 0, 5, 1u << 30}, 1), 4 * 31 / 8 + 14u);
  EXPECT_LE(ExpectRoundTrip({(1u << 31) - 1, (1u << 31) - 2, (1u << 31) - 3}, 3), 3 * 31 / 8 + 9u);
}

TEST(EncodeSymbolBlock, RareLengthsAreMerged) {
  // 1000 values of 8 bits, and one of each lesser length, for which other tags would take more than a byte of table each.
  std::vector<uint32_t> symbols;
  std::mt19937 random(1);
  for (int i = 0; i < 3000; ++i) symbols.push_back(static_cast<uint32_t>(128 + random() % 128));
  for (uint32_t length = 1; length < 8; ++length) symbols.insert(symbols.end(), {1u << (length - 1), 0, 0});
  EXPECT_LE(ExpectRoundTrip(symbols, 3), symbols.size() + 10);
}

TEST(SymbolLength, CountsBits) {
  for (const auto& [symbol, length] : std::vector<std::pair<uint32_t, uint32_t>>{{0, 1}, {1, 1}, {2, 2}, {3, 2}, {255, 8}, {256, 9}, {~0u, 32}}) {
    EXPECT_EQ(SymbolLength(symbol), length);
  }
}

TEST(EncodeBitBlock, DracoReadsWhatWasWrittenInNoMoreBytes) {
  std::mt19937 random(4);
  size_t ours = 0, dracos = 0;
  for (int run = 0; run < 2000 && !::testing::Test::HasFailure(); ++run) {
    SCOPED_TRACE(run);
    std::vector<uint8_t> bits(1 + random() % 300);
    const auto share = random() % 110;  // in percent
    draco::RAnsBitEncoder encoder;
    encoder.StartEncoding();
    for (uint8_t& bit : bits) {
      bit = random() % 100 < share ? 1 : 0;
      encoder.EncodeBit(bit != 0);
    }
    draco::EncoderBuffer by_draco;
    encoder.EndEncoding(&by_draco);
    Bytes bytes = EncodeBitBlock(bits);
    EXPECT_LE(bytes.size(), by_draco.size());
    ours += bytes.size();
    dracos += by_draco.size();
    bytes.push_back(0);
    draco::DecoderBuffer reader = Reader(bytes);
    draco::RAnsBitDecoder decoder;
    ASSERT_TRUE(decoder.StartDecoding(&reader));
    for (const uint8_t bit : bits) EXPECT_EQ(decoder.DecodeNextBit(), bit != 0);
    EXPECT_EQ(reader.remaining_size(), 1);
  }
  EXPECT_LT(ours + 1000, dracos);  // half a byte each
}

}  // namespace
}  // namespace lacerta
