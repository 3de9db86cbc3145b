#include "draco/parallelogram_prices.h"

#include <algorithm>

namespace lacerta {
namespace {

using Prediction = ParallelogramChoice::Prediction;

ByVertex FindDependents(const PositionStream& stream, size_t num_vertices) {
  const PredictableValues& order = stream.order();
  const std::vector<uint32_t>& vertices = stream.vertices();
  std::vector<std::vector<uint32_t>> values(num_vertices);
  const auto add = [&](uint32_t v, uint32_t n) {
    if (values[v].empty() || values[v].back() != n) values[v].push_back(n);
  };
  for (uint32_t n = 0; n < order.size(); ++n) {
    add(vertices[n], n);
    if (n > 0) add(vertices[n - 1], n);
    for (uint32_t i = order.first_parallelogram[n]; i < order.first_parallelogram[n + 1]; ++i) {
      for (const uint32_t u : order.parallelograms[i]) add(vertices[u], n);
    }
  }
  ByVertex result;
  result.first = {0};
  for (const std::vector<uint32_t>& of_vertex : values) {
    result.items.insert(result.items.end(), of_vertex.begin(), of_vertex.end());
    result.first.push_back(static_cast<uint32_t>(result.items.size()));
  }
  return result;
}

}  // namespace

ParallelogramPrices::ParallelogramPrices(const PositionStream& stream, size_t num_vertices) : stream_(stream), dependents_(FindDependents(stream, num_vertices)) {}

void ParallelogramPrices::Begin(const std::vector<LatticePoint>& points) {
  values_ = stream_.ValuesAt(points);
  choice_ = CodeByParallelograms(values_).choice;
  const ParallelogramPredictor predictor(values_);
  wrap_ = predictor.wrap();
  costs_.emplace(predictor, choice_);
}

ParallelogramPrices::Part ParallelogramPrices::PartOf(uint32_t n, uint32_t v) const {
  if (stream_.vertices()[n] == v) return {{}, 1};
  const int32_t* const p = &values_.values[size_t{3} * n];
  return {{p[0], p[1], p[2]}, 0};
}

void ParallelogramPrices::LookAround(uint32_t v) {
  around_.clear();
  for (const uint32_t n : dependents_[v]) {
    Dependent dependent;
    dependent.value = PartOf(n, v);
    if (n > 0) dependent.before = PartOf(n - 1, v);
    dependent.offers = values_.num_parallelograms(n);
    dependent.has_usual = values_.has_usual[n] != 0;
    for (uint32_t i = 0; i < dependent.offers; ++i) {
      const auto& [a, b, c] = values_.parallelograms[values_.first_parallelogram[n] + i];
      const Part first = PartOf(a, v), second = PartOf(b, v), across = PartOf(c, v);
      Part& sum = dependent.parallelograms[i];
      sum.factor = first.factor + second.factor - across.factor;
      for (size_t k = 0; k < 3; ++k) sum.rest[k] = first.rest[k] + second.rest[k] - across.rest[k];
    }
    around_.push_back(dependent);
  }
}

double ParallelogramPrices::BitsOf(const Dependent& dependent, const LatticePoint& p) const {
  const LatticePoint value = dependent.value.At(p);
  std::array<LatticePoint, kMostParallelograms> predictions;
  for (uint32_t i = 0; i < dependent.offers; ++i) predictions[i] = dependent.parallelograms[i].At(p);
  const auto bits_by = [&](const LatticePoint& sum, int32_t count, uint32_t num_used) {
    std::array<uint32_t, 3> symbols;
    for (size_t k = 0; k < 3; ++k) symbols[k] = wrap_.Symbol(value[k], sum[k] / count);
    return costs_->Of(symbols.data(), num_used, dependent.offers);
  };
  const LatticePoint before = dependent.before.At(p);
  if (choice_.prediction == Prediction::kParallelogram) return dependent.has_usual ? bits_by(predictions[0], 1, 1) : bits_by(before, 1, 0);
  double least = bits_by(before, 1, 0);
  for (uint32_t used = 1; used < 1u << dependent.offers; ++used) {
    LatticePoint sum{};
    int32_t count = 0;
    for (uint32_t i = 0; i < dependent.offers; ++i) {
      if ((used >> i & 1) == 0) continue;
      for (size_t k = 0; k < 3; ++k) sum[k] += predictions[i][k];
      ++count;
    }
    least = std::min(least, bits_by(sum, count, static_cast<uint32_t>(count)));
  }
  return least;
}

double ParallelogramPrices::Bits(const LatticePoint& p, double enough) const {
  double bits = 0;
  for (const Dependent& dependent : around_) {
    if (bits >= enough) break;
    bits += BitsOf(dependent, p);
  }
  return bits;
}

void ParallelogramPrices::Move(uint32_t v, const LatticePoint& p) {
  for (const uint32_t n : dependents_[v]) {
    if (stream_.vertices()[n] == v) std::copy(p.begin(), p.end(), values_.values.begin() + ptrdiff_t{3} * n);
  }
}

LinearPredictions ParallelogramPrices::Predictions() const {
  LinearPredictions result(LinearPredictions::kFlapsPerVertex);
  const std::vector<uint32_t>& vertices = stream_.vertices();
  for (uint32_t n = 1; n < values_.size(); ++n) {
    const uint32_t used = choice_.used[n];
    result.Add(vertices[n], 1);
    if (used == 0) result.Add(vertices[n - 1], -1);
    const float share = used == 0 ? 0 : 1 / static_cast<float>(NumUsed(used));
    for (uint32_t i = 0; used >> i != 0; ++i) {
      if ((used >> i & 1) == 0) continue;
      const auto& [a, b, c] = values_.parallelograms[values_.first_parallelogram[n] + i];
      result.Add(vertices[a], -share);
      result.Add(vertices[b], -share);
      result.Add(vertices[c], share);
    }
    result.EndPrediction();
  }
  return result;
}

}  // namespace lacerta
