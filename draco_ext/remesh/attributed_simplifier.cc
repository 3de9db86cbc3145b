#include "remesh/attributed_simplifier.h"

#include <algorithm>
#include <cmath>

#include "geometry/bounding_box.h"
#include "remesh/edge_corners.h"

namespace lacerta {
namespace {

constexpr uint32_t kNone = MeshAttribute::kNoValue;
// Vertices of more triangles stand still: the work of a collapse grows with them.
constexpr uint32_t kMaxRing = 128;
// Of the planes through a curve edge that hold the curve in place; a triangle's plane weighs its area.
constexpr double kCurveWeight = 0.3;

}  // namespace

AttributedSimplifier::Channel::Channel(const MeshAttribute& attribute, const AttributeNodes& start, double weight, uint32_t num_vertices)
    : is_texture(attribute.kind == AttributeKind::kTextureCoordinates && attribute.components == 2),
      scale(weight),
      nodes(start.nodes),
      node_of_vertex(num_vertices, kNone),
      quadrics(attribute.components, start.values.size()) {
  values.reserve(start.values.size() * attribute.components);
  for (const uint32_t row : start.values) {
    for (uint32_t i = 0; i < attribute.components; ++i) {
      values.push_back(weight * static_cast<double>(attribute.values[size_t{row} * attribute.components + i]));
    }
  }
}

AttributedSimplifier::AttributedSimplifier(const AttributedMesh& input, const WedgeMesh& start, const std::vector<double>& weights,
                                           AttributedSimplification* sequence)
    : input_(input),
      start_(start),
      sequence_(sequence),
      triangles_(start.mesh.triangles),
      dead_(triangles_.size(), 0),
      curve_edges_(start.curve_edges),
      freedom_(start.freedom),
      quadrics_(start.num_vertices()),
      rings_(start.num_vertices(), triangles_),
      version_(start.num_vertices(), 0),
      mark_(start.num_vertices(), 0),
      valence_(start.num_vertices(), 0),
      num_alive_(static_cast<uint32_t>(triangles_.size())) {
  const BoundingBox box = BoundsOf(start.mesh.positions);
  const Vec3d low = Vec3Cast<double>(box.low), high = Vec3Cast<double>(box.high);
  center_ = (low + high) * 0.5;
  if (Norm(high - low) > 0) scale_ = Norm(high - low);
  positions_.reserve(start.num_vertices());
  for (const Vec3f& p : start.mesh.positions) positions_.push_back((Vec3Cast<double>(p) - center_) * (1 / scale_));
  for (size_t a = 0; a < input.attributes.size(); ++a) {
    channels_.emplace_back(input.attributes[a], start.attributes[a], weights[a], start.num_vertices());
  }
  for (size_t f = 0; f < triangles_.size(); ++f) {
    for (size_t k = 0; k < 3; ++k) {
      ++valence_[triangles_[f][k]];
      for (Channel& channel : channels_) channel.node_of_vertex[triangles_[f][k]] = channel.nodes[f][k];
    }
  }
}

void AttributedSimplifier::AddQuadrics() {
  double area = 0;
  for (size_t f = 0; f < triangles_.size(); ++f) {
    const Triangle& t = triangles_[f];
    const std::array<Vec3d, 3> p = {positions_[t[0]], positions_[t[1]], positions_[t[2]]};
    const Quadric q = Quadric::OfTriangle(p[0], p[1], p[2]);
    for (const uint32_t v : t) quadrics_[v] += q;
    area += Norm(Cross(p[1] - p[0], p[2] - p[0])) / 2;
    for (Channel& channel : channels_) {
      const Triangle& nodes = channel.nodes[f];
      if (nodes[0] == kNone) continue;
      std::array<const double*, 3> values{};
      for (size_t k = 0; k < 3; ++k) values[k] = &channel.values[size_t{nodes[k]} * channel.quadrics.components()];
      channel.quadrics.AddTriangle(nodes, p, values);
    }
  }
  // Orders flat regions by edge length; elsewhere it is nothing.
  edge_weight_ = 1e-9 * area / static_cast<double>(triangles_.size());
}

// Planes through the curve edges, upright on their triangles.
void AttributedSimplifier::AddCurveQuadrics() {
  for (uint32_t corner = 0; corner < 3 * triangles_.size(); ++corner) {
    if ((curve_edges_[corner / 3] >> (corner % 3) & 1) == 0) continue;
    const uint32_t u = StartOfEdge(triangles_, corner), v = EndOfEdge(triangles_, corner);
    const Vec3d &a = positions_[u], &b = positions_[v];
    const Vec3d normal = Normalized(Cross(b - a, positions_[VertexOf(triangles_, corner)] - a));
    const Quadric q = Quadric::OfTriangle(a, b, a + normal * (2 * kCurveWeight * Norm(b - a)));
    quadrics_[u] += q;
    quadrics_[v] += q;
  }
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
  heap_.push({static_cast<float>(Place(u, v).cost), u, v, version_[u] + version_[v]});
}

void AttributedSimplifier::PushAround(uint32_t v) {
  const uint32_t mark = ++last_mark_;
  mark_[v] = mark;
  rings_.Collect(v, dead_, &around_);
  for (const uint32_t corner : around_) {
    for (const uint32_t w : triangles_[corner / 3]) {
      if (mark_[w] == mark) continue;
      mark_[w] = mark;
      Push(v, w);
    }
  }
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
  if (freedom_[u] == VertexFreedom::kFixed && freedom_[v] == VertexFreedom::kFixed) return false;
  rings_.Collect(u, dead_, &corners_u_);
  rings_.Collect(v, dead_, &corners_v_);
  return freedom_[u] == VertexFreedom::kSurface || freedom_[v] == VertexFreedom::kSurface || IsCurve(u, v, corners_u_);
}

// The link condition, and that no curve closes on itself: of a triangle that goes, at most one other edge is on a curve.
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
    int num_curves = 0;
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t w = triangles_[t][k];
      if (w == u || w == v) {
        num_curves += curve_edges_[t] >> k & 1;
      } else {
        if (mark_[w] == across) return false;  // two triangles on the same three vertices
        mark_[w] = across;
      }
    }
    if (num_curves == 2) return false;
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

// Which nodes become one: those at both ends of the edge in a triangle that goes. All other nodes at the two vertices are a group alone.
void AttributedSimplifier::GatherNodes(uint32_t u, uint32_t v) {
  groups_.clear();
  group_members_.clear();
  const bool both_free = freedom_[u] == VertexFreedom::kSurface && freedom_[v] == VertexFreedom::kSurface;
  for (uint32_t c = 0; c < channels_.size(); ++c) {
    const Channel& channel = channels_[c];
    if (both_free) {
      if (channel.node_of_vertex[u] == kNone) continue;
      groups_.push_back({c, static_cast<uint32_t>(group_members_.size()), 2, 0});
      group_members_.insert(group_members_.end(), {channel.node_of_vertex[u], channel.node_of_vertex[v]});
      continue;
    }
    std::vector<std::array<uint32_t, 2>> nodes;  // and the number of its group
    const auto number_of = [&](uint32_t node) {
      for (const auto& [known, number] : nodes) {
        if (known == node) return number;
      }
      nodes.push_back({node, static_cast<uint32_t>(nodes.size())});
      return nodes.back()[1];
    };
    for (const std::vector<uint32_t>* corners : {&corners_u_, &corners_v_}) {
      for (const uint32_t corner : *corners) {
        if (VertexOf(channel.nodes, corner) != kNone) number_of(VertexOf(channel.nodes, corner));
      }
    }
    for (const uint32_t corner : corners_u_) {
      if (!Has(corner / 3, v) || VertexOf(channel.nodes, corner) == kNone) continue;
      const uint32_t other = VertexOf(triangles_, NextCorner(corner)) == v ? NextCorner(corner) : PreviousCorner(corner);
      const uint32_t a = number_of(VertexOf(channel.nodes, corner)), b = number_of(VertexOf(channel.nodes, other));
      for (auto& [node, number] : nodes) number = number == b ? a : number;
    }
    std::stable_sort(nodes.begin(), nodes.end(), [](const auto& a, const auto& b) { return a[1] < b[1]; });
    for (size_t i = 0; i < nodes.size(); ++i) {
      if (i == 0 || nodes[i][1] != nodes[i - 1][1]) groups_.push_back({c, static_cast<uint32_t>(group_members_.size()), 0, 0});
      ++groups_.back().count;
      group_members_.push_back(nodes[i][0]);
    }
  }
}

void AttributedSimplifier::SumNodes() {
  sums_.clear();
  for (const NodeGroup& group : groups_) {
    const AttributeQuadrics& quadrics = channels_[group.channel].quadrics;
    const double* first = quadrics.row(group_members_[group.first]);
    const size_t begin = sums_.size();
    sums_.insert(sums_.end(), first, first + quadrics.row_size());
    for (uint32_t i = 1; i < group.count; ++i) {
      const double* row = quadrics.row(group_members_[group.first + i]);
      for (size_t k = 0; k < quadrics.row_size(); ++k) sums_[begin + k] += row[k];
    }
  }
}

Placement AttributedSimplifier::Place(uint32_t u, uint32_t v) {
  Quadric q = quadrics_[u];
  q += quadrics_[v];
  const double* sum = sums_.data();
  for (const NodeGroup& group : groups_) {
    channels_[group.channel].quadrics.AddReduced(sum, &q);
    sum += channels_[group.channel].quadrics.row_size();
  }
  Placement result;
  if (freedom_[u] == VertexFreedom::kFixed || freedom_[v] == VertexFreedom::kFixed) {
    result.position = positions_[freedom_[u] == VertexFreedom::kFixed ? u : v];
    result.cost = q.Evaluate(result.position);
  } else {
    result = PlaceBetween(q, positions_[u], positions_[v]);
  }
  result.cost += edge_weight_ * SquaredNorm(positions_[u] - positions_[v]);
  return result;
}

void AttributedSimplifier::FindValues(const Vec3d& position) {
  new_values_.clear();
  const double* sum = sums_.data();
  for (NodeGroup& group : groups_) {
    const Channel& channel = channels_[group.channel];
    const uint32_t components = channel.quadrics.components();
    group.value = new_values_.size();
    const double* old = &channel.values[size_t{group_members_[group.first]} * components];
    new_values_.insert(new_values_.end(), old, old + components);
    channel.quadrics.BestValue(sum, position, &new_values_[group.value]);
    sum += channel.quadrics.row_size();
  }
}

bool AttributedSimplifier::AnyTurnsOver(uint32_t moved, uint32_t other, const std::vector<uint32_t>& corners, const Vec3d& to) const {
  return std::any_of(corners.begin(), corners.end(), [&](uint32_t corner) {
    if (Has(corner / 3, other)) return false;
    return TurnsOver(positions_[moved], to, positions_[VertexOf(triangles_, NextCorner(corner))],
                     positions_[VertexOf(triangles_, PreviousCorner(corner))]);
  });
}

// Whether a triangle at one of these corners, which get their values from new_values_, would be mirrored in a texture.
bool AttributedSimplifier::AnyTextureTurnsOver(uint32_t other, const std::vector<uint32_t>& corners) const {
  for (const NodeGroup& group : groups_) {
    const Channel& channel = channels_[group.channel];
    if (!channel.is_texture) continue;
    const double* value = &new_values_[group.value];
    for (const uint32_t corner : corners) {
      const uint32_t node = VertexOf(channel.nodes, corner);
      const auto first = group_members_.begin() + group.first;
      if (Has(corner / 3, other) || std::find(first, first + group.count, node) == first + group.count) continue;
      const double* a = &channel.values[2 * size_t{VertexOf(channel.nodes, NextCorner(corner))}];
      const double* b = &channel.values[2 * size_t{VertexOf(channel.nodes, PreviousCorner(corner))}];
      const auto doubled_area = [&](const double* c) { return (a[0] - c[0]) * (b[1] - c[1]) - (a[1] - c[1]) * (b[0] - c[0]); };
      const double before = doubled_area(&channel.values[2 * size_t{node}]), after = doubled_area(value);
      if (before != 0 && before * after <= 0) return true;
    }
  }
  return false;
}

// Of each triangle that goes, the two other edges become one: on a curve where either was.
void AttributedSimplifier::JoinEdges(uint32_t kept, uint32_t removed) {
  const auto& corners_removed = corners_v_;
  const auto& corners_kept = corners_u_;
  for (const uint32_t corner : corners_removed) {
    const uint32_t t = corner / 3;
    if (!Has(t, kept)) continue;
    uint32_t w = 0;
    bool is_curve = false;
    for (size_t k = 0; k < 3; ++k) {
      if (triangles_[t][k] == kept || triangles_[t][k] == removed) {
        is_curve = is_curve || (curve_edges_[t] >> k & 1) != 0;
      } else {
        w = triangles_[t][k];
      }
    }
    if (!is_curve) continue;
    for (const std::vector<uint32_t>* corners : {&corners_kept, &corners_removed}) {
      for (const uint32_t near : *corners) {
        if (Has(near / 3, kept) && Has(near / 3, removed)) continue;
        for (uint32_t k = 0; k < 3; ++k) {
          const uint32_t x = triangles_[near / 3][k];
          if (x != w && 3 * (near / 3) + k != near && Has(near / 3, w)) curve_edges_[near / 3] |= static_cast<uint8_t>(1u << k);
        }
      }
    }
  }
}

void AttributedSimplifier::JoinNodes() {
  const auto num_collapses = static_cast<uint32_t>(sequence_->collapses_.size());
  const double* sum = sums_.data();
  for (const NodeGroup& group : groups_) {
    Channel& channel = channels_[group.channel];
    AttributedSimplification::NodeHistory& history = sequence_->histories_[group.channel];
    const uint32_t components = channel.quadrics.components();
    const uint32_t kept = group_members_[group.first];
    for (uint32_t i = 1; i < group.count; ++i) history.merges.push_back({group_members_[group.first + i], kept, num_collapses});
    std::copy_n(sum, channel.quadrics.row_size(), channel.quadrics.row(kept));
    std::copy_n(&new_values_[group.value], components, &channel.values[size_t{kept} * components]);
    history.moves.push_back({kept, num_collapses});
    for (uint32_t i = 0; i < components; ++i) {
      const double unit = channel.scale > 0 ? 1 / channel.scale : 0;
      history.values.push_back(static_cast<float>(new_values_[group.value + i] * unit));
    }
    for (const std::vector<uint32_t>* corners : {&corners_u_, &corners_v_}) {
      for (const uint32_t corner : *corners) {
        uint32_t& node = channel.nodes[corner / 3][corner % 3];
        for (uint32_t i = 1; i < group.count; ++i) node = node == group_members_[group.first + i] ? kept : node;
        if (!dead_[corner / 3]) channel.node_of_vertex[triangles_[corner / 3][corner % 3]] = node;
      }
    }
    sum += channel.quadrics.row_size();
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
  quadrics_[kept] += quadrics_[removed];
  freedom_[kept] = std::max(freedom_[kept], freedom_[removed]);
  ++version_[kept];
  ++version_[removed];
  sequence_->collapses_.push_back({removed, kept, Vec3Cast<float>(position * scale_ + center_), num_alive_});
  JoinNodes();
  PushAround(kept);
}

// What was not possible may be after changes nearby.
void AttributedSimplifier::RetryBlocked() {
  for (const Candidate& candidate : blocked_) {
    if (!IsVoid(candidate)) heap_.push(candidate);
  }
  blocked_.clear();
}

void AttributedSimplifier::Run() {
  AddQuadrics();
  AddCurveQuadrics();
  PushAll();
  uint32_t alive_at_retry = num_alive_;
  while (true) {
    if (heap_.empty()) {
      if (alive_at_retry == num_alive_) break;
      alive_at_retry = num_alive_;
      RetryBlocked();
      continue;
    }
    const Candidate candidate = heap_.top();
    heap_.pop();
    if (IsVoid(candidate)) continue;
    const bool u_is_freer = freedom_[candidate.u] < freedom_[candidate.v];
    const uint32_t kept = u_is_freer ? candidate.v : candidate.u, removed = u_is_freer ? candidate.u : candidate.v;
    if (!MayCollapse(kept, removed)) continue;
    rings_.Collect(kept, dead_, &corners_u_);
    rings_.Collect(removed, dead_, &corners_v_);
    GatherNodes(kept, removed);
    SumNodes();
    const Vec3d position = Place(kept, removed).position;
    FindValues(position);
    if (!KeepsTopology(kept, removed) || AnyTurnsOver(kept, removed, corners_u_, position) ||
        AnyTurnsOver(removed, kept, corners_v_, position) || AnyTextureTurnsOver(removed, corners_u_) ||
        AnyTextureTurnsOver(kept, corners_v_)) {
      blocked_.push_back(candidate);
      continue;
    }
    Collapse(kept, removed, position);
    constexpr double kRetryShare = 0.9;
    if (num_alive_ < kRetryShare * alive_at_retry) {
      alive_at_retry = num_alive_;
      RetryBlocked();
    }
  }
}

}  // namespace lacerta
