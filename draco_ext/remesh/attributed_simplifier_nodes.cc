// The part of AttributedSimplifier that deals with attribute values: which become one in a collapse, and what they are then.
#include <algorithm>
#include <array>
#include <vector>

#include "remesh/attributed_simplifier.h"
#include "remesh/edge_corners.h"

namespace lacerta {
namespace {

constexpr uint32_t kNone = MeshAttribute::kNoValue;

}  // namespace

AttributedSimplifier::Channel::Channel(const MeshAttribute& attribute, const AttributeNodes& start, double weight, uint32_t num_vertices)
    : is_texture(attribute.kind == AttributeKind::kTextureCoordinates && attribute.components == 2),
      is_normal(attribute.kind == AttributeKind::kNormal && attribute.components == 3),
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

// Which nodes become one: those at both ends of the edge in a triangle that goes. All other nodes at the two vertices are a group alone.
void AttributedSimplifier::GatherNodes(uint32_t u, uint32_t v) {
  groups_.clear();
  group_members_.clear();
  const bool both_free = freedom_[u] == VertexFreedom::kSurface && freedom_[v] == VertexFreedom::kSurface;
  std::vector<std::array<uint32_t, 2>> nodes;  // of a channel, and the number of each one's group
  for (uint32_t c = 0; c < channels_.size(); ++c) {
    const Channel& channel = channels_[c];
    if (both_free) {
      if (channel.node_of_vertex[u] == kNone) continue;
      groups_.push_back({c, static_cast<uint32_t>(group_members_.size()), 2, 0});
      group_members_.insert(group_members_.end(), {channel.node_of_vertex[u], channel.node_of_vertex[v]});
      continue;
    }
    nodes.clear();
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
    // Curves that nearly meet, as at the tip of a slit, cross far beyond it.
    constexpr double kFarthest = 2, kFarthestOnCurve = 0.5;
    const bool is_on_curve = freedom_[u] != VertexFreedom::kSurface || freedom_[v] != VertexFreedom::kSurface;
    result = PlaceBetween(q, positions_[u], positions_[v], is_on_curve ? kFarthestOnCurve : kFarthest);
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

bool AttributedSimplifier::IsOfGroup(const NodeGroup& group, uint32_t corner) const {
  const auto first = group_members_.begin() + group.first;
  return std::find(first, first + group.count, VertexOf(channels_[group.channel].nodes, corner)) != first + group.count;
}

// Whether a triangle at one of these corners would look away from its own normals: as a hole, where back faces are not drawn.
bool AttributedSimplifier::AnyTurnsFromNormals(uint32_t moved, uint32_t other, const std::vector<uint32_t>& corners, const Vec3d& to) const {
  for (const NodeGroup& group : groups_) {
    const Channel& channel = channels_[group.channel];
    if (!channel.is_normal) continue;
    const auto value = [&](uint32_t node) {
      const double* row = &channel.values[3 * size_t{node}];
      return Vec3d{row[0], row[1], row[2]};
    };
    const double* row = &new_values_[group.value];
    const Vec3d new_value{row[0], row[1], row[2]};
    for (const uint32_t corner : corners) {
      if (Has(corner / 3, other) || !IsOfGroup(group, corner)) continue;
      const uint32_t next = NextCorner(corner), previous = PreviousCorner(corner);
      const Vec3d &a = positions_[VertexOf(triangles_, next)], &b = positions_[VertexOf(triangles_, previous)];
      const Vec3d others = value(VertexOf(channel.nodes, next)) + value(VertexOf(channel.nodes, previous));
      if (Dot(Cross(a - to, b - to), others + new_value) >= 0) continue;
      if (Dot(Cross(a - positions_[moved], b - positions_[moved]), others + value(VertexOf(channel.nodes, corner))) >= 0) return true;
    }
  }
  return false;
}

// Whether a triangle at one of these corners, which get their values from new_values_, would be mirrored in a texture.
bool AttributedSimplifier::AnyTextureTurnsOver(uint32_t other, const std::vector<uint32_t>& corners) const {
  for (const NodeGroup& group : groups_) {
    const Channel& channel = channels_[group.channel];
    if (!channel.is_texture) continue;
    const double* value = &new_values_[group.value];
    for (const uint32_t corner : corners) {
      if (Has(corner / 3, other) || !IsOfGroup(group, corner)) continue;
      const uint32_t node = VertexOf(channel.nodes, corner);
      const double* a = &channel.values[2 * size_t{VertexOf(channel.nodes, NextCorner(corner))}];
      const double* b = &channel.values[2 * size_t{VertexOf(channel.nodes, PreviousCorner(corner))}];
      const auto doubled_area = [&](const double* c) { return (a[0] - c[0]) * (b[1] - c[1]) - (a[1] - c[1]) * (b[0] - c[0]); };
      const double before = doubled_area(&channel.values[2 * size_t{node}]), after = doubled_area(value);
      if (before != 0 && before * after <= 0) return true;
    }
  }
  return false;
}

void AttributedSimplifier::JoinNodes() {
  const auto num_collapses = static_cast<uint32_t>(sequence_->collapses_.size());
  for (const NodeGroup& group : groups_) {
    Channel& channel = channels_[group.channel];
    AttributedSimplification::NodeHistory& history = sequence_->histories_[group.channel];
    const uint32_t components = channel.quadrics.components();
    const uint32_t kept = group_members_[group.first];
    for (uint32_t i = 1; i < group.count; ++i) history.merges.push_back({group_members_[group.first + i], kept, num_collapses});
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
  }
}

}  // namespace lacerta
