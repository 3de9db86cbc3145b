#include "draco/symbol_block.h"

#include <draco/core/bit_utils.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "encoder/byte_writer.h"

namespace lacerta {
namespace {

constexpr uint8_t kTagged = 0, kRaw = 1;  // draco::SymbolCodingMethod
constexpr int kTagPrecision = 12;

// How often each symbol occurs; the last one does.
using Counts = std::vector<uint64_t>;

// Out of 2^precision; 0 for symbols that do not occur.
struct ProbabilityTable {
  int precision = 12;
  std::vector<uint32_t> probabilities;
};

// What a decoder that reads the table takes for granted.
constexpr uint32_t kFewestForTwoBytes = 1u << 6, kFewestForThreeBytes = 1u << 14;

size_t BytesOf(uint32_t probability) { return size_t{1} + (probability >= kFewestForTwoBytes) + (probability >= kFewestForThreeBytes); }

Bytes WriteTable(const std::vector<uint32_t>& probabilities) {
  constexpr size_t kLongestRun = 64;
  Bytes bytes;
  PutVarint(probabilities.size(), &bytes);
  for (size_t i = 0; i < probabilities.size();) {
    const uint32_t p = probabilities[i];
    if (p == 0) {
      size_t run = 1;
      while (run < kLongestRun && probabilities[i + run] == 0) ++run;  // the last probability is not 0
      bytes.push_back(static_cast<uint8_t>((run - 1) << 2 | 3));
      i += run;
      continue;
    }
    const size_t more = BytesOf(p) - 1;
    bytes.push_back(static_cast<uint8_t>(p << 2 | more));
    for (size_t k = 0; k < more; ++k) bytes.push_back(static_cast<uint8_t>(p >> (6 + 8 * k)));
    ++i;
  }
  return bytes;
}

// Probabilities in proportion to the counts, but the most that a byte holds where a second byte would cost more than it brings; none where there
// are more symbols than 2^precision.
std::optional<ProbabilityTable> Allocate(const Counts& counts, int precision) {
  const double whole = std::ldexp(1.0, precision);
  std::map<uint64_t, uint64_t> symbols_of_count;
  double total = 0;
  uint64_t num_symbols = 0;
  for (const uint64_t n : counts) {
    if (n == 0) continue;
    ++symbols_of_count[n];
    ++num_symbols;
    total += static_cast<double>(n);
  }
  if (static_cast<double>(num_symbols) > whole) return std::nullopt;
  // A symbol of ideal probability p occurs p / s times, s = whole / total, and with q instead it takes (p ln(p / q) - (p - q)) / (s ln 2) bits more,
  // what the others gain included: about (p - q)^2 / (2 q s ln 2), here 8.
  constexpr double kMostInAByte = kFewestForTwoBytes - 1;
  const double dear = kMostInAByte + std::sqrt(8 * 2 * kMostInAByte * std::log(2.0) * whole / total);
  const auto probability = [&](uint64_t count, double scale) {
    const double ideal = static_cast<double>(count) * scale;
    if (ideal > kMostInAByte && ideal < dear) return static_cast<uint32_t>(kMostInAByte);
    return std::max(1u, static_cast<uint32_t>(std::lround(std::min(ideal, whole))));
  };
  const auto sum = [&](double scale) {
    double result = 0;
    for (const auto& [count, symbols] : symbols_of_count) result += static_cast<double>(symbols) * probability(count, scale);
    return result;
  };
  double low = 0, high = 2 * whole / total;
  constexpr int kHalvings = 40;
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = (low + high) / 2;
    (sum(middle) > whole ? high : low) = middle;
  }
  ProbabilityTable table{precision, std::vector<uint32_t>(counts.size(), 0)};
  for (size_t i = 0; i < counts.size(); ++i) {
    if (counts[i] > 0) table.probabilities[i] = probability(counts[i], low);
  }
  const auto most_frequent = static_cast<size_t>(std::max_element(counts.begin(), counts.end()) - counts.begin());
  table.probabilities[most_frequent] += static_cast<uint32_t>(whole - sum(low));
  return table;
}

// Of the symbols and the table, bits.
double SizeWith(const ProbabilityTable& table, const Counts& counts) {
  double bits = 8.0 * static_cast<double>(WriteTable(table.probabilities).size());
  for (size_t i = 0; i < counts.size(); ++i) {
    if (counts[i] > 0) bits += static_cast<double>(counts[i]) * (table.precision - std::log2(table.probabilities[i]));
  }
  return bits;
}

// The state that a decoder begins with, counted from the least one it may be.
void PutFirstState(uint32_t state, Bytes* bytes) {
  const uint32_t more = (state >= 1u << 6) + (state >= 1u << 14) + (state >= 1u << 22);  // bytes, told in the two highest bits
  state |= more << (6 + 8 * more);
  for (uint32_t k = 0; k <= more; ++k) bytes->push_back(static_cast<uint8_t>(state >> (8 * k)));
}

// The fewest bytes that encode(last state) makes for some states of a decoder that ends. There may be none for states near 0, where hardly any symbol
// tells anything and none is reached that a decoder can begin with; there always are for `least`, from which Draco's encoder begins.
template <typename Encode>
Bytes EncodeSmallest(size_t num_symbols, uint32_t least, const Encode& encode) {
  constexpr size_t kMostSteps = size_t{1} << 14;
  const auto num_states = static_cast<uint32_t>(std::clamp(kMostSteps / num_symbols, size_t{1}, size_t{64}));
  Bytes best = *encode(least);
  for (uint32_t last = 0; last < num_states; ++last) {
    std::optional<Bytes> bytes = encode(last);
    if (bytes.has_value() && bytes->size() < best.size()) best = std::move(*bytes);
  }
  return best;
}

// The states that a decoder goes through, backwards.
class RansEncoder {
 public:
  explicit RansEncoder(const ProbabilityTable& table) : table_(table), before_(table.probabilities.size(), 0) {
    for (size_t i = 1; i < before_.size(); ++i) before_[i] = before_[i - 1] + table.probabilities[i - 1];
  }

  Bytes Encode(Span<const uint32_t> symbols) const {
    return EncodeSmallest(symbols.size(), LeastState(), [&](uint32_t last) { return EncodeFrom(last, symbols); });
  }

 private:
  // Below it decoders read bytes, as long as there are any.
  uint32_t LeastState() const { return 4u << table_.precision; }

  std::optional<Bytes> EncodeFrom(uint32_t last, Span<const uint32_t> symbols) const {
    Bytes bytes;
    uint32_t state = last;
    for (size_t i = symbols.size(); i-- > 0;) {
      const uint32_t p = table_.probabilities[symbols[i]];
      for (; state >= 4 * 256 * p; state >>= 8) bytes.push_back(static_cast<uint8_t>(state));
      state = ((state / p) << table_.precision) + state % p + before_[symbols[i]];
    }
    if (state < LeastState()) return std::nullopt;
    PutFirstState(state - LeastState(), &bytes);
    return bytes;
  }

  const ProbabilityTable& table_;
  std::vector<uint32_t> before_;  // sum of the probabilities of lesser symbols
};

// The table, the number of coded bytes, and these.
void Append(Span<const uint32_t> symbols, const ProbabilityTable& table, Bytes* bytes) {
  const Bytes written = WriteTable(table.probabilities), coded = RansEncoder(table).Encode(symbols);
  bytes->insert(bytes->end(), written.begin(), written.end());
  PutVarint(coded.size(), bytes);
  bytes->insert(bytes->end(), coded.begin(), coded.end());
}

Counts Count(Span<const uint32_t> symbols) {
  Counts counts(size_t{*std::max_element(symbols.begin(), symbols.end())} + 1, 0);
  for (const uint32_t s : symbols) ++counts[s];
  return counts;
}

// None where symbols are too large or too many for this scheme.
std::optional<Bytes> EncodeRaw(Span<const uint32_t> symbols) {
  constexpr uint32_t kMostSymbol = (1u << 18) - 1;
  if (*std::max_element(symbols.begin(), symbols.end()) > kMostSymbol) return std::nullopt;
  const Counts counts = Count(symbols);
  // By the number of bits that is written: the precision is one and a half times that, within 12 .. 20.
  constexpr std::array<std::pair<uint8_t, int>, 7> kPrecisions = {{{8, 12}, {9, 13}, {10, 15}, {11, 16}, {12, 18}, {13, 19}, {14, 20}}};
  std::optional<ProbabilityTable> best;
  uint8_t written = 0;
  double fewest = std::numeric_limits<double>::infinity();
  for (const auto& [bits, precision] : kPrecisions) {
    std::optional<ProbabilityTable> table = Allocate(counts, precision);
    if (!table.has_value()) continue;
    const double size = SizeWith(*table, counts);
    if (size >= fewest) continue;
    fewest = size;
    written = bits;
    best = std::move(table);
  }
  if (!best.has_value()) return std::nullopt;
  Bytes bytes = {kRaw, written};
  Append(symbols, *best, &bytes);
  return bytes;
}

constexpr size_t kMostLength = 31;  // of symbols, and the largest tag

// The length that values of each length are written with: their own or a longer one, where another tag takes more bits than longer values do.
std::array<uint32_t, kMostLength + 1> MergedLengths(const Counts& counts, uint32_t components) {
  double total = 0;
  for (const uint64_t n : counts) total += static_cast<double>(n);
  std::array<double, kMostLength + 1> fewest{};  // bits of lengths up to each, were it one that is written
  std::array<size_t, kMostLength + 1> previous{};
  for (size_t length = 1; length < counts.size(); ++length) {
    fewest[length] = std::numeric_limits<double>::infinity();
    double values = 0;
    for (size_t below = length; below-- > 0;) {
      values += static_cast<double>(counts[below + 1]);
      const double table = 16 + (below + 1 < length ? 8 : 0);
      const double bits = fewest[below] + (values == 0 ? 0 : table + values * (components * static_cast<double>(length) + std::log2(total / values)));
      if (bits >= fewest[length]) continue;
      fewest[length] = bits;
      previous[length] = below;
    }
  }
  std::array<uint32_t, kMostLength + 1> result{};
  for (size_t length = counts.size() - 1; length > 0; length = previous[length]) {
    for (size_t merged = previous[length] + 1; merged <= length; ++merged) result[merged] = static_cast<uint32_t>(length);
  }
  return result;
}

Bytes EncodeTagged(Span<const uint32_t> symbols, uint32_t components) {
  std::vector<uint32_t> tags;
  for (size_t i = 0; i < symbols.size(); i += components) tags.push_back(SymbolLength(*std::max_element(&symbols[i], &symbols[i] + components)));
  const auto merged = MergedLengths(Count(tags), components);
  for (uint32_t& tag : tags) tag = merged[tag];
  const Span<const uint32_t> lengths(tags.data(), tags.size());
  Bytes bytes = {kTagged};
  Append(lengths, *Allocate(Count(lengths), kTagPrecision), &bytes);
  uint64_t pending = 0;
  uint32_t num_pending = 0;
  for (size_t i = 0; i < symbols.size(); ++i) {
    pending |= uint64_t{symbols[i]} << num_pending;
    for (num_pending += tags[i / components]; num_pending >= 8; num_pending -= 8) {
      bytes.push_back(static_cast<uint8_t>(pending));
      pending >>= 8;
    }
  }
  if (num_pending > 0) bytes.push_back(static_cast<uint8_t>(pending));
  return bytes;
}

}  // namespace

uint32_t SymbolLength(uint32_t symbol) { return 1 + static_cast<uint32_t>(draco::MostSignificantBit(std::max(symbol, 1u))); }

Bytes EncodeBitBlock(Span<const uint8_t> bits) {
  constexpr uint32_t kWhole = 256, kLeastState = 4096;
  const auto num_ones = static_cast<double>(std::count(bits.begin(), bits.end(), uint8_t{1}));
  const double zeros = static_cast<double>(bits.size()) - num_ones;
  const auto zero = static_cast<uint32_t>(std::clamp(std::round(kWhole * zeros / static_cast<double>(bits.size())), 1.0, 255.0));
  const uint32_t one = kWhole - zero;
  const auto encode = [&](uint32_t last) -> std::optional<Bytes> {
    Bytes bytes;
    uint32_t state = last;
    for (size_t i = bits.size(); i-- > 0;) {
      const uint32_t p = bits[i] != 0 ? one : zero;
      if (state >= kLeastState * p) {
        bytes.push_back(static_cast<uint8_t>(state));
        state >>= 8;
      }
      state = state / p * kWhole + state % p + (bits[i] != 0 ? 0 : one);
    }
    if (state < kLeastState) return std::nullopt;
    PutFirstState(state - kLeastState, &bytes);
    return bytes;
  };
  const Bytes coded = EncodeSmallest(bits.size(), kLeastState, encode);
  Bytes bytes = {static_cast<uint8_t>(zero)};
  PutVarint(coded.size(), &bytes);
  bytes.insert(bytes.end(), coded.begin(), coded.end());
  return bytes;
}

Bytes EncodeSymbolBlock(Span<const uint32_t> symbols, uint32_t components) {
  std::optional<Bytes> raw = EncodeRaw(symbols);
  Bytes tagged = EncodeTagged(symbols, components);
  return raw.has_value() && raw->size() <= tagged.size() ? std::move(*raw) : tagged;
}

}  // namespace lacerta
