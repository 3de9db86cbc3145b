#include "remesh/simplify.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "geometry/bounding_box.h"
#include "remesh/collapse_queue.h"
#include "remesh/corner_rings.h"
#include "remesh/deviation_bound.h"
#include "remesh/folds.h"
#include "remesh/placement.h"
#include "remesh/quadric.h"

namespace lacerta {
namespace {

constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();
// Vertices of more triangles stand still: the work of a collapse grows with them.
constexpr uint32_t kMaxRing = 128;
// Of the plane through a border edge that holds the border in place; a triangle's plane weighs its area. The surface lost
// behind a border that gives way is as narrow as the error, so that the border counts for less than the surface.
constexpr double kBorderWeight = 0.1;
// What counts of the planes of the input that a vertex stands for, beside those of its triangles as they are now. Without it thin parts
// would shrink step by step, each of which is small; with all of it vertices are held to what is long gone.
constexpr double kRemembered = 0.1;

struct EdgeCandidate {
  float cost;
  uint32_t u, v;
  uint32_t version;    // of both ends; when an end has changed since, the entry is void
  bool operator<(const EdgeCandidate& b) const {  // for a heap with the cheapest on top
    if (cost != b.cost) return cost > b.cost;
    return u != b.u ? u > b.u : v > b.v;
  }
};

enum class Effect { kKeepsTopology, kPinches, kForbidden };

// What a collapse that changes the topology costs more. Handles and gaps as small as the error have to go, or the mesh would never
// get small; the quadrics tell how small they are, but not of everything that gets lost.
constexpr double kPinchPenalty = 4;
// What it costs to lay triangles on their neighbors: of a needle, whose plane says nothing, a web is drawn at no cost in quadrics. How far
// the web is from the surface is not known, but no farther than the length of the edge: about a fifth of it.
constexpr double kFoldPenalty = 0.2;

}  // namespace

class Simplifier {
 public:
  Simplifier(const TriangleMesh& mesh, const SimplificationOptions& options, SimplificationSequence* sequence);
  void Run();

 private:
  void RememberPlanes();
  void ClassifyEdges();
  Quadric QuadricOf(uint32_t v);
  Placement Place(uint32_t u, uint32_t v, const Quadric& quadric) const;
  void Push(uint32_t u, uint32_t v);
  void PushAround(uint32_t v);
  std::vector<uint32_t> TrianglesOf(uint32_t v);
  Effect EffectOf(uint32_t u, uint32_t v, const std::vector<uint32_t>& around_u, const std::vector<uint32_t>& around_v);
  Vec3d InModel(const Vec3d& p) const { return p * scale_ + center_; }
  bool IsHeld(uint32_t v) const { return !held_.empty() && held_[v] != 0; }
  bool IsNearHeld(const std::vector<uint32_t>& around) const;
  bool LosesHeld(uint32_t u, uint32_t v, const std::vector<uint32_t>& around_u) const;
  void RemoveCoincident(uint32_t v);
  void Kill(uint32_t triangle);
  void AddSpokes(uint32_t moved, uint32_t other, const Vec3d& to, const std::vector<uint32_t>& around);
  double NewFolds(uint32_t u, uint32_t v, const Vec3d& to, const std::vector<uint32_t>& around_u, const std::vector<uint32_t>& around_v);
  void AddFaces(uint32_t moved, uint32_t other, const std::vector<uint32_t>& around, bool with_shared);
  bool StaysNear(uint32_t u, uint32_t v, const Vec3d& to, const std::vector<uint32_t>& around_u, const std::vector<uint32_t>& around_v);
  bool AnyTurnsOver(uint32_t moved, uint32_t other, const Vec3d& to, const std::vector<uint32_t>& around) const;
  void Collapse(uint32_t kept, uint32_t removed, const Vec3d& position, const std::vector<uint32_t>& around_removed, bool pinched);
  uint32_t NextMark();

  SimplificationSequence* const sequence_;
  const std::vector<uint8_t>& held_;
  const uint32_t fewest_triangles_;
  Vec3d center_;
  double scale_ = 1;
  std::vector<Vec3d> positions_;  // centered and scaled to unit size: quadrics lose their digits far from the origin
  std::vector<Triangle> triangles_;
  std::vector<uint8_t> dead_;  // per triangle
  std::vector<Quadric> remembered_;  // per vertex: planes of the input, of all vertices that came together in it
  std::vector<Quadric> quadrics_;    // per vertex: QuadricOf
  CornerRings rings_;
  std::vector<uint32_t> version_, mark_;
  std::vector<uint32_t> valence_;  // living triangles of each vertex
  std::vector<uint8_t> on_border_;  // per vertex: of an edge that has not two triangles
  uint32_t last_mark_ = 0;
  uint32_t num_alive_ = 0;
  double edge_weight_ = 0;
  CollapseQueue<EdgeCandidate> queue_;
  std::vector<uint32_t> ring_;    // corners of the vertex that is looked at
  std::vector<uint32_t> killed_;  // triangles, by the collapse that is made
  FoldedSpokes spokes_;
  std::optional<DeviationBound> deviation_;  // in model units
  std::vector<DeviationBound::Face> faces_;  // of the collapse that is looked at
};

Simplifier::Simplifier(const TriangleMesh& mesh, const SimplificationOptions& options, SimplificationSequence* sequence)
    : sequence_(sequence),
      held_(options.held),
      fewest_triangles_(options.fewest_triangles),
      triangles_(mesh.triangles),
      dead_(mesh.triangles.size(), 0),
      remembered_(mesh.positions.size()),
      quadrics_(mesh.positions.size()),
      rings_(mesh.positions.size(), mesh.triangles),
      version_(mesh.positions.size(), 0),
      mark_(mesh.positions.size(), 0),
      valence_(mesh.positions.size(), 0),
      on_border_(mesh.positions.size(), 0),
      num_alive_(static_cast<uint32_t>(mesh.triangles.size())),
      queue_(num_alive_) {
  const BoundingBox box = BoundsOf(mesh.positions);
  const Vec3d low = Vec3Cast<double>(box.low), high = Vec3Cast<double>(box.high);
  const double diagonal = Norm(high - low);
  center_ = (low + high) * 0.5;
  if (diagonal > 0) scale_ = diagonal;
  positions_.reserve(mesh.positions.size());
  for (const Vec3f& p : mesh.positions) positions_.push_back((Vec3Cast<double>(p) - center_) * (1 / scale_));
  double area = 0;
  for (const Triangle& t : triangles_) {
    area += Norm(Cross(positions_[t[1]] - positions_[t[0]], positions_[t[2]] - positions_[t[0]])) / 2;
    for (const uint32_t v : t) ++valence_[v];
  }
  // Orders flat regions by edge length; elsewhere it is nothing.
  edge_weight_ = 1e-9 * area / static_cast<double>(triangles_.size());
  if (options.original) deviation_.emplace(options.original, mesh);
}

void Simplifier::RememberPlanes() {
  for (uint32_t v = 0; v < remembered_.size(); ++v) {
    remembered_[v] = QuadricOf(v);
    remembered_[v] *= kRemembered;
    quadrics_[v] = QuadricOf(v);
  }
}

void Simplifier::ClassifyEdges() {
  struct Side {
    uint32_t low, high;
    bool operator<(const Side& b) const { return low != b.low ? low < b.low : high < b.high; }
  };
  std::vector<Side> sides;
  sides.reserve(3 * triangles_.size());
  for (uint32_t corner = 0; corner < 3 * triangles_.size(); ++corner) {
    const Triangle& t = triangles_[corner / 3];
    const uint32_t a = t[(corner + 1) % 3], b = t[(corner + 2) % 3];
    sides.push_back({std::min(a, b), std::max(a, b)});
  }
  std::sort(sides.begin(), sides.end());
  for (size_t i = 0; i < sides.size();) {
    size_t end = i + 1;
    while (end < sides.size() && sides[end].low == sides[i].low && sides[end].high == sides[i].high) ++end;
    const uint32_t u = sides[i].low, v = sides[i].high;
    if (end - i != 2) on_border_[u] = on_border_[v] = 1;
    i = end;
  }
  for (size_t i = 0; i < sides.size(); ++i) {
    if (i == 0 || sides[i - 1] < sides[i]) Push(sides[i].low, sides[i].high);
  }
}

// The planes of the triangles and of the border edges that v has now, and what is remembered of the input's.
Quadric Simplifier::QuadricOf(uint32_t v) {
  Quadric q = remembered_[v];
  rings_.Collect(v, dead_, &ring_);
  const uint32_t once = NextMark(), again = NextMark();
  for (const uint32_t corner : ring_) {
    const Triangle& t = triangles_[corner / 3];
    q += Quadric::OfTriangle(positions_[t[0]], positions_[t[1]], positions_[t[2]]);
    for (const uint32_t w : t) mark_[w] = mark_[w] == once || mark_[w] == again ? again : once;
  }
  for (const uint32_t corner : ring_) {
    const Triangle& t = triangles_[corner / 3];
    const uint32_t next = t[(corner + 1) % 3], previous = t[(corner + 2) % 3];
    if (mark_[next] == once) q += Quadric::OfBorder(positions_[v], positions_[next], positions_[previous], kBorderWeight);
    if (mark_[previous] == once) q += Quadric::OfBorder(positions_[v], positions_[previous], positions_[next], kBorderWeight);
  }
  return q;
}

// quadric: of both.
Placement Simplifier::Place(uint32_t u, uint32_t v, const Quadric& quadric) const {
  const bool is_free = !IsHeld(u) && !IsHeld(v);
  const Vec3d& fixed = positions_[IsHeld(u) ? u : v];
  Placement best = is_free ? PlaceBetween(quadric, positions_[u], positions_[v]) : Placement{quadric.Evaluate(fixed), fixed};
  best.cost += edge_weight_ * SquaredNorm(positions_[u] - positions_[v]);
  return best;
}

void Simplifier::Push(uint32_t u, uint32_t v) {
  if (IsHeld(u) && IsHeld(v)) return;
  if (valence_[u] + valence_[v] > kMaxRing) {
    queue_.Block({0, std::min(u, v), std::max(u, v), version_[u] + version_[v]});
    return;
  }
  Quadric q = quadrics_[v];
  q += quadrics_[u];
  if (u > v) std::swap(u, v);
  queue_.Push({static_cast<float>(Place(u, v, q).cost), u, v, version_[u] + version_[v]});
}

uint32_t Simplifier::NextMark() { return ++last_mark_; }

// The living triangles of v; forgets the corners of the others.
std::vector<uint32_t> Simplifier::TrianglesOf(uint32_t v) {
  std::vector<uint32_t> result;
  rings_.Collect(v, dead_, &result);
  for (uint32_t& corner : result) corner /= 3;
  return result;
}

void Simplifier::PushAround(uint32_t v) {
  std::vector<uint32_t> neighbors;
  const uint32_t mark = NextMark();
  mark_[v] = mark;
  for (const uint32_t t : TrianglesOf(v)) {
    for (const uint32_t w : triangles_[t]) {
      if (mark_[w] != mark) neighbors.push_back(w);
      mark_[w] = mark;
    }
  }
  std::vector<uint32_t> changed = neighbors;
  changed.push_back(v);
  for (const uint32_t t : killed_) {
    for (const uint32_t w : triangles_[t]) {  // where surfaces meet at a point it may be no neighbor any more
      if (mark_[w] != mark) changed.push_back(w);
    }
  }
  killed_.clear();
  for (const uint32_t w : changed) {
    if (valence_[w] <= kMaxRing) quadrics_[w] = QuadricOf(w);  // of others nobody asks for it
  }
  for (const uint32_t w : neighbors) Push(v, w);
}

// The topology is kept under the link condition: u and v have no neighbours in common but those across their edge, and no two
// triangles become one. Two borders may meet only along a border.
Effect Simplifier::EffectOf(uint32_t u, uint32_t v, const std::vector<uint32_t>& around_u, const std::vector<uint32_t>& around_v) {
  const uint32_t near_u = NextMark(), across = NextMark();
  size_t num_shared = 0;
  bool pinches = false;
  for (const uint32_t t : around_u) {
    for (const uint32_t w : triangles_[t]) mark_[w] = near_u;
  }
  for (const uint32_t t : around_u) {
    const Triangle& c = triangles_[t];
    if (c[0] != v && c[1] != v && c[2] != v) continue;
    ++num_shared;
    for (const uint32_t w : c) {
      if (w == u || w == v) continue;
      if (mark_[w] == across) pinches = true;  // two triangles on the same three vertices
      mark_[w] = across;
    }
  }
  const bool only_shared_u = num_shared == around_u.size(), only_shared_v = num_shared == around_v.size();
  // A component keeps its last triangles: how far they are from the others is not known here.
  if (num_shared == 0 || (only_shared_u && only_shared_v)) return Effect::kForbidden;
  if (only_shared_u || only_shared_v) pinches = true;
  if (on_border_[u] && on_border_[v] && num_shared == 2) pinches = true;
  for (const uint32_t t : around_v) {
    const Triangle& c = triangles_[t];
    if (c[0] == u || c[1] == u || c[2] == u) continue;
    int num_across = 0;
    for (const uint32_t w : c) {
      if (w == v) continue;
      if (mark_[w] == near_u) pinches = true;
      num_across += mark_[w] == across;
    }
    if (num_across == 2) pinches = true;
  }
  return pinches ? Effect::kPinches : Effect::kKeepsTopology;
}

bool Simplifier::IsNearHeld(const std::vector<uint32_t>& around) const {
  return !held_.empty() && std::any_of(around.begin(), around.end(), [&](uint32_t t) {
    return std::any_of(triangles_[t].begin(), triangles_[t].end(), [&](uint32_t w) { return IsHeld(w); });
  });
}

// Whether a vertex across the edge is held and has no triangle but those that the collapse takes away.
bool Simplifier::LosesHeld(uint32_t u, uint32_t v, const std::vector<uint32_t>& around_u) const {
  return !held_.empty() && std::any_of(around_u.begin(), around_u.end(), [&](uint32_t t) {
    const Triangle& c = triangles_[t];
    if (c[0] != v && c[1] != v && c[2] != v) return false;
    return std::any_of(c.begin(), c.end(), [&](uint32_t w) { return w != u && w != v && IsHeld(w) && valence_[w] == 1; });
  });
}

// Of triangles around v on the same three vertices one stays, whichever way they look.
void Simplifier::RemoveCoincident(uint32_t v) {
  struct Seen {
    std::array<uint32_t, 2> others;  // vertices
    uint32_t triangle;
  };
  std::vector<Seen> seen;
  for (const uint32_t t : TrianglesOf(v)) {
    std::array<uint32_t, 2> others{};
    size_t count = 0;
    for (const uint32_t w : triangles_[t]) {
      if (w != v && count < 2) others[count++] = w;
    }
    std::sort(others.begin(), others.end());
    const auto same = std::find_if(seen.begin(), seen.end(), [&](const Seen& s) { return s.others == others; });
    if (same == seen.end()) {
      seen.push_back({others, t});
      continue;
    }
    if (deviation_) deviation_->Give(t, same->triangle);
    Kill(t);
    sequence_->removed_.push_back({t, static_cast<uint32_t>(sequence_->collapses_.size()) + 1});
  }
}

void Simplifier::Kill(uint32_t t) {
  dead_[t] = 1;
  killed_.push_back(t);
  --num_alive_;
  for (const uint32_t v : triangles_[t]) --valence_[v];
}

bool Simplifier::AnyTurnsOver(uint32_t moved, uint32_t other, const Vec3d& to, const std::vector<uint32_t>& around) const {
  return std::any_of(around.begin(), around.end(), [&](uint32_t t) {
    const Triangle& c = triangles_[t];
    if (c[0] == other || c[1] == other || c[2] == other) return false;
    const int k = c[0] == moved ? 0 : c[1] == moved ? 1 : 2;
    return TurnsOver(positions_[moved], to, positions_[c[(k + 1) % 3]], positions_[c[(k + 2) % 3]]);
  });
}

// The triangles of `moved` but for those of `other`, as if it were at `to`.
void Simplifier::AddSpokes(uint32_t moved, uint32_t other, const Vec3d& to, const std::vector<uint32_t>& around) {
  for (const uint32_t t : around) {
    const Triangle& c = triangles_[t];
    if (c[0] == other || c[1] == other || c[2] == other) continue;
    const int k = c[0] == moved ? 0 : c[1] == moved ? 1 : 2;
    const uint32_t next = c[(k + 1) % 3], previous = c[(k + 2) % 3];
    spokes_.Add(next, previous, Cross(positions_[next] - to, positions_[previous] - to));
  }
}

// The area that lies on its neighbors after a collapse and does not before.
double Simplifier::NewFolds(uint32_t u, uint32_t v, const Vec3d& to, const std::vector<uint32_t>& around_u, const std::vector<uint32_t>& around_v) {
  AddSpokes(u, v, to, around_u);
  AddSpokes(v, u, to, around_v);
  const double after = spokes_.TakeArea();
  if (after == 0) return 0;
  AddSpokes(u, kNone, positions_[u], around_u);
  const double before_u = spokes_.TakeArea();
  AddSpokes(v, kNone, positions_[v], around_v);
  return std::max(0.0, after - before_u - spokes_.TakeArea());
}

// The triangles of `moved` but for those of `other` that were added with it, as they are for the bound.
void Simplifier::AddFaces(uint32_t moved, uint32_t other, const std::vector<uint32_t>& around, bool with_shared) {
  for (const uint32_t t : around) {
    const Triangle& c = triangles_[t];
    const bool is_shared = c[0] == other || c[1] == other || c[2] == other;
    if (is_shared && !with_shared) continue;
    const int k = c[0] == moved ? 0 : c[1] == moved ? 1 : 2;
    faces_.push_back({t, !is_shared, InModel(positions_[c[(k + 1) % 3]]), InModel(positions_[c[(k + 2) % 3]])});
  }
}

// Whether no point goes farther than it may.
bool Simplifier::StaysNear(uint32_t u, uint32_t v, const Vec3d& to, const std::vector<uint32_t>& around_u, const std::vector<uint32_t>& around_v) {
  if (!deviation_) return true;
  faces_.clear();
  AddFaces(u, v, around_u, true);
  AddFaces(v, u, around_v, false);
  return deviation_->Allows(InModel(to), faces_);
}

void Simplifier::Collapse(uint32_t kept, uint32_t removed, const Vec3d& position, const std::vector<uint32_t>& around_removed,
                          bool pinched) {
  if (deviation_) deviation_->Accept();
  for (const uint32_t t : around_removed) {
    Triangle& c = triangles_[t];
    if (c[0] == kept || c[1] == kept || c[2] == kept) {
      Kill(t);
    } else {
      std::replace(c.begin(), c.end(), removed, kept);
      ++valence_[kept];
    }
  }
  rings_.Join(kept, removed);
  positions_[kept] = position;
  remembered_[kept] += remembered_[removed];
  on_border_[kept] = on_border_[kept] || on_border_[removed];
  ++version_[kept];
  ++version_[removed];
  if (pinched) RemoveCoincident(kept);
  const Vec3f exact = IsHeld(kept) ? sequence_->positions_[kept] : Vec3Cast<float>(InModel(position));
  sequence_->collapses_.push_back({removed, kept, exact, num_alive_});
  PushAround(kept);
}

void Simplifier::Run() {
  RememberPlanes();
  ClassifyEdges();
  const auto is_void = [this](const EdgeCandidate& e) {
    return e.version != version_[e.u] + version_[e.v] || rings_.is_empty(e.u) || rings_.is_empty(e.v);
  };
  while (num_alive_ > fewest_triangles_) {
    const std::optional<EdgeCandidate> next = queue_.Next(num_alive_, is_void);
    if (!next) break;
    const EdgeCandidate& edge = *next;
    if (valence_[edge.u] + valence_[edge.v] > kMaxRing) {
      queue_.Block(edge);
      continue;
    }
    // Neighbors may have changed since, on which its planes depend, too; and what else it costs is not known before.
    const auto is_dearer = [&](double now) {
      if (static_cast<float>(now) <= edge.cost) return false;
      queue_.Push({static_cast<float>(now), edge.u, edge.v, edge.version});
      return true;
    };
    Quadric quadric = quadrics_[edge.u];
    quadric += quadrics_[edge.v];
    const auto [cost, position] = Place(edge.u, edge.v, quadric);
    if (is_dearer(cost)) continue;
    const std::vector<uint32_t> around_u = TrianglesOf(edge.u), around_v = TrianglesOf(edge.v);
    const Effect effect = EffectOf(edge.u, edge.v, around_u, around_v);
    if (effect == Effect::kForbidden) continue;  // for good: what could change that changes an end, too, which brings the edge again
    const bool pinches = effect == Effect::kPinches;
    if (AnyTurnsOver(edge.u, edge.v, position, around_u) || AnyTurnsOver(edge.v, edge.u, position, around_v) ||
        LosesHeld(edge.u, edge.v, around_u) || (pinches && (IsNearHeld(around_u) || IsNearHeld(around_v)))) {
      queue_.Block(edge);
      continue;
    }
    const double folds = NewFolds(edge.u, edge.v, position, around_u, around_v) * SquaredNorm(positions_[edge.u] - positions_[edge.v]);
    if (is_dearer((pinches ? kPinchPenalty : 1) * cost + kFoldPenalty * folds)) continue;
    if (!StaysNear(edge.u, edge.v, position, around_u, around_v)) {
      queue_.Block(edge);
      continue;
    }
    if (IsHeld(edge.v)) {
      Collapse(edge.v, edge.u, position, around_u, pinches);
    } else {
      Collapse(edge.u, edge.v, position, around_v, pinches);
    }
  }
}

SimplificationSequence::SimplificationSequence(const TriangleMesh& mesh, const SimplificationOptions& options)
    : positions_(mesh.positions), triangles_(mesh.triangles), original_(options.original) {
  if (!mesh.triangles.empty()) Simplifier(mesh, options, this).Run();
}

uint32_t SimplificationSequence::fewest_triangles() const {
  return collapses_.empty() ? num_input_triangles() : collapses_.back().num_triangles;
}

TriangleMesh SimplificationSequence::MeshWith(uint32_t num_triangles) const {
  size_t num_collapses = 0;
  if (num_triangles < num_input_triangles()) {
    const auto enough = std::partition_point(collapses_.begin(), collapses_.end(),
                                             [&](const Collapse& c) { return c.num_triangles > num_triangles; });
    num_collapses = static_cast<size_t>(enough - collapses_.begin()) + (enough != collapses_.end());
  }
  std::vector<Vec3f> positions = positions_;
  for (size_t i = 0; i < num_collapses; ++i) positions[collapses_[i].kept] = collapses_[i].position;
  std::vector<uint32_t> becomes(positions.size());
  for (uint32_t v = 0; v < becomes.size(); ++v) becomes[v] = v;
  for (size_t i = num_collapses; i-- > 0;) becomes[collapses_[i].removed] = becomes[collapses_[i].kept];

  std::vector<bool> is_removed(triangles_.size());
  for (const Removal& removal : removed_) is_removed[removal.triangle] = removal.num_collapses <= num_collapses;

  TriangleMesh result;
  std::vector<uint32_t> number(positions.size(), kNone);
  for (size_t i = 0; i < triangles_.size(); ++i) {
    if (is_removed[i]) continue;
    const Triangle& t = triangles_[i];
    Triangle moved{becomes[t[0]], becomes[t[1]], becomes[t[2]]};
    if (moved[0] == moved[1] || moved[1] == moved[2] || moved[2] == moved[0]) continue;
    for (uint32_t& v : moved) {
      if (number[v] == kNone) {
        number[v] = static_cast<uint32_t>(result.positions.size());
        result.positions.push_back(positions[v]);
      }
      v = number[v];
    }
    result.triangles.push_back(moved);
  }
  return result;
}

}  // namespace lacerta
