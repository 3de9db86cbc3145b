#include "remesh/edge_pairing.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

#include "remesh/edge_corners.h"

namespace lacerta {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kFolded = 0.97 * kPi;  // bends above are a surface that turns back on itself
constexpr double kDisagreement = 4;     // more than any bend: who agrees goes first
constexpr double kHollow = 1e-3;        // decides between pairs that bend alike: the faces of one solid stay together
constexpr int kPartners = 8;            // looked at on either side of straight ahead

struct Leaf {
  double angle;  // of the face around the edge, in [0, 2 pi)
  bool flat;     // no area: the angle means nothing
  bool forward;  // runs from the lower to the higher vertex of the edge
  uint32_t corner;
};

double Wrapped(double angle) {
  const double a = std::fmod(angle, 2 * kPi);
  return a < 0 ? a + 2 * kPi : a;
}

// Sorted by angle around the edge.
std::vector<Leaf> Leaves(const TriangleMesh& mesh, const std::vector<uint8_t>& flipped, Span<const uint32_t> corners) {
  const uint32_t start = StartOfEdge(mesh.triangles, corners[0]), end = EndOfEdge(mesh.triangles, corners[0]);
  const uint32_t low = std::min(start, end), high = std::max(start, end);
  const Vec3d origin = Vec3Cast<double>(mesh.positions[low]);
  const Vec3d axis = Normalized(Vec3Cast<double>(mesh.positions[high]) - origin);
  const int least = std::abs(axis.x) <= std::abs(axis.y) ? (std::abs(axis.x) <= std::abs(axis.z) ? 0 : 2)
                                                         : (std::abs(axis.y) <= std::abs(axis.z) ? 1 : 2);
  Vec3d helper;
  helper[least] = 1;
  const Vec3d u = Normalized(Cross(axis, helper)), v = Cross(axis, u);
  std::vector<Leaf> leaves;
  leaves.reserve(corners.size());
  for (const uint32_t c : corners) {
    const Vec3d w = Vec3Cast<double>(mesh.positions[VertexOf(mesh.triangles, c)]) - origin;
    const double x = Dot(w, u), y = Dot(w, v);
    const bool forward = (StartOfEdge(mesh.triangles, c) == low) != (flipped[c / 3] != 0);
    const bool flat = x * x + y * y <= 1e-20 * SquaredNorm(w);
    leaves.push_back({flat ? 0.0 : Wrapped(std::atan2(y, x)), flat, forward, c});
  }
  std::sort(leaves.begin(), leaves.end(),
            [](const Leaf& a, const Leaf& b) { return std::tie(a.angle, a.corner) < std::tie(b.angle, b.corner); });
  return leaves;
}

// How badly b continues a; nothing where it must not.
std::optional<double> PairCost(const TriangleMesh& mesh, const Leaf& a, const Leaf& b) {
  if (SameVertices(mesh.triangles[a.corner / 3], mesh.triangles[b.corner / 3])) return std::nullopt;
  const double disagreement = a.forward == b.forward ? kDisagreement : 0.0;
  if (a.flat || b.flat) return kPi / 2 + disagreement;
  const double bend = std::abs(Wrapped(a.angle - b.angle) - kPi);
  if (bend > kFolded) return std::nullopt;
  const double inside = a.forward ? Wrapped(a.angle - b.angle) : Wrapped(b.angle - a.angle);
  return bend + disagreement + (disagreement == 0 && inside > kPi ? kHollow : 0.0);
}

}  // namespace

bool SameVertices(const Triangle& a, const Triangle& b) {
  const auto has = [&](uint32_t v) { return v == b[0] || v == b[1] || v == b[2]; };
  return has(a[0]) && has(a[1]) && has(a[2]);
}

std::vector<std::pair<uint32_t, uint32_t>> PairAroundEdge(const TriangleMesh& mesh, const std::vector<uint8_t>& flipped,
                                                          Span<const uint32_t> corners) {
  const std::vector<Leaf> leaves = Leaves(mesh, flipped, corners);
  const int n = static_cast<int>(leaves.size());
  struct Candidate {
    double cost;
    int a, b;
    bool operator<(const Candidate& o) const { return std::tie(cost, a, b) < std::tie(o.cost, o.a, o.b); }
  };
  std::vector<Candidate> candidates;
  for (int i = 0; i < n; ++i) {
    const double straight = Wrapped(leaves[i].angle + kPi);
    const int ahead = static_cast<int>(
        std::lower_bound(leaves.begin(), leaves.end(), straight, [](const Leaf& l, double a) { return l.angle < a; }) -
        leaves.begin());
    for (int step = 0; step < std::min(n, 2 * kPartners); ++step) {
      const int j = ((ahead - kPartners + step) % n + n) % n;
      if (i == j) continue;
      const std::optional<double> cost = PairCost(mesh, leaves[i], leaves[j]);
      if (cost) candidates.push_back({*cost, std::min(i, j), std::max(i, j)});
    }
  }
  std::sort(candidates.begin(), candidates.end());
  std::vector<bool> taken(leaves.size(), false);
  std::vector<std::pair<uint32_t, uint32_t>> pairs;
  for (const Candidate& c : candidates) {
    if (taken[c.a] || taken[c.b]) continue;
    taken[c.a] = taken[c.b] = true;
    pairs.emplace_back(leaves[c.a].corner, leaves[c.b].corner);
  }
  return pairs;
}

}  // namespace lacerta
