#include "remesh/collapse_history.h"

#include <algorithm>
#include <limits>

namespace lacerta {

CollapseHistory::CollapseHistory(const Topology& topology)
    : roles_(topology.role),
      faces_(topology.triangles),
      curve_sides_(topology.num_faces(), 0),
      created_by_(topology.num_faces(), kNone),
      ends_(topology.num_faces()) {
  for (uint32_t f = 0; f < topology.num_faces(); ++f) {
    for (int k = 0; k < 3; ++k) curve_sides_[f] |= static_cast<uint8_t>(topology.on_curve[topology.face_edges[f][k]] << k);
  }
}

uint32_t CollapseHistory::CollapsesTo(uint32_t num_vertices) const {
  const auto num_input = static_cast<uint32_t>(roles_.size());
  return std::min(num_collapses(), num_input - std::min(num_input, num_vertices));
}

uint32_t CollapseHistory::Append(uint32_t removed, const std::vector<uint32_t>& ring, const std::vector<Vec2d>& chart,
                                 const std::vector<uint32_t>& old_faces, int kept) {
  const uint32_t time = num_collapses();
  const uint32_t first_new = num_faces();
  const int k = static_cast<int>(ring.size());
  collapses_.push_back({ring_positions_.size(), first_new, static_cast<uint16_t>(k), static_cast<uint16_t>(old_faces.size()),
                        static_cast<uint16_t>(kept), removed});
  ring_positions_.insert(ring_positions_.end(), chart.begin(), chart.end());
  old_faces_.insert(old_faces_.end(), old_faces.begin(), old_faces.end());
  old_faces_.resize(ring_positions_.size(), kNone);
  // Whether p_i is on a curve with v, and whether the side p_i p_{i+1} of the polygon is on one.
  std::vector<uint8_t> curve_spoke(k, 0), curve_side(k, 0);
  for (int i = 0; i < static_cast<int>(old_faces.size()); ++i) {
    const uint32_t f = old_faces[i];
    const int corner = faces_[f][0] == removed ? 0 : faces_[f][1] == removed ? 1 : 2;
    ends_[f] = {time, static_cast<uint16_t>(i), static_cast<uint8_t>(corner)};
    curve_side[i] = is_curve(f, corner);
    curve_spoke[i] |= static_cast<uint8_t>(is_curve(f, (corner + 2) % 3));
    curve_spoke[(i + 1) % k] |= static_cast<uint8_t>(is_curve(f, (corner + 1) % 3));
  }
  // v was on a curve to p_j and one other neighbor: the edge between them is on it now, the side p_{k-1} p_0 on the border.
  if (curve_spoke[kept]) {
    if (static_cast<int>(old_faces.size()) < k) curve_side[k - 1] = 1;
  } else {
    std::fill(curve_spoke.begin(), curve_spoke.end(), 0);
  }
  for (int m = 0; m < k - 2; ++m) {
    const int a = (kept + 1 + m) % k, b = (kept + 2 + m) % k;
    const bool to_a = m == 0 ? curve_side[kept] : curve_spoke[a];
    const bool to_b = m == k - 3 ? curve_side[b] : curve_spoke[b];
    faces_.push_back({ring[kept], ring[a], ring[b]});
    curve_sides_.push_back(static_cast<uint8_t>(curve_side[a] | to_b << 1 | to_a << 2));
    created_by_.push_back(time);
    ends_.emplace_back();
  }
  return first_new;
}

HistoryCut CollapseHistory::CutWithout(const std::vector<uint32_t>& held, uint32_t time) const {
  HistoryCut cut(time);
  if (held.empty()) return cut;
  cut.held.assign(time, 0);
  for (const uint32_t c : held) {
    if (c < time) cut.held[c] = 1;
  }
  for (uint32_t c = 0; c < time; ++c) {
    const uint32_t* const old = &old_faces_[collapses_[c].first_ring];
    for (int i = 0; i < collapses_[c].num_old_faces; ++i) {
      const uint32_t creator = created_by_[old[i]];
      if (creator != kNone && cut.held[creator] != 0) cut.held[c] = 1;
    }
  }
  std::vector<Triangle> triangles;
  for (const uint32_t f : FacesAt(cut)) triangles.push_back(faces_[f]);
  const bool is_manifold = BuildTopology(static_cast<uint32_t>(roles_.size()), triangles).ok();
  return is_manifold ? cut : HistoryCut(time);
}

std::vector<uint32_t> CollapseHistory::FacesAt(const HistoryCut& cut) const {
  std::vector<uint32_t> alive;
  for (uint32_t f = 0; f < faces_.size(); ++f) {
    const bool born = created_by_[f] == kNone || cut.Has(created_by_[f]);
    if (born && !cut.Has(ends_[f].collapse)) alive.push_back(f);  // kNone is the largest time of all
  }
  return alive;
}

Vec2d CollapseHistory::PlaceInChart(const DomainPoint& point, const End& end) const {
  const Collapse& c = collapses_[end.collapse];
  const Vec2d* ring = &ring_positions_[c.first_ring];
  const double w1 = point.barycentric[(end.corner + 1) % 3], w2 = point.barycentric[(end.corner + 2) % 3];
  const Vec2d &p1 = ring[end.spoke], &p2 = ring[end.spoke + 1 == c.valence ? 0 : end.spoke + 1];
  return {w1 * p1.x + w2 * p2.x, w1 * p1.y + w2 * p2.y};  // v is the origin
}

DomainPoint CollapseHistory::InNewFaces(const Vec2d& q, const Collapse& c) const {
  const Vec2d* ring = &ring_positions_[c.first_ring];
  const int k = c.valence;
  // The new faces are a fan around the vertex kept. Signs tell which of them q may be in; only there weights are computed.
  const Vec2d& apex = ring[c.kept];
  const Vec2d to_q = Minus(q, apex);
  const auto next = [k](int i) { return i + 1 == k ? 0 : i + 1; };
  int spoke = next(c.kept);
  bool is_left = CrossProduct(Minus(ring[spoke], apex), to_q) >= 0;  // of the spoke
  for (int m = 0; m < k - 2; ++m) {
    const int next_spoke = next(spoke);
    const double beyond = CrossProduct(Minus(ring[next_spoke], apex), to_q);
    if (is_left && beyond <= 0) {
      const Vec3d w = BarycentricIn(q, apex, ring[spoke], ring[next_spoke]);
      if (MinWeight(w) >= 0) return {c.first_new_face + static_cast<uint32_t>(m), ClampWeights(w)};
    }
    is_left = beyond >= 0;
    spoke = next_spoke;
  }
  // In none, by rounding or beyond the border: the one that it is least far out of.
  double best = -std::numeric_limits<double>::max();
  DomainPoint result{c.first_new_face, {1, 0, 0}};
  for (int m = 0; m < k - 2; ++m) {
    const Vec3d w = BarycentricIn(q, ring[c.kept], ring[(c.kept + 1 + m) % k], ring[(c.kept + 2 + m) % k]);
    if (MinWeight(w) <= best) continue;
    best = MinWeight(w);
    result = {c.first_new_face + static_cast<uint32_t>(m), w};
  }
  result.barycentric = ClampWeights(result.barycentric);
  return result;
}

DomainPoint CollapseHistory::BackwardOnce(const DomainPoint& point, const Collapse& c) const {
  const Vec2d* ring = &ring_positions_[c.first_ring];
  const int k = c.valence;
  const int m = static_cast<int>(point.face - c.first_new_face);
  const Vec2d &a = ring[c.kept], &b = ring[(c.kept + 1 + m) % k], &d = ring[(c.kept + 2 + m) % k];
  const Vec3d& w = point.barycentric;
  const Vec2d q = {w.x * a.x + w.y * b.x + w.z * d.x, w.x * a.y + w.y * b.y + w.z * d.y};
  const PlaceInTriangles place = FindInTriangles(q, c.num_old_faces, [&](int i) { return std::array<Vec2d, 3>{Vec2d{}, ring[i], ring[(i + 1) % k]}; });
  DomainPoint result{old_faces_[c.first_ring + place.triangle], {}};
  const int r = ends_[result.face].corner;
  for (int corner = 0; corner < 3; ++corner) result.barycentric[(r + corner) % 3] = place.weights[corner];
  return result;
}

DomainPoint CollapseHistory::Forward(DomainPoint point, const HistoryCut& cut) const {
  while (cut.Has(ends_[point.face].collapse)) {
    const End& end = ends_[point.face];
    point = InNewFaces(PlaceInChart(point, end), collapses_[end.collapse]);
  }
  return point;
}

void CollapseHistory::Forward(std::vector<DomainPoint>* points, const HistoryCut& cut) const {
  struct Step {
    DomainPoint* point;
    End end;
    Vec2d place;
  };
  std::vector<Step> steps;
  steps.reserve(points->size());
  for (DomainPoint& point : *points) steps.push_back({&point, {}, {}});
  // Every loop reads what the one before has found the address of.
  for (;;) {
    for (Step& step : steps) step.end = ends_[step.point->face];
    steps.erase(std::remove_if(steps.begin(), steps.end(), [&](const Step& step) { return !cut.Has(step.end.collapse); }), steps.end());
    if (steps.empty()) return;
    for (Step& step : steps) step.place = PlaceInChart(*step.point, step.end);
    for (Step& step : steps) *step.point = InNewFaces(step.place, collapses_[step.end.collapse]);
  }
}

DomainPoint CollapseHistory::Backward(DomainPoint point) const {
  while (created_by_[point.face] != kNone) point = BackwardOnce(point, collapses_[created_by_[point.face]]);
  return point;
}

}  // namespace lacerta
