#include "remesh/crease_graph.h"

#include <algorithm>

namespace lacerta {
namespace {

constexpr size_t kMaxValence = 64;  // of vertices that gaps are closed over: bounds the search around hubs

}  // namespace

CreaseGraph::CreaseGraph(const TriangleMesh& mesh, const Topology& topology)
    : mesh_(mesh),
      topology_(topology),
      begin_(topology.num_vertices + size_t{1}, 0),
      on_border_(topology.num_vertices, 0) {
  for (uint32_t v = 0; v < topology.num_vertices; ++v) begin_[v + 1] = begin_[v] + topology.valence[v];
  incident_.resize(begin_.back());
  std::vector<uint32_t> fill(begin_.begin(), begin_.end() - 1);
  for (uint32_t e = 0; e < topology.num_edges(); ++e) {
    for (const uint32_t v : topology.edges[e]) {
      incident_[fill[v]++] = e;
      if (topology.is_border(e)) on_border_[v] = 1;
    }
  }
}

double CreaseGraph::TurnCosine(uint32_t a, uint32_t b, uint32_t vertex) const {
  const Vec3d at = Vec3Cast<double>(mesh_.positions[vertex]);
  const Vec3d before = Vec3Cast<double>(mesh_.positions[OtherEnd(a, vertex)]);
  const Vec3d after = Vec3Cast<double>(mesh_.positions[OtherEnd(b, vertex)]);
  return Dot(Normalized(at - before), Normalized(after - at));
}

std::vector<uint32_t> CreaseGraph::SelectedDegrees(const std::vector<uint8_t>& selected) const {
  std::vector<uint32_t> degree(topology_.num_vertices, 0);
  for (uint32_t e = 0; e < topology_.num_edges(); ++e) {
    if (selected[e] == 0) continue;
    for (const uint32_t v : topology_.edges[e]) ++degree[v];
  }
  return degree;
}

void CreaseGraph::CloseGaps(const std::vector<double>& bends, double min_bend, double min_cosine,
                            std::vector<uint8_t>* selected) const {
  std::vector<uint32_t> degree = SelectedDegrees(*selected);
  const auto step_is_sound = [&](uint32_t from, uint32_t to, uint32_t v) {
    return (*selected)[to] == 0 && bends[to] >= min_bend && TurnCosine(from, to, v) >= min_cosine;
  };
  const auto add = [&](uint32_t e) {
    (*selected)[e] = 1;
    for (const uint32_t v : topology_.edges[e]) ++degree[v];
  };
  for (uint32_t v = 0; v < topology_.num_vertices; ++v) {
    if (degree[v] != 1 || on_border_[v] || edges_at(v).size() > kMaxValence) continue;
    const Span<const uint32_t> around = edges_at(v);
    const uint32_t last = *std::find_if(around.begin(), around.end(), [&](uint32_t e) { return (*selected)[e] != 0; });
    uint32_t best[2] = {kNone, kNone};
    double best_bend = 0;  // the least of the way
    for (const uint32_t e : around) {
      if (!step_is_sound(last, e, v)) continue;
      const uint32_t w = OtherEnd(e, v);
      if (degree[w] > 0 || on_border_[w]) {  // one edge is better than any two
        if (best[0] == kNone || best[1] != kNone || bends[e] > best_bend) {
          best[0] = e;
          best[1] = kNone;
          best_bend = bends[e];
        }
        continue;
      }
      if ((best[0] != kNone && best[1] == kNone) || edges_at(w).size() > kMaxValence) continue;
      for (const uint32_t second : edges_at(w)) {
        const uint32_t end = OtherEnd(second, w);
        const double bend = std::min(bends[e], bends[second]);
        if (end == v || degree[end] == 0 || bend <= best_bend || !step_is_sound(e, second, w)) continue;
        best[0] = e;
        best[1] = second;
        best_bend = bend;
      }
    }
    for (const uint32_t e : best) {
      if (e != kNone) add(e);
    }
  }
}

void CreaseGraph::DropSpurs(uint32_t min_free, std::vector<uint8_t>* selected) const {
  std::vector<uint32_t> degree = SelectedDegrees(*selected), ends, chain;
  for (uint32_t v = 0; v < topology_.num_vertices; ++v) {
    if (degree[v] == 1 && !on_border_[v]) ends.push_back(v);
  }
  while (!ends.empty()) {
    uint32_t v = ends.back();
    ends.pop_back();
    if (degree[v] != 1) continue;
    // At most min_free steps: longer chains stay.
    chain.clear();
    uint32_t before = kNone;
    do {
      uint32_t next = kNone;
      for (const uint32_t e : edges_at(v)) {
        if ((*selected)[e] != 0 && e != before) next = e;
      }
      chain.push_back(next);
      v = OtherEnd(next, v);
      before = next;
    } while (degree[v] == 2 && !on_border_[v] && chain.size() < min_free);
    if (chain.size() >= min_free) continue;
    for (const uint32_t e : chain) {
      (*selected)[e] = 0;
      for (const uint32_t w : topology_.edges[e]) --degree[w];
    }
    if (degree[v] == 1 && !on_border_[v]) ends.push_back(v);
  }
}

void CreaseGraph::DropSmall(uint32_t min_open, uint32_t min_closed, std::vector<uint8_t>* selected) const {
  std::vector<uint8_t> seen(topology_.num_edges(), 0), visited(topology_.num_vertices, 0);
  const std::vector<uint32_t> degree = SelectedDegrees(*selected);
  std::vector<uint32_t> network;
  for (uint32_t seed = 0; seed < topology_.num_edges(); ++seed) {
    if ((*selected)[seed] == 0 || seen[seed] != 0) continue;
    network.assign(1, seed);
    seen[seed] = 1;
    bool open = false;
    for (size_t i = 0; i < network.size(); ++i) {
      for (const uint32_t v : topology_.edges[network[i]]) {
        if (visited[v]) continue;
        visited[v] = 1;
        open = open || (degree[v] == 1 && !on_border_[v]);
        for (const uint32_t e : edges_at(v)) {
          if ((*selected)[e] == 0 || seen[e] != 0) continue;
          seen[e] = 1;
          network.push_back(e);
        }
      }
    }
    if (network.size() >= (open ? min_open : min_closed)) continue;
    for (const uint32_t e : network) (*selected)[e] = 0;
  }
}

}  // namespace lacerta
