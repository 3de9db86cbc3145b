#include "remesh/corners.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lacerta {
namespace {

constexpr double kAlwaysSharp = 75 * 3.14159265358979323846 / 180;
constexpr double kSharper = 1.5;  // than the curve is farther on
constexpr double kClean = 3;      // times the turns at the next vertices: nothing else is near

struct Curve {
  std::vector<uint32_t> vertices;  // without a repeated one where it is closed
  bool closed = false;
};

// The two neighbors of each vertex along its curve; kNone where there are none or more.
struct CurveLinks {
  std::vector<std::array<uint32_t, 2>> next;
  std::vector<uint32_t> degree;
};

CurveLinks LinkCurves(const Topology& topology, const std::vector<uint8_t>& crease) {
  CurveLinks links = {std::vector<std::array<uint32_t, 2>>(topology.num_vertices, {kNone, kNone}),
                      std::vector<uint32_t>(topology.num_vertices, 0)};
  for (uint32_t e = 0; e < topology.num_edges(); ++e) {
    if (!topology.is_border(e) && crease[e] == 0) continue;
    for (int end = 0; end < 2; ++end) {
      const uint32_t v = topology.edges[e][end];
      if (links.degree[v] < 2) links.next[v][links.degree[v]] = topology.edges[e][1 - end];
      ++links.degree[v];
    }
  }
  return links;
}

// The curve through a vertex of two curve edges, up to the nodes at its ends.
Curve CurveThrough(const CurveLinks& links, uint32_t start) {
  Curve curve;
  std::vector<uint32_t> ahead;
  for (const int side : {0, 1}) {
    std::vector<uint32_t>& path = side == 0 ? ahead : curve.vertices;
    uint32_t before = start, at = links.next[start][side];
    while (at != start && links.degree[at] == 2) {
      path.push_back(at);
      const uint32_t next = links.next[at][0] == before ? links.next[at][1] : links.next[at][0];
      before = at;
      at = next;
    }
    if (at == start) {
      curve.closed = true;
      break;
    }
    path.push_back(at);
  }
  std::reverse(curve.vertices.begin(), curve.vertices.end());
  curve.vertices.push_back(start);
  curve.vertices.insert(curve.vertices.end(), ahead.begin(), ahead.end());
  return curve;
}

// Turn in radians at each vertex of the curve between chords of `reach` edges, 0 at open ends.
std::vector<double> Turns(const TriangleMesh& mesh, const Curve& curve, int reach) {
  const int n = static_cast<int>(curve.vertices.size());
  const auto at = [&](int i) {
    i = curve.closed ? (i % n + n) % n : std::clamp(i, 0, n - 1);
    return Vec3Cast<double>(mesh.positions[curve.vertices[static_cast<size_t>(i)]]);
  };
  std::vector<double> turns(curve.vertices.size(), 0.0);
  for (int i = 0; i < n; ++i) {
    const Vec3d a = at(i) - at(i - reach), b = at(i + reach) - at(i);
    turns[static_cast<size_t>(i)] = std::atan2(Norm(Cross(a, b)), Dot(a, b));
  }
  if (!curve.closed) turns.front() = turns.back() = 0;
  return turns;
}

void MarkCorners(const TriangleMesh& mesh, const Curve& curve, double min_turn, std::vector<uint8_t>* corner) {
  const int n = static_cast<int>(curve.vertices.size());
  const int reach = n < 16 ? 1 : n < 32 ? 2 : 4;  // even ones see no zigzag
  const std::vector<double> next_turns = Turns(mesh, curve, 1), turns = Turns(mesh, curve, reach);
  const auto at = [&](const std::vector<double>& values, int i) {
    if (curve.closed) return values[static_cast<size_t>((i % n + n) % n)];
    return i < 0 || i >= n ? 0.0 : values[static_cast<size_t>(i)];
  };
  for (int i = 0; i < n; ++i) {
    const double next_turn = at(next_turns, i), turn = at(turns, i);
    const bool clean =
        next_turn >= min_turn && next_turn >= kClean * std::max(at(next_turns, i - 1), at(next_turns, i + 1));
    bool peak = turn >= min_turn;
    for (int d = 1; d < reach; ++d) peak = peak && turn > at(turns, i - d) && turn >= at(turns, i + d);
    const double farther = std::max(at(turns, i - reach), at(turns, i + reach));
    const bool sharp = peak && (turn >= kAlwaysSharp || turn >= kSharper * farther);
    if (clean || sharp) (*corner)[curve.vertices[static_cast<size_t>(i)]] = 1;
  }
}

}  // namespace

std::vector<uint8_t> FindCorners(const TriangleMesh& mesh, const Topology& topology, const std::vector<uint8_t>& crease,
                                 double min_turn) {
  const CurveLinks links = LinkCurves(topology, crease);
  std::vector<uint8_t> corner(topology.num_vertices, 0), seen(topology.num_vertices, 0);
  for (uint32_t v = 0; v < topology.num_vertices; ++v) {
    if (links.degree[v] != 2 || seen[v] != 0) continue;
    const Curve curve = CurveThrough(links, v);
    for (const uint32_t w : curve.vertices) seen[w] = 1;
    MarkCorners(mesh, curve, min_turn, &corner);
  }
  return corner;
}

}  // namespace lacerta
