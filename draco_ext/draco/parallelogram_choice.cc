#include "draco/parallelogram_choice.h"

#include <draco/attributes/point_attribute.h>
#include <draco/compression/attributes/mesh_attribute_indices_encoding_data.h>
#include <draco/compression/config/compression_shared.h>
#include <draco/mesh/corner_table.h>
#include <draco/mesh/mesh.h>
#include <draco/mesh/mesh_attribute_corner_table.h>

#include <algorithm>
#include <bitset>
#include <cmath>
#include <cstddef>
#include <limits>
#include <utility>

#include "draco/symbol_block.h"
#include "encoder/byte_writer.h"

namespace lacerta {
namespace {

using draco::CornerIndex;

// Parallelograms of a value over the triangles around its corner `start`, all of whose values come before, in the order of Draco's decoder: to the
// left, from a border on to the right.
template <typename CornerTable>
void AppendParallelograms(const CornerTable& table, const std::vector<int32_t>& ranks, CornerIndex start, std::vector<std::array<uint32_t, 3>>* result) {
  const size_t most = result->size() + kMostParallelograms;
  const auto rank = [&](CornerIndex c) { return static_cast<uint32_t>(ranks[table.Vertex(c).value()]); };
  const uint32_t predicted = rank(start);
  const auto append = [&](CornerIndex corner) {
    const CornerIndex across = table.Opposite(corner);
    if (across == draco::kInvalidCornerIndex) return;
    const std::array<uint32_t, 3> p = {rank(table.Next(across)), rank(table.Previous(across)), rank(across)};
    if (*std::max_element(p.begin(), p.end()) < predicted) result->push_back(p);
  };
  CornerIndex corner = start;
  do {
    append(corner);
    corner = table.SwingLeft(corner);
  } while (result->size() < most && corner != draco::kInvalidCornerIndex && corner != start);
  if (corner != draco::kInvalidCornerIndex) return;
  for (corner = table.SwingRight(start); result->size() < most && corner != draco::kInvalidCornerIndex; corner = table.SwingRight(corner)) append(corner);
}

// Corrections of predictions as symbols: modulo the range of the values, 0, -1, 1, -2, 2 as 0, 1, 2, 3, 4.
class Wrap {
 public:
  explicit Wrap(const std::vector<int32_t>& values) {
    const auto [low, high] = std::minmax_element(values.begin(), values.end());
    low_ = *low;
    high_ = *high;
    range_ = 1 + high_ - low_;
    least_ = -(range_ / 2);
    most_ = (range_ - 1) / 2;
  }

  uint32_t Symbol(int32_t value, int64_t prediction) const {
    int64_t correction = value - std::clamp(prediction, low_, high_);
    if (correction < least_) {
      correction += range_;
    } else if (correction > most_) {
      correction -= range_;
    }
    return static_cast<uint32_t>(correction < 0 ? -2 * correction - 1 : 2 * correction);
  }

  int32_t low() const { return static_cast<int32_t>(low_); }
  int32_t high() const { return static_cast<int32_t>(high_); }

 private:
  int64_t low_ = 0, high_ = 0, range_ = 1, least_ = 0, most_ = 0;
};

// By value, a bit for each of its parallelograms: whether it takes part.
using Choice = std::vector<uint8_t>;

class Predictor {
 public:
  explicit Predictor(const PredictableValues& values) : values_(values), wrap_(values.values) {
    predictions_.reserve(values.parallelograms.size() * values.components);
    for (const auto& [a, b, c] : values.parallelograms) {
      for (uint32_t k = 0; k < values.components; ++k) predictions_.push_back(At(a, k) + At(b, k) - At(c, k));
    }
  }

  size_t size() const { return values_.size(); }
  uint32_t components() const { return values_.components; }
  uint32_t num_parallelograms(size_t n) const { return values_.first_parallelogram[n + 1] - values_.first_parallelogram[n]; }
  const Wrap& wrap() const { return wrap_; }

  // Symbols of the n-th value, predicted by the mean of the parallelograms of `used`; by the value before where there are none.
  void Symbols(size_t n, uint8_t used, uint32_t* symbols) const {
    for (uint32_t k = 0; k < values_.components; ++k) {
      int64_t prediction = used != 0 || n == 0 ? 0 : At(n - 1, k);
      if (used != 0) {
        int64_t count = 0;
        for (uint32_t i = 0; used >> i != 0; ++i) {
          if ((used >> i & 1) == 0) continue;
          prediction += predictions_[size_t{values_.first_parallelogram[n] + i} * values_.components + k];
          ++count;
        }
        prediction /= count;
      }
      symbols[k] = wrap_.Symbol(At(n, k), prediction);
    }
  }

 private:
  int32_t At(size_t n, uint32_t k) const { return values_.values[n * values_.components + k]; }

  const PredictableValues& values_;
  const Wrap wrap_;
  std::vector<int32_t> predictions_;  // of each parallelogram
};

uint32_t NumUsed(uint32_t choice) { return static_cast<uint32_t>(std::bitset<kMostParallelograms>(choice).count()); }

enum class Scheme { kTagged, kRaw };

// What symbols and flags take in a stream where they are as frequent as they were in one before, bits.
class Costs {
 public:
  Costs(Scheme scheme, const Predictor& predictor, const Choice& choice) : scheme_(scheme), components_(predictor.components()) {
    std::vector<uint32_t> symbols(components_);
    std::array<double, kMostParallelograms + 1> used{}, offered{};
    for (size_t n = 0; n < choice.size(); ++n) {
      predictor.Symbols(n, choice[n], symbols.data());
      for (const uint32_t s : symbols) Count(s);
      ++lengths_[SymbolLength(*std::max_element(symbols.begin(), symbols.end()))];
      const uint32_t offers = predictor.num_parallelograms(n);
      used[offers] += NumUsed(choice[n]);
      offered[offers] += offers;
    }
    const auto num_values = static_cast<double>(choice.size());
    constexpr double kTableBits = 8, kLittle = 0.3;
    unseen_ = std::log2(num_values * components_) + kTableBits;
    for (double& s : symbols_) s = s == 0 ? unseen_ : std::log2(num_values * components_ / s) + kTableBits / 2 / s;
    for (uint32_t l = 0; l < lengths_.size(); ++l) lengths_[l] = std::log2(num_values / (lengths_[l] + kLittle)) + l * components_;
    for (uint32_t i = 1; i <= kMostParallelograms; ++i) {
      used_[i] = std::log2((offered[i] + 2) / (used[i] + 1));
      left_out_[i] = std::log2((offered[i] + 2) / (offered[i] - used[i] + 1));
    }
  }

  double Of(const uint32_t* symbols, uint32_t num_used, uint32_t offers) const {
    const double flags = num_used * used_[offers] + (offers - num_used) * left_out_[offers];
    if (scheme_ == Scheme::kTagged) return flags + lengths_[SymbolLength(*std::max_element(symbols, symbols + components_))];
    double bits = flags;
    for (uint32_t k = 0; k < components_; ++k) bits += symbols[k] < symbols_.size() ? symbols_[symbols[k]] : unseen_;
    return bits;
  }

 private:
  void Count(uint32_t symbol) {
    if (symbol >= kMostCounted) return;
    if (symbol >= symbols_.size()) symbols_.resize(size_t{symbol} + 1, 0);
    ++symbols_[symbol];
  }

  static constexpr uint32_t kMostCounted = 1u << 16;

  const Scheme scheme_;
  const uint32_t components_;
  std::vector<double> symbols_;
  double unseen_ = 0;
  std::array<double, 33> lengths_{};  // of all components of a value, with the tag
  std::array<double, kMostParallelograms + 1> used_{}, left_out_{};
};

Choice LeastOf(const Predictor& predictor, const Costs& costs) {
  Choice choice(predictor.size());
  std::vector<uint32_t> symbols(predictor.components());
  for (size_t n = 0; n < choice.size(); ++n) {
    const uint32_t offers = predictor.num_parallelograms(n);
    double least = std::numeric_limits<double>::infinity();
    for (uint32_t used = 0; used < 1u << offers; ++used) {
      predictor.Symbols(n, static_cast<uint8_t>(used), symbols.data());
      const double cost = costs.Of(symbols.data(), NumUsed(used), offers);
      if (cost >= least) continue;
      least = cost;
      choice[n] = static_cast<uint8_t>(used);
    }
  }
  return choice;
}

Choice FindChoice(const Predictor& predictor, Scheme scheme) {
  Choice choice;
  for (size_t n = 0; n < predictor.size(); ++n) choice.push_back(static_cast<uint8_t>((1u << predictor.num_parallelograms(n)) - 1));
  constexpr int kRounds = 6;
  for (int i = 0; i < kRounds; ++i) choice = LeastOf(predictor, Costs(scheme, predictor, choice));
  return choice;
}

Bytes Write(const Predictor& predictor, const Choice& choice) {
  const uint32_t components = predictor.components();
  std::vector<uint32_t> symbols(choice.size() * components);
  std::array<std::vector<uint8_t>, kMostParallelograms + 1> left_out;
  for (size_t n = 0; n < choice.size(); ++n) {
    predictor.Symbols(n, choice[n], &symbols[n * components]);
    const uint32_t offers = predictor.num_parallelograms(n);
    for (uint32_t i = 0; i < offers; ++i) left_out[offers].push_back((choice[n] >> i & 1) == 0);
  }
  Bytes bytes = {draco::MESH_PREDICTION_CONSTRAINED_MULTI_PARALLELOGRAM, draco::PREDICTION_TRANSFORM_WRAP, 1};  // 1: coded symbols follow
  const auto append = [&](const Bytes& block) { bytes.insert(bytes.end(), block.begin(), block.end()); };
  append(EncodeSymbolBlock(symbols, components));
  for (uint32_t i = 1; i <= kMostParallelograms; ++i) {
    PutVarint(left_out[i].size(), &bytes);
    if (!left_out[i].empty()) append(EncodeBitBlock(left_out[i]));
  }
  PutWord32(static_cast<uint32_t>(predictor.wrap().low()), &bytes);
  PutWord32(static_cast<uint32_t>(predictor.wrap().high()), &bytes);
  return bytes;
}

}  // namespace

std::optional<PredictableValues> FindPredictableValues(const draco::MeshDecoder& decoder, int attribute) {
  const draco::PointAttribute& from = *decoder.mesh()->attribute(attribute);
  const draco::MeshAttributeIndicesEncodingData* const order = decoder.GetAttributeEncodingData(attribute);
  const draco::MeshAttributeCornerTable* const cut = decoder.GetAttributeCornerTable(attribute);  // along seams
  const draco::CornerTable* const whole = decoder.GetCornerTable();
  if (order == nullptr || whole == nullptr) return std::nullopt;
  const std::vector<CornerIndex>& corners = order->encoded_attribute_value_index_to_corner_map;
  const std::vector<int32_t>& ranks = order->vertex_to_encoded_attribute_value_index_map;
  if (corners.empty() || corners.size() != from.size()) return std::nullopt;
  PredictableValues result;
  result.components = static_cast<uint32_t>(from.num_components());
  result.values.resize(corners.size() * result.components);
  result.first_parallelogram = {0};
  for (uint32_t n = 0; n < corners.size(); ++n) {
    if (!from.ConvertValue<int32_t>(draco::AttributeValueIndex(n), from.num_components(), result.values.data() + size_t{n} * result.components)) return std::nullopt;
    if (cut != nullptr) {
      AppendParallelograms(*cut, ranks, corners[n], &result.parallelograms);
    } else {
      AppendParallelograms(*whole, ranks, corners[n], &result.parallelograms);
    }
    result.first_parallelogram.push_back(static_cast<uint32_t>(result.parallelograms.size()));
  }
  if (std::any_of(result.values.begin(), result.values.end(), [](int32_t v) { return v < -kMostValue || v > kMostValue; })) return std::nullopt;
  return result;
}

Bytes EncodeByParallelograms(const PredictableValues& values) {
  const Predictor predictor(values);
  Bytes best;
  for (const Scheme scheme : {Scheme::kTagged, Scheme::kRaw}) {
    Bytes bytes = Write(predictor, FindChoice(predictor, scheme));
    if (best.empty() || bytes.size() < best.size()) best = std::move(bytes);
  }
  return best;
}

}  // namespace lacerta
