#include "remesh/features.h"

#include <algorithm>
#include <cmath>

#include "remesh/bends.h"
#include "remesh/corners.h"
#include "remesh/crease_graph.h"

namespace lacerta {
namespace {

constexpr double kDegree = 3.14159265358979323846 / 180;
constexpr double kSharp = 60 * kDegree;  // a face may have three creases that bend by this

constexpr size_t kMaxValence = 256;  // of a vertex that weak edges are followed through

// How much the surface beside an edge may bend, in bends of the edge: hardly where it could be a facet of a rounded
// edge, and much where it could not. The edges of a cube see each other.
double MaxBendBeside(double bend) {
  const double degrees[] = {20, 40, 60, 80}, ratios[] = {0.4, 0.8, 1.3, 2.5};
  const double x = bend / kDegree;
  if (x <= degrees[0]) return ratios[0];
  for (int i = 1; i < 4; ++i) {
    if (x > degrees[i]) continue;
    return ratios[i - 1] + (ratios[i] - ratios[i - 1]) * (x - degrees[i - 1]) / (degrees[i] - degrees[i - 1]);
  }
  return ratios[3];
}

// 1 for edges that stand out from the surface beside them.
std::vector<uint8_t> StandOut(const TriangleMesh& mesh, const Topology& topology, const std::vector<double>& bends,
                              double min_bend) {
  std::vector<uint8_t> result(bends.size(), 0);
  for (uint32_t e = 0; e < bends.size(); ++e) {
    result[e] = bends[e] >= min_bend && BendBeside(mesh, topology, bends, e) <= MaxBendBeside(bends[e]) * bends[e];
  }
  return result;
}

// The median over the other edges; 0 where there are none.
double UsualBend(const std::vector<double>& bends, const std::vector<uint8_t>& stand_out) {
  std::vector<double> rest;
  for (size_t e = 0; e < bends.size(); ++e) {
    if (stand_out[e] == 0) rest.push_back(bends[e]);
  }
  if (rest.empty()) return 0;
  const auto at = rest.begin() + static_cast<std::ptrdiff_t>(rest.size() / 2);
  std::nth_element(rest.begin(), at, rest.end());
  return *at;
}

// Strong edges, and weak ones that continue them.
std::vector<uint8_t> Hysteresis(const Topology& topology, const CreaseGraph& graph, const std::vector<double>& bends,
                                const std::vector<uint8_t>& stand_out, double weak, double strong, double min_cosine) {
  std::vector<uint8_t> selected(bends.size(), 0);
  std::vector<uint32_t> stack;
  for (uint32_t e = 0; e < bends.size(); ++e) {
    if (stand_out[e] == 0 || bends[e] < strong) continue;
    selected[e] = 1;
    stack.push_back(e);
  }
  while (!stack.empty()) {
    const uint32_t e = stack.back();
    stack.pop_back();
    for (const uint32_t v : topology.edges[e]) {
      if (graph.edges_at(v).size() > kMaxValence) continue;  // or every crease that ends there would walk around it
      for (const uint32_t next : graph.edges_at(v)) {
        if (selected[next] != 0 || stand_out[next] == 0 || bends[next] < weak) continue;
        if (graph.TurnCosine(e, next, v) < min_cosine) continue;
        selected[next] = 1;
        stack.push_back(next);
      }
    }
  }
  return selected;
}

// Of faces with three creases the one that bends least goes, unless all are sharp.
void OpenFaces(const Topology& topology, const std::vector<double>& bends, std::vector<uint8_t>* selected) {
  for (const auto& fe : topology.face_edges) {
    if (!(*selected)[fe[0]] || !(*selected)[fe[1]] || !(*selected)[fe[2]]) continue;
    const uint32_t least =
        *std::min_element(fe.begin(), fe.end(), [&](uint32_t a, uint32_t b) { return bends[a] < bends[b]; });
    if (bends[least] < kSharp) (*selected)[least] = 0;
  }
}

}  // namespace

Features DetectFeatures(const TriangleMesh& mesh, const Topology& topology, const FeatureOptions& options) {
  const CreaseGraph graph(mesh, topology);
  const std::vector<double> bends = EdgeBends(mesh, topology);
  const std::vector<uint8_t> stand_out = StandOut(mesh, topology, bends, options.weak_bend * kDegree);
  const double usual = UsualBend(bends, stand_out);
  const double weak = std::max(options.weak_bend * kDegree, options.weak_usual * usual);
  const double strong = std::max(options.strong_bend * kDegree, options.strong_usual * usual);
  const double min_cosine = std::cos(options.max_turn * kDegree);

  Features result;
  result.crease = Hysteresis(topology, graph, bends, stand_out, weak, strong, min_cosine);
  graph.CloseGaps(bends, 0.5 * weak, min_cosine, &result.crease);
  OpenFaces(topology, bends, &result.crease);
  graph.DropSpurs(options.min_free, &result.crease);
  const double root = std::sqrt(static_cast<double>(topology.num_edges()));
  graph.DropSmall(static_cast<uint32_t>(std::clamp(root / 10, 3.0, 24.0)),
                  static_cast<uint32_t>(std::clamp(root / 10, 3.0, 12.0)), &result.crease);
  result.corner = FindCorners(mesh, topology, result.crease, options.corner_turn * kDegree);
  return result;
}

}  // namespace lacerta
