#include "common/position_prediction.h"

#include <algorithm>

#include "common/integer_math.h"
#include "common/stream_layout.h"

namespace lacerta {
namespace {

// 256 + 1.5 (512 cos(2 pi / n) - 256) for n = 2.. 24, half as much again as equal angles would make it: bases are coded best so. More
// edges count as 24.
constexpr std::array<int32_t, 23> kTurns = {-896, -512, -128, 109, 256, 350, 415, 460, 493, 518, 536, 551, 563, 574, 581, 587, 593, 598, 602, 605, 608, 611, 614};

// More flaps of a vertex are left out: sums then stay below 2^62.
constexpr uint32_t kMostFlaps = 256;
// Of the equation that puts a vertex at a neighbor, which keeps it from where few flaps would shoot it. (64 * 256^2 is the weight of
// one of a parallelogram's two equations.)
constexpr int64_t kNeighborWeight = int64_t{1} << 20;

// Lists by vertex, one after the other.
void Gather(uint32_t num_vertices, const std::vector<std::pair<uint32_t, uint32_t>>& pairs, std::vector<uint32_t>* first,
            std::vector<uint32_t>* values) {
  first->assign(num_vertices + 1, 0);
  for (const auto& [v, value] : pairs) ++(*first)[v + 1];
  for (uint32_t v = 0; v < num_vertices; ++v) (*first)[v + 1] += (*first)[v];
  std::vector<uint32_t> at(first->begin(), first->end() - 1);
  values->resize(pairs.size());
  for (const auto& [v, value] : pairs) (*values)[at[v]++] = value;
}

LatticeVector Minus(const LatticePoint& a, const LatticePoint& b) {
  return {int64_t{a[0]} - b[0], int64_t{a[1]} - b[1], int64_t{a[2]} - b[2]};
}

}  // namespace

PositionPredictor::PositionPredictor(const Topology& t)
    : t_(t), num_known_(t.num_edges(), 0), is_known_(t.num_vertices, 0), points_(t.num_vertices), equations_(t.num_vertices) {
  std::vector<uint8_t> on_border(t.num_vertices, 0);
  std::vector<std::pair<uint32_t, uint32_t>> neighbors, flaps;
  for (uint32_t e = 0; e < t.num_edges(); ++e) {
    const auto [a, b] = t.edges[e];
    neighbors.emplace_back(a, b);
    neighbors.emplace_back(b, a);
    if (t.is_border(e)) {
      on_border[a] = on_border[b] = 1;
      continue;
    }
    for (const uint32_t v : {a, b}) flaps.emplace_back(v, e);
    for (const uint32_t f : t.edge_faces[e]) flaps.emplace_back(OppositeVertex(t, f, e), e);
  }
  Gather(t.num_vertices, neighbors, &first_neighbor_, &neighbors_);
  Gather(t.num_vertices, flaps, &first_flap_, &flaps_);
  turn_.reserve(t.num_vertices);
  for (uint32_t v = 0; v < t.num_vertices; ++v) {
    const uint32_t whole = on_border[v] ? 2 * (uint32_t{t.valence[v]} - 1) : t.valence[v];
    turn_.push_back(kTurns[std::clamp(whole, 2u, 24u) - 2]);
  }
}

uint32_t PositionPredictor::Next() {
  while (!queue_.empty()) {
    const auto [weight, complement] = queue_.top();
    queue_.pop();
    if (!is_known_[~complement] && equations_[~complement].weight == weight) return ~complement;
  }
  while (is_known_[next_in_order_]) ++next_in_order_;
  return next_in_order_;
}

Expectation PositionPredictor::Expect(uint32_t vertex) const {
  Expectation result;
  const Equations& equations = equations_[vertex];
  const auto set = [&](int64_t c, int64_t sum, int64_t count) {
    const int64_t value = DivideRounded(sum, count);
    result.point[static_cast<size_t>(c)] = static_cast<int32_t>(std::clamp<int64_t>(value, -kMaxLatticeValue, kMaxLatticeValue));
  };
  if (equations.num_flaps > 0) {
    result.foresight = Foresight::kFlaps;
    for (int c = 0; c < 3; ++c) set(c, equations.target[static_cast<size_t>(c)], equations.weight);
    result.weight = equations.weight;
    result.normal = ScaledTo(equations.normal, 12);
    return result;
  }
  LatticeVector sum{};
  int64_t count = 0;
  for (const uint32_t u : neighbors(vertex)) {
    if (!is_known_[u]) continue;
    for (size_t c = 0; c < 3; ++c) sum[c] += points_[u][c];
    ++count;
  }
  if (count > 0) {
    result.foresight = Foresight::kNeighbors;
    for (int c = 0; c < 3; ++c) set(c, sum[static_cast<size_t>(c)], count);
  } else if (last_ != kNone) {
    result.point = points_[last_];
  }
  return result;
}

void PositionPredictor::SetPoint(uint32_t vertex, const LatticePoint& point) {
  points_[vertex] = point;
  is_known_[vertex] = 1;
  last_ = vertex;
  for (uint32_t i = first_flap_[vertex]; i < first_flap_[vertex + 1]; ++i) {
    if (++num_known_[flaps_[i]] == 3) UseFlap(flaps_[i], vertex);
  }
  for (const uint32_t u : neighbors(vertex)) {
    if (is_known_[u]) continue;
    Equations& sums = equations_[u];
    if (sums.num_neighbors < 2 * kMostFlaps) {
      for (size_t c = 0; c < 3; ++c) sums.target[c] += kNeighborWeight * point[c];
      sums.weight += kNeighborWeight;
      ++sums.num_neighbors;
    }
    if (sums.num_flaps > 0) queue_.emplace(sums.weight, ~u);
  }
}

void PositionPredictor::UseFlap(uint32_t edge, uint32_t newest) {
  const auto [a, b] = t_.edges[edge];
  const std::array<uint32_t, 4> v = {a, b, OppositeVertex(t_, t_.edge_faces[edge][0], edge),
                                     OppositeVertex(t_, t_.edge_faces[edge][1], edge)};
  size_t unknown = 0;
  while (is_known_[v[unknown]]) ++unknown;
  Equations& sums = equations_[v[unknown]];
  if (sums.num_flaps == kMostFlaps) return;
  ++sums.num_flaps;
  for (int end = 0; end < 2; ++end) {
    // c + d - t * (other end) - (2 - t) * (this end), times 256
    const int64_t t = turn_[v[static_cast<size_t>(end)]];
    std::array<int64_t, 4> coefficient = {-t, -t, 256, 256};
    coefficient[static_cast<size_t>(end)] = t - 512;
    int64_t squares = 0;
    for (const int64_t x : coefficient) squares += x * x;
    const int64_t weight = (int64_t{1} << 24) / squares;  // NOLINT(clang-analyzer-core.DivideZero): 256 is among them
    const int64_t mine = coefficient[unknown];
    for (size_t c = 0; c < 3; ++c) {
      int64_t rest = 0;
      for (size_t i = 0; i < 4; ++i) rest += i == unknown ? 0 : coefficient[i] * points_[v[i]][c];
      sums.target[c] -= weight * mine * rest;
    }
    sums.weight += weight * mine * mine;
  }
  // The three known vertices, counterclockwise seen from outside if a and d are unknown, else clockwise.
  std::array<uint32_t, 3> known{};
  for (size_t i = 0, n = 0; i < 4; ++i) {
    if (i != unknown) known[n++] = v[i];
  }
  const LatticeVector x = Minus(points_[known[1]], points_[known[0]]), y = Minus(points_[known[2]], points_[known[0]]);
  const int64_t sign = unknown == 0 || unknown == 3 ? 1 : -1;
  for (size_t c = 0; c < 3; ++c) {
    const size_t c1 = (c + 1) % 3, c2 = (c + 2) % 3;
    sums.normal[c] += sign * (x[c1] * y[c2] - x[c2] * y[c1]);
  }
  // Neighbors of the newest vertex are put into the queue with all their flaps; across the edge there is none.
  if (unknown >= 2 && newest == v[5 - unknown]) queue_.emplace(sums.weight, ~v[unknown]);
}

}  // namespace lacerta
