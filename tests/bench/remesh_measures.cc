#include "remesh_measures.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "geometry/triangle_tree.h"

namespace lacerta {
namespace {

// Sets of vertices that edges connect.
class Connected {
 public:
  explicit Connected(uint32_t count) : parent_(count) { std::iota(parent_.begin(), parent_.end(), 0u); }
  uint32_t Find(uint32_t v) {
    while (parent_[v] != v) v = parent_[v] = parent_[parent_[v]];
    return v;
  }
  void Connect(uint32_t a, uint32_t b) {
    a = Find(a), b = Find(b);
    parent_[std::max(a, b)] = std::min(a, b);  // the root is the smallest vertex
  }

 private:
  std::vector<uint32_t> parent_;
};

// The edges of a curve as triangles without area, which are segments to TriangleTree.
TriangleMesh Segments(const TriangleMesh& mesh, const Topology& topology, Curve kind) {
  TriangleMesh segments{mesh.positions, {}};
  for (uint32_t e = 0; e < topology.num_edges(); ++e) {
    const bool chosen = kind == Curve::kBorder ? topology.is_border(e) : topology.on_curve[e] && !topology.is_border(e);
    if (chosen) segments.triangles.push_back({topology.edges[e][0], topology.edges[e][1], topology.edges[e][1]});
  }
  return segments;
}

OneSidedDistance DistanceToSegments(const TriangleMesh& from, const TriangleMesh& to) {
  constexpr double kSamples = 100'000;
  OneSidedDistance result;
  if (from.triangles.empty()) return result;
  result.rms = result.max = std::numeric_limits<double>::infinity();
  if (to.triangles.empty()) return result;
  double total = 0;
  for (const Triangle& t : from.triangles) total += Norm(from.positions[t[1]] - from.positions[t[0]]);
  const TriangleTree tree(to);
  double sum = 0, length_sum = 0, largest = 0;
  for (const Triangle& t : from.triangles) {
    const Vec3f a = from.positions[t[0]], along = from.positions[t[1]] - a;
    const double length = Norm(along);
    const int count = 1 + static_cast<int>(kSamples * length / total);  // at least one, of its length's weight
    for (int i = 0; i < count; ++i) {
      const float share = (static_cast<float>(i) + 0.5f) / static_cast<float>(count);
      const double squared = tree.ClosestPoint(a + along * share).squared_distance;
      sum += squared * length / count;
      largest = std::max(largest, squared);
    }
    length_sum += length;
  }
  return {length_sum > 0 ? std::sqrt(sum / length_sum) : 0.0, std::sqrt(largest)};
}

}  // namespace

Components FindComponents(const Topology& topology) {
  Connected surface(topology.num_vertices), border(topology.num_vertices);
  std::vector<uint8_t> used(topology.num_vertices, 0), on_border(topology.num_vertices, 0);
  for (uint32_t e = 0; e < topology.num_edges(); ++e) {
    const auto& [a, b] = topology.edges[e];
    surface.Connect(a, b);
    used[a] = used[b] = 1;
    if (!topology.is_border(e)) continue;
    border.Connect(a, b);
    on_border[a] = on_border[b] = 1;
  }
  Components result;
  result.of_vertex.assign(topology.num_vertices, kNone);
  for (uint32_t v = 0; v < topology.num_vertices; ++v) {
    if (!used[v]) continue;
    const uint32_t root = surface.Find(v);
    if (root == v) {
      result.of_vertex[v] = static_cast<uint32_t>(result.shapes.size());
      result.shapes.push_back({});
    }
    result.of_vertex[v] = result.of_vertex[root];
    ComponentShape& shape = result.shapes[result.of_vertex[v]];
    ++shape.euler;
    shape.borders += on_border[v] && border.Find(v) == v;
  }
  for (const auto& edge : topology.edges) --result.shapes[result.of_vertex[edge[0]]].euler;
  for (const Triangle& t : topology.triangles) ++result.shapes[result.of_vertex[t[0]]].euler;
  return result;
}

uint64_t NumChangedComponents(const Components& input, const Topology& level, const std::vector<uint32_t>& input_vertex) {
  const Components now = FindComponents(level);
  std::vector<uint32_t> seen(input.shapes.size(), 0);
  std::vector<uint8_t> counted(now.shapes.size(), 0);
  uint64_t changed = 0;
  for (uint32_t v = 0; v < input_vertex.size(); ++v) {
    const uint32_t c = now.of_vertex[v];
    if (c == kNone || counted[c]) continue;
    counted[c] = 1;
    const uint32_t source = input.of_vertex[input_vertex[v]];
    ++seen[source];
    changed += !(now.shapes[c] == input.shapes[source]);
  }
  return changed + static_cast<uint64_t>(std::count_if(seen.begin(), seen.end(), [](uint32_t n) { return n != 1; }));
}

SurfaceDistance CurveDistance(const TriangleMesh& input, const Topology& input_topology, const TriangleMesh& remesh,
                              const Topology& remesh_topology, Curve kind) {
  const TriangleMesh a = Segments(input, input_topology, kind), b = Segments(remesh, remesh_topology, kind);
  return {DistanceToSegments(a, b), DistanceToSegments(b, a)};
}

ReversedShare MeasureReversed(const InputSurface& input, const TriangleMesh& remesh, const std::vector<Vec3f>& normals) {
  struct Verdict {
    double area = 0;
    bool at_closest = false, confirmed = false;
  };
  std::vector<Verdict> verdicts(remesh.triangles.size());
  tbb::parallel_for(size_t{0}, remesh.triangles.size(), [&](size_t f) {
    const Triangle& t = remesh.triangles[f];
    const Vec3f &a = remesh.positions[t[0]], &b = remesh.positions[t[1]], &c = remesh.positions[t[2]];
    const Vec3f cross = Cross(b - a, c - a), centroid = (a + b + c) * (1.0f / 3);
    const auto agrees = [&](const SurfacePoint& p) {
      const Vec3d weights{p.barycentric[0], p.barycentric[1], p.barycentric[2]};
      return p.face == kNone || Dot(cross, input.NormalAt(p.face, weights)) >= 0;
    };
    Verdict& verdict = verdicts[f];
    verdict.area = Norm(Vec3Cast<double>(cross));
    verdict.at_closest = !agrees(input.tree().ClosestPoint(centroid).point);
    verdict.confirmed = Dot(cross, normals[t[0]] + normals[t[1]] + normals[t[2]]) < 0;
    if (!verdict.at_closest || verdict.confirmed) return;
    const float reach = std::max({Norm(b - a), Norm(c - b), Norm(a - c)});
    std::vector<LineHit> hits;
    input.tree().IntersectLine(centroid, Normalized(cross), -reach, reach, &hits);
    verdict.confirmed = std::none_of(hits.begin(), hits.end(), [&](const LineHit& hit) { return agrees(hit.point); });
  });
  double total = 0;
  ReversedShare share;
  for (const Verdict& v : verdicts) {
    total += v.area;
    if (v.at_closest) share.at_closest += v.area;
    if (v.confirmed) share.confirmed += v.area;
  }
  if (total > 0) share = {share.at_closest / total, share.confirmed / total};
  return share;
}

}  // namespace lacerta
