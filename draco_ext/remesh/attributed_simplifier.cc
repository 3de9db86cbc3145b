#include "remesh/attributed_simplifier.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/bounding_box.h"
#include "remesh/edge_corners.h"

namespace lacerta {
namespace {

constexpr uint32_t kNone = MeshAttribute::kNoValue;
// Vertices of more triangles stand still: the work of a collapse grows with them.
constexpr uint32_t kMaxRing = 128;
// Of the planes through a curve edge that hold the curve in place; a triangle's plane weighs its area.
constexpr double kCurveWeight = 0.3;
// What counts of the planes of the input that a vertex stands for, as in SimplificationSequence. Curves are remembered better: what slides
// across a seam shows, though it is too narrow to be measured. Attributes are not.
constexpr double kRemembered = 0.1, kRememberedCurves = 0.3;

}  // namespace

AttributedSimplifier::AttributedSimplifier(const AttributedMesh& input, const WedgeMesh& start, const std::vector<double>& weights, const SimplificationBounds& bounds,
                                           AttributedSimplification* sequence)
    : input_(input),
      start_(start),
      sequence_(sequence),
      triangles_(start.mesh.triangles),
      dead_(triangles_.size(), 0),
      curve_edges_(start.curve_edges),
      freedom_(start.freedom),
      remembered_(start.num_vertices()),
      quadrics_(start.num_vertices()),
      rings_(start.num_vertices(), triangles_),
      version_(start.num_vertices(), 0),
      mark_(start.num_vertices(), 0),
      valence_(start.num_vertices(), 0),
      num_alive_(static_cast<uint32_t>(triangles_.size())),
      queue_(num_alive_) {
  const BoundingBox box = BoundsOf(start.mesh.positions);
  const Vec3d low = Vec3Cast<double>(box.low), high = Vec3Cast<double>(box.high);
  center_ = (low + high) * 0.5;
  if (Norm(high - low) > 0) scale_ = Norm(high - low);
  most_squared_ = bounds.charts / scale_ * (bounds.charts / scale_);
  positions_.reserve(start.num_vertices());
  for (const Vec3f& p : start.mesh.positions) positions_.push_back((Vec3Cast<double>(p) - center_) * (1 / scale_));
  if (bounds.anywhere > 0) {
    std::vector<uint32_t> groups;
    for (const uint32_t f : start.source_face) groups.push_back(input.GroupOf(f));
    auto samples = std::make_shared<const DeviationSamples>(positions_, triangles_, groups, bounds.anywhere / scale_);
    deviation_.emplace(std::move(samples), triangles_.size(), std::move(groups));
  }
  for (size_t a = 0; a < input.attributes.size(); ++a) {
    channels_.emplace_back(input.attributes[a], start.attributes[a], weights[a], start.num_vertices());
  }
  double area = 0;
  for (size_t f = 0; f < triangles_.size(); ++f) {
    const Triangle& t = triangles_[f];
    area += Norm(Cross(positions_[t[1]] - positions_[t[0]], positions_[t[2]] - positions_[t[0]])) / 2;
    for (size_t k = 0; k < 3; ++k) {
      ++valence_[triangles_[f][k]];
      for (Channel& channel : channels_) channel.node_of_vertex[triangles_[f][k]] = channel.nodes[f][k];
    }
  }
  // Orders flat regions by edge length; elsewhere it is nothing.
  edge_weight_ = 1e-9 * area / static_cast<double>(triangles_.size());
}

void AttributedSimplifier::RememberPlanes() {
  for (uint32_t v = 0; v < start_.num_vertices(); ++v) {
    if (valence_[v] > kMaxRing) continue;
    rings_.Collect(v, dead_, &around_);
    auto [surface, curves] = PlanesAround(v);
    surface *= kRemembered;
    curves *= kRememberedCurves;
    remembered_[v] += surface;
    remembered_[v] += curves;
    FindQuadrics(v);
  }
}

// Of v and its nodes, from the triangles and curves that are there.
void AttributedSimplifier::FindQuadrics(uint32_t v) {
  if (valence_[v] > kMaxRing) return;  // it stands still
  rings_.Collect(v, dead_, &around_);
  const auto [surface, curves] = PlanesAround(v);
  quadrics_[v] = remembered_[v];
  quadrics_[v] += surface;
  quadrics_[v] += curves;
  for (Channel& channel : channels_) {
    for (const uint32_t corner : around_) {
      if (VertexOf(channel.nodes, corner) != kNone) channel.quadrics.Clear(VertexOf(channel.nodes, corner));
    }
    for (const uint32_t corner : around_) {
      const Triangle &t = triangles_[corner / 3], &nodes = channel.nodes[corner / 3];
      if (nodes[0] == kNone) continue;
      std::array<const double*, 3> values{};
      for (size_t k = 0; k < 3; ++k) values[k] = &channel.values[size_t{nodes[k]} * channel.quadrics.components()];
      channel.quadrics.AddTriangle(nodes[corner % 3], {positions_[t[0]], positions_[t[1]], positions_[t[2]]}, values);
    }
  }
}

// Planes of the triangles around v, and planes through its curve edges, upright on their triangles: on both sides, or twice on the one side
// that an open border has.
AttributedSimplifier::Planes AttributedSimplifier::PlanesAround(uint32_t v) const {
  Planes planes;
  const auto is_open = [&](uint32_t w) {
    return std::count_if(around_.begin(), around_.end(), [&](uint32_t corner) { return Has(corner / 3, w); }) == 1;
  };
  for (const uint32_t corner : around_) {
    const Triangle& t = triangles_[corner / 3];
    planes.surface += Quadric::OfTriangle(positions_[t[0]], positions_[t[1]], positions_[t[2]]);
    for (const uint32_t across : {NextCorner(corner), PreviousCorner(corner)}) {
      if ((curve_edges_[corner / 3] >> (across % 3) & 1) == 0) continue;
      const uint32_t w = t[3 - corner % 3 - across % 3];
      const double sides = is_open(w) ? 2 : 1;
      planes.curves += Quadric::OfBorder(positions_[v], positions_[w], positions_[t[across % 3]], sides * kCurveWeight);
    }
  }
  return planes;
}

void AttributedSimplifier::PushAll() {
  const EdgeCorners edges = GroupByEdge(start_.num_vertices(), triangles_);
  for (uint32_t e = 0; e < edges.num_edges(); ++e) {
    const uint32_t corner = edges.of(e)[0];
    Push(StartOfEdge(triangles_, corner), EndOfEdge(triangles_, corner));
  }
}

void AttributedSimplifier::Push(uint32_t u, uint32_t v) {
  if (u > v) std::swap(u, v);
  if (!MayCollapse(u, v)) return;
  GatherNodes(u, v);
  SumNodes();
  queue_.Push({static_cast<float>(Place(u, v).cost), u, v, version_[u] + version_[v]});
}

std::vector<uint32_t> AttributedSimplifier::NeighborsOf(uint32_t v) {
  std::vector<uint32_t> neighbors;
  const uint32_t mark = ++last_mark_;
  mark_[v] = mark;
  rings_.Collect(v, dead_, &around_);
  for (const uint32_t corner : around_) {
    for (const uint32_t w : triangles_[corner / 3]) {
      if (mark_[w] != mark) neighbors.push_back(w);
      mark_[w] = mark;
    }
  }
  return neighbors;
}

bool AttributedSimplifier::IsCurve(uint32_t u, uint32_t v, const std::vector<uint32_t>& corners_u) const {
  for (const uint32_t corner : corners_u) {
    const Triangle& t = triangles_[corner / 3];
    for (size_t k = 0; k < 3; ++k) {
      if (t[k] != u && t[k] != v && Has(corner / 3, v)) return (curve_edges_[corner / 3] >> k & 1) != 0;
    }
  }
  return false;
}

// By what is known of both ends; collects their corners unless both are free.
bool AttributedSimplifier::MayCollapse(uint32_t u, uint32_t v) {
  if (valence_[u] + valence_[v] > kMaxRing) return false;
  if (freedom_[u] == VertexFreedom::kSurface && freedom_[v] == VertexFreedom::kSurface) return true;
  if (freedom_[u] == VertexFreedom::kHeld || freedom_[v] == VertexFreedom::kHeld) return false;
  if (freedom_[u] == VertexFreedom::kFixed && freedom_[v] == VertexFreedom::kFixed) return false;
  rings_.Collect(u, dead_, &corners_u_);
  rings_.Collect(v, dead_, &corners_v_);
  return freedom_[u] == VertexFreedom::kSurface || freedom_[v] == VertexFreedom::kSurface || IsCurve(u, v, corners_u_);
}

// The link condition.
bool AttributedSimplifier::KeepsTopology(uint32_t u, uint32_t v) {
  const uint32_t near_u = ++last_mark_, across = ++last_mark_;
  size_t num_shared = 0;
  for (const uint32_t corner : corners_u_) {
    for (const uint32_t w : triangles_[corner / 3]) mark_[w] = near_u;
  }
  for (const uint32_t corner : corners_u_) {
    const uint32_t t = corner / 3;
    if (!Has(t, v)) continue;
    ++num_shared;
    const uint32_t tip = TipOf(t, u, v).vertex;
    if (mark_[tip] == across) return false;  // two triangles on the same three vertices
    mark_[tip] = across;
  }
  if (num_shared == 0 || (num_shared == corners_u_.size() && num_shared == corners_v_.size())) return false;
  const auto has_both_across = [&](uint32_t corner, uint32_t end) {
    int count = 0;
    for (const uint32_t w : triangles_[corner / 3]) count += w != end && mark_[w] == across;
    return count == 2;
  };
  bool v_has_both = false;
  for (const uint32_t corner : corners_v_) {
    if (Has(corner / 3, u)) continue;
    for (const uint32_t w : triangles_[corner / 3]) {
      if (w != v && mark_[w] == near_u) return false;
    }
    v_has_both = v_has_both || has_both_across(corner, v);
  }
  if (!v_has_both) return true;
  return std::none_of(corners_u_.begin(), corners_u_.end(),
                      [&](uint32_t corner) { return !Has(corner / 3, v) && has_both_across(corner, u); });
}

AttributedSimplifier::Tip AttributedSimplifier::TipOf(uint32_t triangle, uint32_t u, uint32_t v) const {
  Tip tip;
  for (size_t k = 0; k < 3; ++k) {
    const uint32_t w = triangles_[triangle][k];
    if (w == u || w == v) {
      tip.num_curves += curve_edges_[triangle] >> k & 1;
    } else {
      tip.vertex = w;
    }
  }
  return tip;
}

// Whether a triangle of the same group lies across another edge of a triangle than the one from u to v, which is opposite to `tip`.
bool AttributedSimplifier::HasNeighborOfGroup(uint32_t triangle, uint32_t u, uint32_t v, uint32_t tip) const {
  const auto group_of = [&](uint32_t t) { return input_.GroupOf(start_.source_face[t]); };
  for (const std::vector<uint32_t>* corners : {&corners_u_, &corners_v_}) {
    for (const uint32_t corner : *corners) {
      const uint32_t t = corner / 3;
      if (Has(t, tip) && !(Has(t, u) && Has(t, v)) && group_of(t) == group_of(triangle)) return true;
    }
  }
  return false;
}

// Curves become one where a triangle goes whose two other edges are on them, and with it a chart or its tip: what the attributes had there is
// not among the quadrics any more, so the curves have to be near each other.
bool AttributedSimplifier::MayJoinCurves(uint32_t u, uint32_t v, const Vec3d& position) const {
  if (freedom_[u] == VertexFreedom::kSurface || freedom_[v] == VertexFreedom::kSurface) return true;
  bool joins = false;
  for (const uint32_t corner : corners_u_) {
    const uint32_t t = corner / 3;
    if (!Has(t, v)) continue;
    const Tip tip = TipOf(t, u, v);
    if (tip.num_curves < 2) continue;
    if (!HasNeighborOfGroup(t, u, v, tip.vertex)) return false;
    joins = true;
  }
  if (!joins) return true;
  Quadric planes = remembered_[u];
  planes += remembered_[v];
  return planes.Evaluate(position) < most_squared_ * planes.quadratic.trace();
}

// Whether no point of the surface goes too far.
bool AttributedSimplifier::StaysNear(uint32_t u, uint32_t v, const Vec3d& position) {
  if (!deviation_) return true;
  faces_.clear();
  for (const std::vector<uint32_t>* corners : {&corners_u_, &corners_v_}) {
    for (const uint32_t corner : *corners) {
      const uint32_t t = corner / 3;
      const bool goes = Has(t, u) && Has(t, v);
      if (goes && corners == &corners_v_) continue;
      faces_.push_back({t, !goes, positions_[VertexOf(triangles_, NextCorner(corner))], positions_[VertexOf(triangles_, PreviousCorner(corner))]});
    }
  }
  return deviation_->Allows(position, faces_);
}

bool AttributedSimplifier::AnyTurnsOver(uint32_t moved, uint32_t other, const std::vector<uint32_t>& corners, const Vec3d& to) const {
  return std::any_of(corners.begin(), corners.end(), [&](uint32_t corner) {
    if (Has(corner / 3, other)) return false;
    return TurnsOver(positions_[moved], to, positions_[VertexOf(triangles_, NextCorner(corner))],
                     positions_[VertexOf(triangles_, PreviousCorner(corner))]);
  });
}

// Of each triangle that goes, the two other edges become one: on a curve where either was.
void AttributedSimplifier::JoinEdges(uint32_t kept, uint32_t removed) {
  const auto& corners_removed = corners_v_;
  const auto& corners_kept = corners_u_;
  for (const uint32_t corner : corners_removed) {
    const uint32_t t = corner / 3;
    if (!Has(t, kept)) continue;
    const Tip tip = TipOf(t, kept, removed);
    if (tip.num_curves == 0) continue;
    for (const std::vector<uint32_t>* corners : {&corners_kept, &corners_removed}) {
      for (const uint32_t near : *corners) {
        if (Has(near / 3, kept) && Has(near / 3, removed)) continue;
        for (uint32_t k = 0; k < 3; ++k) {
          const uint32_t x = triangles_[near / 3][k];
          if (x != tip.vertex && 3 * (near / 3) + k != near && Has(near / 3, tip.vertex)) curve_edges_[near / 3] |= static_cast<uint8_t>(1u << k);
        }
      }
    }
  }
}

// corners_u_: of `kept`, corners_v_: of `removed`.
void AttributedSimplifier::Collapse(uint32_t kept, uint32_t removed, const Vec3d& position) {
  JoinEdges(kept, removed);
  for (const uint32_t corner : corners_v_) {
    const uint32_t t = corner / 3;
    if (Has(t, kept)) {
      dead_[t] = 1;
      --num_alive_;
      for (const uint32_t v : triangles_[t]) --valence_[v];
    } else {
      triangles_[t][corner % 3] = kept;
      ++valence_[kept];
    }
  }
  rings_.Join(kept, removed);
  positions_[kept] = position;
  remembered_[kept] += remembered_[removed];
  freedom_[kept] = std::max(freedom_[kept], freedom_[removed]);
  ++version_[kept];
  ++version_[removed];
  sequence_->collapses_.push_back({removed, kept, Vec3Cast<float>(position * scale_ + center_), num_alive_});
  JoinNodes();
  const std::vector<uint32_t> neighbors = NeighborsOf(kept);
  FindQuadrics(kept);
  for (const uint32_t w : neighbors) FindQuadrics(w);
  for (const uint32_t w : neighbors) Push(kept, w);
}

void AttributedSimplifier::Run() {
  RememberPlanes();
  PushAll();
  const auto is_void = [this](const Candidate& c) { return IsVoid(c); };
  while (const std::optional<Candidate> candidate = queue_.Next(num_alive_, is_void)) {
    const bool u_is_freer = freedom_[candidate->u] < freedom_[candidate->v];
    const uint32_t kept = u_is_freer ? candidate->v : candidate->u, removed = u_is_freer ? candidate->u : candidate->v;
    if (!MayCollapse(kept, removed)) continue;
    rings_.Collect(kept, dead_, &corners_u_);
    rings_.Collect(removed, dead_, &corners_v_);
    GatherNodes(kept, removed);
    SumNodes();
    const auto [cost, position] = Place(kept, removed);
    if (static_cast<float>(cost) > candidate->cost) {  // neighbors changed since, on which its quadrics depend, too
      queue_.Push({static_cast<float>(cost), candidate->u, candidate->v, candidate->version});
      continue;
    }
    FindValues(position);
    if (!KeepsTopology(kept, removed) || !MayJoinCurves(kept, removed, position) || AnyTurnsOver(kept, removed, corners_u_, position) ||
        AnyTurnsOver(removed, kept, corners_v_, position) || AnyTextureTurnsOver(removed, corners_u_) ||
        AnyTextureTurnsOver(kept, corners_v_) || AnyTurnsFromNormals(kept, removed, corners_u_, position) ||
        AnyTurnsFromNormals(removed, kept, corners_v_, position) || !StaysNear(kept, removed, position)) {
      queue_.Block(*candidate);
      continue;
    }
    if (deviation_) deviation_->Accept();
    Collapse(kept, removed, position);
  }
}

}  // namespace lacerta
