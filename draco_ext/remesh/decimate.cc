#include "remesh/decimate.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

#include "remesh/quadric.h"

namespace lacerta {
namespace {

constexpr double kNotSound = std::numeric_limits<double>::infinity();
constexpr double kPi = 3.14159265358979323846;
// Vertices of more faces are not removed before their neighbors are: the work per vertex is quadratic in its valence.
constexpr size_t kMaxRing = 64;
// Twice the area of an old face in its chart, whose radius is 1: below, points would not come back where they were.
constexpr double kLeastChartArea = 1e-9;

// The fan of faces around one vertex. ring[i] are its neighbors counterclockwise; faces[i] = (v, ring[i], ring[i+1]).
struct Fan {
  std::vector<uint32_t> ring;
  std::vector<uint32_t> faces;
};

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
  Decimator(const TriangleMesh& mesh, const DecimateOptions& options);
  CollapseHistory Run();

 private:
  Fan FanOf(uint32_t v) const;
  Candidate BestCandidate(uint32_t v, const Fan& fan) const;  // of a vertex of at most kMaxRing faces
  double Cost(uint32_t v, const Fan& fan, const std::vector<Vec2d>& chart, const std::vector<Vec3d>& old_normals, int kept) const;
  bool KeepsTopology(const Fan& fan, int kept) const;
  void Collapse(uint32_t v, const Fan& fan, int kept);
  void Push(uint32_t v);

  const DecimateOptions options_;
  std::vector<Vec3d> positions_;
  std::vector<Quadric> quadrics_;
  std::vector<std::vector<uint32_t>> vertex_faces_;
  std::vector<uint8_t> blocked_;  // no collapse of the vertex was sound when last looked at
  std::priority_queue<HeapEntry> heap_;
  CollapseHistory history_;
  double length_scale_;           // of the mean input edge, squared
  std::vector<double> covered_area_;  // per face of the history: area of the input that it stands for
};

Decimator::Decimator(const TriangleMesh& mesh, const DecimateOptions& options)
    : options_(options),
      quadrics_(mesh.positions.size()),
      vertex_faces_(mesh.positions.size()),
      blocked_(mesh.positions.size(), 0),
      history_(mesh) {
  // Centered and scaled to unit size: quadrics lose their digits far from the origin.
  Vec3d low = Vec3Cast<double>(mesh.positions[0]), high = low;
  for (const Vec3f& p : mesh.positions) {
    for (int c = 0; c < 3; ++c) {
      low[c] = std::min(low[c], double{p[c]});
      high[c] = std::max(high[c], double{p[c]});
    }
  }
  const double diagonal = Norm(high - low);
  positions_.reserve(mesh.positions.size());
  for (const Vec3f& p : mesh.positions) positions_.push_back((Vec3Cast<double>(p) - low) * (1 / diagonal) - Vec3d{0.5, 0.5, 0.5});
  double sum = 0;
  for (uint32_t f = 0; f < mesh.triangles.size(); ++f) {
    const Triangle& t = mesh.triangles[f];
    covered_area_.push_back(Norm(Cross(positions_[t[1]] - positions_[t[0]], positions_[t[2]] - positions_[t[0]])) / 2);
    const Quadric q = Quadric::OfTriangle(positions_[t[0]], positions_[t[1]], positions_[t[2]]);
    for (int k = 0; k < 3; ++k) {
      quadrics_[t[k]] += q;
      vertex_faces_[t[k]].push_back(f);
      sum += SquaredNorm(positions_[t[k]] - positions_[t[(k + 1) % 3]]);
    }
  }
  length_scale_ = sum / (3.0 * static_cast<double>(mesh.triangles.size()));
}

Fan Decimator::FanOf(uint32_t v) const {
  const std::vector<uint32_t>& faces = vertex_faces_[v];
  Fan fan;
  fan.ring.reserve(faces.size());
  fan.faces.reserve(faces.size());
  uint32_t face = faces[0];
  for (size_t n = 0; n < faces.size(); ++n) {
    const Triangle& t = history_.face(face);
    const int corner = t[0] == v ? 0 : t[1] == v ? 1 : 2;
    const uint32_t next = t[(corner + 2) % 3];
    fan.ring.push_back(t[(corner + 1) % 3]);
    fan.faces.push_back(face);
    for (const uint32_t f : faces) {  // the face that continues at `next`
      const Triangle& s = history_.face(f);
      const int c = s[0] == v ? 0 : s[1] == v ? 1 : 2;
      if (s[(c + 1) % 3] == next) {
        face = f;
        break;
      }
    }
  }
  return fan;
}

// The ring flattened around v at the origin by the conformal map z^a of [Duchamp et al. 1997]: angles scaled to 2 pi.
std::vector<Vec2d> FlattenFan(const Vec3d& center, const Fan& fan, const std::vector<Vec3d>& positions) {
  const size_t k = fan.ring.size();
  std::vector<double> angle(k), radius(k);
  double total = 0;
  for (size_t i = 0; i < k; ++i) {
    const Vec3d a = positions[fan.ring[i]] - center, b = positions[fan.ring[(i + 1) % k]] - center;
    radius[i] = Norm(a);
    angle[i] = std::atan2(Norm(Cross(a, b)), Dot(a, b));
    angle[i] = std::max(angle[i], 1e-4);
    total += angle[i];
  }
  const double exponent = 2 * kPi / total;
  const double scale = *std::max_element(radius.begin(), radius.end());
  std::vector<Vec2d> chart(k);
  double theta = 0;
  for (size_t i = 0; i < k; ++i) {
    const double r = std::pow(std::max(radius[i] / scale, 1e-6), exponent);
    chart[i] = {r * std::cos(theta), r * std::sin(theta)};
    theta += angle[i] * exponent;
  }
  return chart;
}

double Orientation(const Vec2d& a, const Vec2d& b, const Vec2d& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

// Whether every face of the fan has area in the chart. An angle is at most the sum of the others, so flattening opens it to 180
// degrees at most, which it does at a vertex in the plane of its ring but outside of it.
bool IsStarShaped(const std::vector<Vec2d>& chart) {
  for (size_t i = 0; i < chart.size(); ++i) {
    if (!(Orientation(Vec2d{}, chart[i], chart[(i + 1) % chart.size()]) > kLeastChartArea)) return false;
  }
  return true;
}

bool Decimator::KeepsTopology(const Fan& fan, int kept) const {
  const int k = static_cast<int>(fan.ring.size());
  const uint32_t u = fan.ring[kept], before = fan.ring[(kept + k - 1) % k], after = fan.ring[(kept + 1) % k];
  if (vertex_faces_[before].size() <= 3 || vertex_faces_[after].size() <= 3) return false;
  const int new_valence = static_cast<int>(vertex_faces_[u].size()) + k - 4;
  if (new_valence < 3 || new_valence > std::min(options_.max_valence, static_cast<int>(kMaxRing))) return false;
  for (const uint32_t f : vertex_faces_[u]) {  // link condition: no neighbor in common but those two
    for (const uint32_t w : history_.face(f)) {
      if (w == u || w == before || w == after) continue;
      if (std::find(fan.ring.begin(), fan.ring.end(), w) != fan.ring.end()) return false;
    }
  }
  return true;
}

double Decimator::Cost(uint32_t v, const Fan& fan, const std::vector<Vec2d>& chart, const std::vector<Vec3d>& old_normals,
                       int kept) const {
  const int k = static_cast<int>(fan.ring.size());
  const uint32_t u = fan.ring[kept];
  double worst_aspect = 1;
  double new_area = 0;
  for (int i = kept + 1; i < kept + k - 1; ++i) {
    const int a = i % k, b = (i + 1) % k;
    if (Orientation(chart[kept], chart[a], chart[b]) < 1e-5) return kNotSound;
    const Vec3d &pu = positions_[u], &pa = positions_[fan.ring[a]], &pb = positions_[fan.ring[b]];
    const Vec3d normal = Cross(pa - pu, pb - pu);
    const double area2 = Norm(normal);
    if (!(area2 > 0) || Dot(normal, old_normals[a]) < options_.min_normal_cosine * area2) return kNotSound;
    new_area += area2 / 2;
    const double edges = SquaredNorm(pa - pu) + SquaredNorm(pb - pu) + SquaredNorm(pb - pa);
    worst_aspect = std::max(worst_aspect, edges / (2 * std::sqrt(3.0) * area2));  // 1 for the equilateral triangle
  }
  if (!KeepsTopology(fan, kept)) return kNotSound;
  Quadric q = quadrics_[v];
  q += quadrics_[u];
  const double valence = static_cast<double>(vertex_faces_[u].size()) + k - 4;
  // A triangle that stands for much more of the input than its own area hides a limb that its samples will miss: quadrics see
  // only how far the limb's sides are away, which is not much, not how long it is (docs/decisions/0004-limbs.md).
  double covered = 0;
  for (const uint32_t f : fan.faces) covered += covered_area_[f];
  const double coverage = std::max(1.0, covered / new_area);
  const double valence_penalty = 1 + 0.25 * std::max(0.0, valence - 7);
  // The small second term orders flat regions by edge length; relative to the input's scale, it is nothing elsewhere.
  const double edge = SquaredNorm(positions_[u] - positions_[v]);
  return (q.Evaluate(positions_[u]) + 1e-6 * edge * length_scale_) * worst_aspect * valence_penalty * coverage * coverage;
}

Candidate Decimator::BestCandidate(uint32_t v, const Fan& fan) const {
  const int k = static_cast<int>(fan.ring.size());
  std::vector<Vec3d> old_normals(k);
  for (int i = 0; i < k; ++i) {
    old_normals[i] = Normalized(Cross(positions_[fan.ring[i]] - positions_[v], positions_[fan.ring[(i + 1) % k]] - positions_[v]));
  }
  const std::vector<Vec2d> chart = FlattenFan(positions_[v], fan, positions_);
  Candidate best;
  if (!IsStarShaped(chart)) return best;
  for (int j = 0; j < k; ++j) {
    const double cost = Cost(v, fan, chart, old_normals, j);
    if (cost < best.cost) best = {cost, j};
  }
  return best;
}

void Decimator::Push(uint32_t v) {
  const Candidate candidate = vertex_faces_[v].size() <= kMaxRing ? BestCandidate(v, FanOf(v)) : Candidate();
  blocked_[v] = candidate.kept < 0;
  if (!blocked_[v]) heap_.push({candidate.cost, v});
}

void Decimator::Collapse(uint32_t v, const Fan& fan, int kept) {
  const int k = static_cast<int>(fan.ring.size());
  const uint32_t u = fan.ring[kept];
  const uint32_t first_new = history_.Append(v, fan.ring, FlattenFan(positions_[v], fan, positions_), fan.faces, kept);
  quadrics_[u] += quadrics_[v];
  for (int i = 0; i < k; ++i) {
    std::vector<uint32_t>& faces = vertex_faces_[fan.ring[i]];
    const uint32_t before = fan.faces[(i + k - 1) % k], after = fan.faces[i];
    faces.erase(std::remove_if(faces.begin(), faces.end(), [&](uint32_t f) { return f == before || f == after; }), faces.end());
  }
  double covered = 0, new_area = 0;
  for (const uint32_t f : fan.faces) covered += covered_area_[f];
  for (uint32_t f = first_new; f < first_new + static_cast<uint32_t>(k - 2); ++f) {
    const Triangle& t = history_.face(f);
    for (const uint32_t w : t) vertex_faces_[w].push_back(f);
    covered_area_.push_back(Norm(Cross(positions_[t[1]] - positions_[t[0]], positions_[t[2]] - positions_[t[0]])) / 2);
    new_area += covered_area_.back();
  }
  for (uint32_t f = first_new; f < covered_area_.size(); ++f) covered_area_[f] *= covered / new_area;
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
    const Candidate candidate = BestCandidate(v, fan);
    if (candidate.kept < 0) {
      blocked_[v] = 1;
    } else if (candidate.cost > entry.cost) {
      heap_.push({candidate.cost, v});
    } else {
      Collapse(v, fan, candidate.kept);
      --remaining;
      for (const uint32_t w : fan.ring) {
        if (blocked_[w]) Push(w);
      }
    }
  }
  return std::move(history_);
}

}  // namespace

CollapseHistory Decimate(const TriangleMesh& mesh, const DecimateOptions& options) {
  if (mesh.triangles.empty()) return CollapseHistory(mesh);
  return Decimator(mesh, options).Run();
}

}  // namespace lacerta
