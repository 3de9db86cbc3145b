#include "remesh/decimate.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <queue>

#include "geometry/bounding_box.h"
#include "remesh/fan_chart.h"
#include "remesh/quadric.h"

namespace lacerta {
namespace {

constexpr double kNotSound = std::numeric_limits<double>::infinity();
// Vertices of more faces are not removed before their neighbors are: the work per vertex is quadratic in its valence.
constexpr size_t kMaxRing = 64;

// The best collapse of one vertex into a neighbor.
struct Candidate {
  double cost = kNotSound;
  int kept = -1;  // index into the ring
};

struct HeapEntry {
  double cost;
  uint32_t vertex;
  bool operator<(const HeapEntry& b) const { return cost > b.cost || (cost == b.cost && vertex > b.vertex); }
};

class Decimator {
 public:
  Decimator(const TriangleMesh& mesh, const Topology& topology, const DecimateOptions& options);
  CollapseHistory Run();

 private:
  Fan FanOf(uint32_t v) const;
  Candidate BestCandidate(uint32_t v, const Fan& fan, const std::vector<Vec2d>& chart) const;  // of a vertex of at most kMaxRing faces
  double LeastCost(uint32_t v, uint32_t kept) const;
  double Cost(uint32_t v, const Fan& fan, const std::vector<Vec2d>& chart, const std::vector<Vec3d>& old_normals, int kept) const;
  bool KeepsTopology(const Fan& fan, int kept) const;
  bool CanLoseAFace(uint32_t v) const;
  void Collapse(uint32_t v, const Fan& fan, const std::vector<Vec2d>& chart, int kept);
  void Push(uint32_t v);

  const DecimateOptions options_;
  std::vector<Vec3d> positions_;
  std::vector<Vec3d> normals_;    // of the input's vertices, unit; zero on curves, where there are several
  std::vector<Quadric> quadrics_;
  std::vector<std::vector<uint32_t>> vertex_faces_;
  std::vector<uint8_t> on_border_;
  std::vector<uint8_t> blocked_;  // no collapse of the vertex was sound when last looked at
  std::priority_queue<HeapEntry> heap_;
  CollapseHistory history_;
  double length_scale_;           // of the mean input edge, squared
  std::vector<double> covered_area_;  // per face of the history: area of the input that it stands for
};

// The plane through a border edge at right angles to its face, weighted by the squared length of the edge.
Quadric BorderQuadric(const Vec3d& a, const Vec3d& b, const Vec3d& opposite) {
  const Vec3d face_normal = Cross(b - a, opposite - a);
  const double norm = Norm(face_normal);
  if (!(norm > 0)) return {};
  return Quadric::OfTriangle(a, b, a + face_normal * (2 * Norm(b - a) / norm));
}

Decimator::Decimator(const TriangleMesh& mesh, const Topology& topology, const DecimateOptions& options)
    : options_(options),
      quadrics_(mesh.positions.size()),
      vertex_faces_(mesh.positions.size()),
      on_border_(mesh.positions.size(), 0),
      blocked_(mesh.positions.size(), 0),
      history_(topology) {
  // Centered and scaled to unit size: quadrics lose their digits far from the origin.
  const BoundingBox box = BoundsOf(mesh.positions);
  const Vec3d low = Vec3Cast<double>(box.low), high = Vec3Cast<double>(box.high);
  const double diagonal = Norm(high - low);
  positions_.reserve(mesh.positions.size());
  for (const Vec3f& p : mesh.positions) positions_.push_back((Vec3Cast<double>(p) - low) * (1 / diagonal) - Vec3d{0.5, 0.5, 0.5});
  double sum = 0;
  normals_.resize(positions_.size());
  for (uint32_t f = 0; f < mesh.triangles.size(); ++f) {
    const Triangle& t = mesh.triangles[f];
    const Vec3d normal = Cross(positions_[t[1]] - positions_[t[0]], positions_[t[2]] - positions_[t[0]]);
    covered_area_.push_back(Norm(normal) / 2);
    const Quadric q = Quadric::OfTriangle(positions_[t[0]], positions_[t[1]], positions_[t[2]]);
    for (int k = 0; k < 3; ++k) {
      normals_[t[k]] += normal;
      quadrics_[t[k]] += q;
      vertex_faces_[t[k]].push_back(f);
      sum += SquaredNorm(positions_[t[k]] - positions_[t[(k + 1) % 3]]);
    }
  }
  for (uint32_t e = 0; e < topology.num_edges(); ++e) {
    const bool is_border = topology.is_border(e);
    if (!is_border && (options.drawn_curves.empty() || options.drawn_curves[e] == 0)) continue;
    const auto& [a, b] = topology.edges[e];
    for (const uint32_t f : topology.edge_faces[e]) {
      if (f == kNone) continue;
      const Quadric q = BorderQuadric(positions_[a], positions_[b], positions_[OppositeVertex(topology, f, e)]);
      for (const uint32_t v : {a, b}) quadrics_[v] += q;
    }
    if (is_border) on_border_[a] = on_border_[b] = 1;
  }
  for (uint32_t v = 0; v < normals_.size(); ++v) {
    normals_[v] = topology.role[v] == CurveRole::kSmooth ? Normalized(normals_[v]) : Vec3d{};
  }
  length_scale_ = sum / (3.0 * static_cast<double>(mesh.triangles.size()));
}

Fan Decimator::FanOf(uint32_t v) const {
  const std::vector<uint32_t>& faces = vertex_faces_[v];
  struct Spoke {
    uint32_t face, first, second;  // (v, first, second)
  };
  std::array<Spoke, kMaxRing> spokes;
  const size_t n = faces.size();
  for (size_t i = 0; i < n; ++i) {
    const Triangle& t = history_.face(faces[i]);
    const int corner = t[0] == v ? 0 : t[1] == v ? 1 : 2;
    spokes[i] = {faces[i], t[(corner + 1) % 3], t[(corner + 2) % 3]};
  }
  size_t at = 0;
  if (on_border_[v]) {  // begin where no face leads to
    for (size_t i = 0; i < n; ++i) {
      const bool is_led_to = std::any_of(spokes.begin(), spokes.begin() + n, [&](const Spoke& s) { return s.second == spokes[i].first; });
      if (!is_led_to) at = i;
    }
  }
  Fan fan;
  fan.ring.reserve(n + 1);
  fan.faces.reserve(n);
  for (size_t i = 0; i < n; ++i) {
    fan.ring.push_back(spokes[at].first);
    fan.faces.push_back(spokes[at].face);
    const uint32_t next = spokes[at].second;
    if (i + 1 == n && on_border_[v]) fan.ring.push_back(next);
    at = static_cast<size_t>(std::find_if(spokes.begin(), spokes.begin() + n, [&](const Spoke& s) { return s.first == next; }) - spokes.begin());
  }
  if (history_.role(v) != CurveRole::kCurve) return fan;
  if (fan.is_open()) {
    fan.curve[0] = 0;
    fan.curve[1] = fan.size() - 1;
    return fan;
  }
  for (int i = 0; i < fan.size(); ++i) {
    const Triangle& t = history_.face(fan.faces[i]);
    const int corner = t[0] == v ? 0 : t[1] == v ? 1 : 2;
    if (history_.is_curve(fan.faces[i], (corner + 2) % 3)) fan.curve[fan.curve[0] < 0 ? 0 : 1] = i;
  }
  return fan;
}

bool Decimator::CanLoseAFace(uint32_t v) const { return vertex_faces_[v].size() > (on_border_[v] ? 1 : 3); }

bool Decimator::KeepsTopology(const Fan& fan, int kept) const {
  const int k = fan.size();
  const uint32_t u = fan.ring[kept];
  // The other vertices of the faces at the edge that goes: two, or one on the border.
  const uint32_t before = fan.is_open() && kept == 0 ? kNone : fan.ring[(kept + k - 1) % k];
  const uint32_t after = fan.is_open() && kept == k - 1 ? kNone : fan.ring[(kept + 1) % k];
  if ((before != kNone && !CanLoseAFace(before)) || (after != kNone && !CanLoseAFace(after))) return false;
  const int gone = fan.is_open() ? 1 : 2;
  const int new_valence = static_cast<int>(vertex_faces_[u].size() + fan.faces.size()) - 2 * gone;
  if (new_valence < (on_border_[u] ? 1 : 3) || new_valence > std::min(options_.max_valence, static_cast<int>(kMaxRing) - 1)) return false;
  for (const uint32_t f : vertex_faces_[u]) {  // link condition: no neighbor in common but those two
    for (const uint32_t w : history_.face(f)) {
      if (w == u || w == before || w == after) continue;
      if (std::find(fan.ring.begin(), fan.ring.end(), w) != fan.ring.end()) return false;
    }
  }
  return true;
}

// What Cost is before its penalties, which are factors of 1 or more.
double Decimator::LeastCost(uint32_t v, uint32_t kept) const {
  Quadric q = quadrics_[v];
  q += quadrics_[kept];
  // The small second term orders flat regions by edge length; relative to the input's scale, it is nothing elsewhere.
  const double edge = SquaredNorm(positions_[kept] - positions_[v]);
  return q.Evaluate(positions_[kept]) + 1e-6 * edge * length_scale_;
}

double Decimator::Cost(uint32_t v, const Fan& fan, const std::vector<Vec2d>& chart, const std::vector<Vec3d>& old_normals,
                       int kept) const {
  const int k = fan.size();
  const uint32_t u = fan.ring[kept];
  double worst_aspect = 1, worst_cosine = 1;
  double new_area = 0;
  for (int i = kept + 1; i < kept + k - 1; ++i) {
    const int a = i % k, b = (i + 1) % k;
    if (DoubledArea(chart[kept], chart[a], chart[b]) < 1e-5) return kNotSound;
    const Vec3d &pu = positions_[u], &pa = positions_[fan.ring[a]], &pb = positions_[fan.ring[b]];
    const Vec3d normal = Cross(pa - pu, pb - pu);
    const double area2 = Norm(normal);
    if (!(area2 > 0) || Dot(normal, old_normals[a]) < options_.min_normal_cosine * area2) return kNotSound;
    new_area += area2 / 2;
    for (const uint32_t w : {u, fan.ring[a], fan.ring[b]}) worst_cosine = std::min(worst_cosine, Dot(normal, normals_[w]) / area2);
    const double edges = SquaredNorm(pa - pu) + SquaredNorm(pb - pu) + SquaredNorm(pb - pa);
    worst_aspect = std::max(worst_aspect, edges / (2 * std::sqrt(3.0) * area2));  // 1 for the equilateral triangle
  }
  const double valence = static_cast<double>(vertex_faces_[u].size() + fan.faces.size()) - 4;
  // A triangle that stands for much more of the input than its own area hides a limb that its samples will miss: quadrics see
  // only how far the limb's sides are away, which is not much, not how long it is (docs/decisions/0004-limbs.md).
  double covered = 0;
  for (const uint32_t f : fan.faces) covered += covered_area_[f];
  const double coverage = std::max(1.0, covered / new_area);
  // Nor is a triangle of much use that faces away from the input at its own corners.
  const double turning_penalty = 1 + 5 * std::max(0.0, -worst_cosine);
  const double valence_penalty = 1 + 0.25 * std::max(0.0, valence - 7);
  return LeastCost(v, u) * worst_aspect * valence_penalty * coverage * coverage * turning_penalty;
}

Candidate Decimator::BestCandidate(uint32_t v, const Fan& fan, const std::vector<Vec2d>& chart) const {
  Candidate best;
  if (!IsStarShaped(chart, fan.faces.size())) return best;
  const int k = fan.size();
  std::vector<Vec3d> old_normals(fan.faces.size());
  for (size_t i = 0; i < old_normals.size(); ++i) {
    old_normals[i] = Normalized(Cross(positions_[fan.ring[i]] - positions_[v], positions_[fan.ring[(i + 1) % k]] - positions_[v]));
  }
  std::array<Candidate, kMaxRing> least;  // by LeastCost, the lowest first, until none can be the best any more
  int count = 0;
  for (int j = 0; j < k; ++j) {
    if (fan.curve[0] >= 0 && j != fan.curve[0] && j != fan.curve[1]) continue;  // along the curve only
    const double cost = LeastCost(v, fan.ring[j]);
    if (std::isfinite(cost)) least[count++] = {cost, j};
  }
  std::sort(least.begin(), least.begin() + count, [](const Candidate& a, const Candidate& b) { return a.cost < b.cost || (a.cost == b.cost && a.kept < b.kept); });
  for (int i = 0; i < count && least[i].cost <= best.cost; ++i) {
    const Candidate candidate{Cost(v, fan, chart, old_normals, least[i].kept), least[i].kept};
    const bool is_better = candidate.cost < best.cost || (candidate.cost == best.cost && candidate.kept < best.kept);
    if (is_better && KeepsTopology(fan, candidate.kept)) best = candidate;  // which takes longer to tell than the cost
  }
  return best;
}

void Decimator::Push(uint32_t v) {
  const bool is_removable = history_.role(v) != CurveRole::kCorner && !vertex_faces_[v].empty() && vertex_faces_[v].size() < kMaxRing;
  Candidate candidate;
  if (is_removable) {
    const Fan fan = FanOf(v);
    candidate = BestCandidate(v, fan, FlattenFan(positions_[v], fan, positions_));
  }
  blocked_[v] = candidate.kept < 0;
  if (!blocked_[v]) heap_.push({candidate.cost, v});
}

void Decimator::Collapse(uint32_t v, const Fan& fan, const std::vector<Vec2d>& chart, int kept) {
  const uint32_t u = fan.ring[kept];
  const uint32_t first_new = history_.Append(v, fan.ring, chart, fan.faces, kept);
  quadrics_[u] += quadrics_[v];
  // The area that an old face stood for goes to the new faces that take its place in the chart, a third at each of three points.
  covered_area_.resize(history_.num_faces(), 0.0);
  for (const uint32_t f : fan.faces) {
    for (int k = 0; k < 3; ++k) {
      Vec3d weights{1.0 / 6, 1.0 / 6, 1.0 / 6};
      weights[k] = 4.0 / 6;
      covered_area_[history_.Forward({f, weights}, history_.num_collapses()).face] += covered_area_[f] / 3;
    }
    for (const uint32_t w : history_.face(f)) {
      std::vector<uint32_t>& faces = vertex_faces_[w];
      if (w != v) faces.erase(std::find(faces.begin(), faces.end(), f));
    }
  }
  for (uint32_t f = first_new; f < history_.num_faces(); ++f) {
    for (const uint32_t w : history_.face(f)) vertex_faces_[w].push_back(f);
  }
  vertex_faces_[v] = {};
}

// Every vertex that is not blocked stands in the heap once. Its cost there may be out of date: it is computed anew when it
// comes up, and goes back if it has risen meanwhile.
CollapseHistory Decimator::Run() {
  uint32_t remaining = static_cast<uint32_t>(positions_.size());
  for (uint32_t v = 0; v < remaining; ++v) Push(v);
  while (remaining > options_.target_vertices && !heap_.empty()) {
    const HeapEntry entry = heap_.top();
    heap_.pop();
    const uint32_t v = entry.vertex;
    const Fan fan = FanOf(v);
    const std::vector<Vec2d> chart = FlattenFan(positions_[v], fan, positions_);
    const Candidate candidate = BestCandidate(v, fan, chart);
    if (candidate.kept < 0) {
      blocked_[v] = 1;
    } else if (candidate.cost > entry.cost) {
      heap_.push({candidate.cost, v});
    } else {
      Collapse(v, fan, chart, candidate.kept);
      --remaining;
      for (const uint32_t w : fan.ring) {
        if (blocked_[w]) Push(w);
      }
    }
  }
  return std::move(history_);
}

}  // namespace

CollapseHistory Decimate(const TriangleMesh& mesh, const Topology& topology, const DecimateOptions& options) {
  if (mesh.triangles.empty()) return CollapseHistory(topology);
  return Decimator(mesh, topology, options).Run();
}

}  // namespace lacerta
