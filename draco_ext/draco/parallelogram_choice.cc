#include "draco/parallelogram_choice.h"

#include <draco/compression/config/compression_shared.h>

#include <algorithm>
#include <bitset>
#include <cmath>
#include <limits>
#include <utility>

#include "draco/symbol_block.h"
#include "encoder/byte_writer.h"

namespace lacerta {
namespace {

using Prediction = ParallelogramChoice::Prediction;
using Scheme = ParallelogramChoice::Scheme;

ParallelogramChoice LeastOf(const ParallelogramPredictor& predictor, Scheme scheme, const SymbolCosts& costs) {
  const PredictableValues& values = predictor.values();
  ParallelogramChoice choice = {Prediction::kConstrainedMulti, scheme, std::vector<uint8_t>(values.size())};
  std::vector<uint32_t> symbols(values.components);
  for (size_t n = 0; n < values.size(); ++n) {
    const uint32_t offers = values.num_parallelograms(n);
    double least = std::numeric_limits<double>::infinity();
    for (uint32_t used = 0; used < 1u << offers; ++used) {
      predictor.Symbols(n, used, symbols.data());
      const double cost = costs.Of(symbols.data(), NumUsed(used), offers);
      if (cost >= least) continue;
      least = cost;
      choice.used[n] = static_cast<uint8_t>(used);
    }
  }
  return choice;
}

ParallelogramChoice FindChoice(const ParallelogramPredictor& predictor, Scheme scheme) {
  ParallelogramChoice choice = {Prediction::kConstrainedMulti, scheme, {}};
  for (size_t n = 0; n < predictor.values().size(); ++n) choice.used.push_back(static_cast<uint8_t>((1u << predictor.values().num_parallelograms(n)) - 1));
  constexpr int kRounds = 6;
  for (int i = 0; i < kRounds; ++i) choice = LeastOf(predictor, scheme, SymbolCosts(predictor, choice));
  return choice;
}

CodedValues Code(const ParallelogramPredictor& predictor, ParallelogramChoice choice) {
  const PredictableValues& values = predictor.values();
  const bool has_flags = choice.prediction == Prediction::kConstrainedMulti;
  std::vector<uint32_t> symbols(values.size() * values.components);
  std::array<std::vector<uint8_t>, kMostParallelograms + 1> left_out;
  for (size_t n = 0; n < values.size(); ++n) {
    predictor.Symbols(n, choice.used[n], &symbols[n * values.components]);
    const uint32_t offers = values.num_parallelograms(n);
    for (uint32_t i = 0; i < offers; ++i) left_out[offers].push_back((choice.used[n] >> i & 1) == 0);
  }
  const uint8_t prediction = has_flags ? draco::MESH_PREDICTION_CONSTRAINED_MULTI_PARALLELOGRAM : draco::MESH_PREDICTION_PARALLELOGRAM;
  Bytes bytes = {prediction, draco::PREDICTION_TRANSFORM_WRAP, 1};  // 1: coded symbols follow
  const auto append = [&](const Bytes& block) { bytes.insert(bytes.end(), block.begin(), block.end()); };
  const Bytes block = EncodeSymbolBlock(symbols, values.components);
  choice.scheme = block.front() == draco::SYMBOL_CODING_TAGGED ? Scheme::kTagged : Scheme::kRaw;
  append(block);
  for (size_t i = 1; has_flags && i < left_out.size(); ++i) {
    PutVarint(left_out[i].size(), &bytes);
    if (!left_out[i].empty()) append(EncodeBitBlock(left_out[i]));
  }
  PutWord32(static_cast<uint32_t>(predictor.wrap().low()), &bytes);
  PutWord32(static_cast<uint32_t>(predictor.wrap().high()), &bytes);
  return {std::move(choice), std::move(bytes)};
}

}  // namespace

uint32_t NumUsed(uint32_t used) { return static_cast<uint32_t>(std::bitset<kMostParallelograms>(used).count()); }

ParallelogramPredictor::ParallelogramPredictor(const PredictableValues& values) : values_(values), wrap_(values.values) {
  predictions_.reserve(values.parallelograms.size() * values.components);
  for (const auto& [a, b, c] : values.parallelograms) {
    for (uint32_t k = 0; k < values.components; ++k) predictions_.push_back(At(a, k) + At(b, k) - At(c, k));
  }
}

void ParallelogramPredictor::Symbols(size_t n, uint32_t used, uint32_t* symbols) const {
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

SymbolCosts::SymbolCosts(const ParallelogramPredictor& predictor, const ParallelogramChoice& choice)
    : is_tagged_(choice.scheme == Scheme::kTagged), components_(predictor.values().components) {
  const PredictableValues& values = predictor.values();
  std::vector<uint32_t> symbols(components_);
  std::array<double, kMostParallelograms + 1> used{}, offered{};
  for (size_t n = 0; n < values.size(); ++n) {
    predictor.Symbols(n, choice.used[n], symbols.data());
    for (const uint32_t s : symbols) Count(s);
    ++lengths_[SymbolLength(*std::max_element(symbols.begin(), symbols.end()))];
    const uint32_t offers = values.num_parallelograms(n);
    used[offers] += NumUsed(choice.used[n]);
    offered[offers] += offers;
  }
  const auto num_values = static_cast<double>(values.size());
  constexpr double kTableBits = 8, kLittle = 0.3;
  unseen_ = std::log2(num_values * components_) + kTableBits;
  for (double& s : symbols_) s = s == 0 ? unseen_ : std::log2(num_values * components_ / s) + kTableBits / 2 / s;
  for (uint32_t l = 0; l < lengths_.size(); ++l) lengths_[l] = std::log2(num_values / (lengths_[l] + kLittle)) + l * components_;
  if (choice.prediction == Prediction::kParallelogram) return;
  for (size_t i = 1; i < offered.size(); ++i) {
    used_[i] = std::log2((offered[i] + 2) / (used[i] + 1));
    left_out_[i] = std::log2((offered[i] + 2) / (offered[i] - used[i] + 1));
  }
}

void SymbolCosts::Count(uint32_t symbol) {
  constexpr uint32_t kMostCounted = 1u << 16;
  if (symbol >= kMostCounted) return;
  if (symbol >= symbols_.size()) symbols_.resize(size_t{symbol} + 1, 0);
  ++symbols_[symbol];
}

double SymbolCosts::Tagged(const uint32_t* symbols) const { return lengths_[SymbolLength(*std::max_element(symbols, symbols + components_))]; }

double SymbolCosts::Raw(const uint32_t* symbols) const {
  double bits = 0;
  for (uint32_t k = 0; k < components_; ++k) bits += symbols[k] < symbols_.size() ? symbols_[symbols[k]] : unseen_;
  return bits;
}

CodedValues CodeByParallelograms(const PredictableValues& values) {
  const ParallelogramPredictor predictor(values);
  CodedValues best = Code(predictor, {Prediction::kParallelogram, Scheme::kTagged, values.has_usual});
  for (const Scheme scheme : {Scheme::kTagged, Scheme::kRaw}) {
    CodedValues coded = Code(predictor, FindChoice(predictor, scheme));
    if (coded.bytes.size() < best.bytes.size()) best = std::move(coded);
  }
  return best;
}

}  // namespace lacerta
