#include "remesh/base_domain.h"

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include "remesh/edge_quad.h"

namespace lacerta {
namespace {

std::vector<Vec3d> InDoubles(const std::vector<Vec3f>& positions) {
  std::vector<Vec3d> result;
  result.reserve(positions.size());
  for (const Vec3f& p : positions) result.push_back(Vec3Cast<double>(p));
  return result;
}

}  // namespace

BaseDomain::BaseDomain(const CollapseHistory& history, HistoryCut cut) : history_(history), cut_(std::move(cut)) {
  history_face_ = history.FacesAt(cut_);
  rotation_.assign(history_face_.size(), 0);
  face_of_history_.assign(history.num_faces(), kNone);
  moves_ = DomainMoves(history_face_.size());
  for (const uint32_t f : history_face_) {
    for (const uint32_t v : history.face(f)) input_vertex_.push_back(v);
  }
  std::sort(input_vertex_.begin(), input_vertex_.end());
  input_vertex_.erase(std::unique(input_vertex_.begin(), input_vertex_.end()), input_vertex_.end());
  for (const uint32_t f : history_face_) {
    Triangle t = history.face(f);
    for (uint32_t& v : t) {
      v = static_cast<uint32_t>(std::lower_bound(input_vertex_.begin(), input_vertex_.end(), v) - input_vertex_.begin());
    }
    face_of_history_[f] = static_cast<uint32_t>(triangles_.size());
    first_face_.push_back(static_cast<uint32_t>(triangles_.size()));
    triangles_.push_back(t);
    uint8_t sides = 0;
    for (int k = 0; k < 3; ++k) sides |= static_cast<uint8_t>(history.is_curve(f, k) << k);
    curve_sides_.push_back(sides);
  }
  slid_to_.assign(num_vertices(), {});
  BuildTables();
}

void BaseDomain::BuildTables() {
  base_face_.resize(first_face_.size());
  for (uint32_t f = 0; f < first_face_.size(); ++f) base_face_[first_face_[f]] = f;
  topology_ = BuildTopology(num_vertices(), triangles_).value();  // a manifold stays one through every collapse
  tags_ = FindTags();
  if (!tags_.empty()) topology_ = BuildTopology(num_vertices(), triangles_, tags_).value();
}

BaseTags BaseDomain::FindTags() const {
  BaseTags tags;
  std::vector<uint8_t> crease(topology_.num_edges(), 0);
  std::vector<uint32_t> num_curve_edges(num_vertices(), 0);
  for (uint32_t e = 0; e < topology_.num_edges(); ++e) {
    const uint32_t f = topology_.edge_faces[e][0];
    const bool on_curve = (curve_sides_[f] >> EdgeCorner(topology_, f, e) & 1) != 0;
    crease[e] = on_curve && !topology_.is_border(e);
    for (const uint32_t v : topology_.edges[e]) num_curve_edges[v] += on_curve;
  }
  if (std::find(crease.begin(), crease.end(), 1) != crease.end()) tags.crease = std::move(crease);
  std::vector<uint8_t> corner(num_vertices(), 0);
  for (uint32_t v = 0; v < num_vertices(); ++v) {
    corner[v] = num_curve_edges[v] == 2 && history_.role(input_vertex_[v]) == CurveRole::kCorner;
  }
  if (std::find(corner.begin(), corner.end(), 1) != corner.end()) tags.corner = std::move(corner);
  return tags;
}

void BaseDomain::Reorder(const std::vector<uint32_t>& vertex_map, const std::vector<Triangle>& triangles) {
  std::vector<uint32_t> new_vertex(vertex_map.size());
  for (uint32_t v = 0; v < vertex_map.size(); ++v) new_vertex[vertex_map[v]] = v;
  std::map<Triangle, uint32_t> old_face;  // by its vertices in new numbers, the smallest first
  const auto canonical = [](Triangle t) {
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    return t;
  };
  for (uint32_t f = 0; f < triangles_.size(); ++f) {
    Triangle t = triangles_[f];
    for (uint32_t& v : t) v = new_vertex[v];
    old_face[canonical(t)] = f;
  }
  std::vector<uint32_t> first_face;
  std::vector<uint8_t> rotation, curve_sides;
  for (const Triangle& t : triangles) {
    const uint32_t old = old_face.at(canonical(t));
    int shift = 0;
    while (new_vertex[triangles_[old][shift]] != t[0]) ++shift;
    first_face.push_back(first_face_[old]);
    rotation.push_back(static_cast<uint8_t>((rotation_[old] + shift) % 3));
    uint8_t sides = 0;
    for (int k = 0; k < 3; ++k) sides |= static_cast<uint8_t>((curve_sides_[old] >> (k + shift) % 3 & 1) << k);
    curve_sides.push_back(sides);
  }
  std::vector<uint32_t> input_vertex(vertex_map.size(), kNone);
  std::vector<DomainPoint> slid_to(vertex_map.size());
  for (uint32_t v = 0; v < vertex_map.size(); ++v) {
    if (vertex_map[v] >= input_vertex_.size()) continue;
    input_vertex[v] = input_vertex_[vertex_map[v]];
    slid_to[v] = slid_to_[vertex_map[v]];
  }
  triangles_ = triangles;
  input_vertex_ = std::move(input_vertex);
  slid_to_ = std::move(slid_to);
  first_face_ = std::move(first_face);
  curve_sides_ = std::move(curve_sides);
  rotation_ = std::move(rotation);
  BuildTables();
}

void BaseDomain::Join(std::vector<uint32_t> joined) {
  tags_.joined = std::move(joined);
  topology_ = BuildTopology(num_vertices(), triangles_, tags_).value();
}

void BaseDomain::Slide(const std::vector<DomainPoint>& to, const std::vector<Vec3f>& positions) {
  const std::vector<Vec3d> before = InDoubles(positions);
  for (uint32_t v = 0; v < num_vertices(); ++v) {
    const bool has_moved = to[v].face != slid_to_[v].face || !(to[v].barycentric == slid_to_[v].barycentric);
    if (to[v].face != kNone && has_moved && moves_.Slide(v, OnFirstFace(history_.Forward(to[v], cut_)), topology_, before)) slid_to_[v] = to[v];
  }
}

size_t BaseDomain::Flip(const std::vector<uint32_t>& edges, const std::vector<Vec3f>& positions) {
  const std::vector<Vec3d> at = InDoubles(positions);
  std::set<std::array<uint32_t, 2>> joined;
  const auto ordered = [](uint32_t a, uint32_t b) { return std::array<uint32_t, 2>{std::min(a, b), std::max(a, b)}; };
  for (const auto& [a, b] : topology_.edges) joined.insert(ordered(a, b));
  size_t flipped = 0;
  for (const uint32_t e : edges) {
    if (topology_.on_curve[e] != 0) continue;
    const EdgeQuad q(topology_, e);
    if (q.c == q.d || joined.count(ordered(q.c, q.d)) > 0 || !moves_.Flip(e, topology_, at)) continue;
    joined.erase(ordered(q.a, q.b));
    joined.insert(ordered(q.c, q.d));
    const auto side = [&](uint32_t face, int corner) { return curve_sides_[face] >> corner % 3 & 1; };
    const auto bit = [](int is_set, int corner) { return static_cast<uint8_t>(is_set << corner % 3); };
    const uint8_t new_f = bit(side(q.f, q.at_c + 2), q.at_c + 2) | bit(side(q.g, q.at_d + 1), q.at_c);
    const uint8_t new_g = bit(side(q.g, q.at_d + 2), q.at_d + 2) | bit(side(q.f, q.at_c + 1), q.at_d);
    curve_sides_[q.f] = new_f;
    curve_sides_[q.g] = new_g;
    q.Turn(q.f, q.g, &triangles_);
    ++flipped;
  }
  BuildTables();
  return flipped;
}

std::vector<Vec3f> BaseDomain::PositionsOn(const TriangleMesh& input) const {
  std::vector<Vec3f> positions;
  for (const uint32_t v : input_vertex_) positions.push_back(v == kNone ? Vec3f() : input.positions[v]);
  return positions;
}

DomainPoint BaseDomain::OnBaseFace(const DomainPoint& p) const {
  const uint32_t face = base_face_[p.face];
  DomainPoint result{face, {}};
  for (int k = 0; k < 3; ++k) result.barycentric[k] = p.barycentric[(k + rotation_[face]) % 3];
  return result;
}

DomainPoint BaseDomain::FromInput(const DomainPoint& on_input) const {
  return OnBaseFace(moves_.Forward(OnFirstFace(history_.Forward({on_input.face, ClampWeights(on_input.barycentric)}, cut_))));
}

void BaseDomain::FromInput(std::vector<DomainPoint>* points) const {
  for (DomainPoint& p : *points) p.barycentric = ClampWeights(p.barycentric);
  history_.Forward(points, cut_);
  for (DomainPoint& p : *points) p = OnBaseFace(moves_.Forward(OnFirstFace(p)));
}

DomainPoint BaseDomain::ToInput(const DomainPoint& point) const {
  DomainPoint p{first_face_[point.face], {}};
  for (int k = 0; k < 3; ++k) p.barycentric[(k + rotation_[point.face]) % 3] = point.barycentric[k];
  p = moves_.Backward(p);
  return history_.Backward({history_face_[p.face], p.barycentric});
}

std::optional<ChartPoint> BaseDomain::ToChart(uint32_t center, const DomainPoint& point) const {
  if (point.face == center) return point.barycentric;
  for (int k = 0; k < 3; ++k) {  // a base vertex belongs to all of its faces
    if (point.barycentric[k] != 1.0) continue;
    const Triangle& t = triangles_[center];
    const auto corner = std::find(t.begin(), t.end(), triangles_[point.face][k]);
    if (corner == t.end()) break;  // it may still be the far corner of a neighbor
    ChartPoint q;
    q[static_cast<int>(corner - t.begin())] = 1;
    return q;
  }
  for (int k = 0; k < 3; ++k) {
    const uint32_t edge = topology_.face_edges[center][k];
    if (FaceAcross(topology_, center, edge) != point.face) continue;  // kNone across the border is no point's face
    // The apex of the neighbor is the reflection (-1, 1, 1) of corner k, with the -1 at k.
    const int apex = EdgeCorner(topology_, point.face, edge);
    const double gamma = point.barycentric[apex];
    ChartPoint q;
    q[k] = -gamma;
    // Opposite orientation along the shared edge: corner apex+1 of the neighbor is corner k+2 of the center.
    q[(k + 2) % 3] = point.barycentric[(apex + 1) % 3] + gamma;
    q[(k + 1) % 3] = point.barycentric[(apex + 2) % 3] + gamma;
    return q;
  }
  return std::nullopt;
}

std::optional<DomainPoint> BaseDomain::FromChart(uint32_t center, const ChartPoint& point) const {
  constexpr double kSlack = 1e-9;
  if (point.x >= -kSlack && point.y >= -kSlack && point.z >= -kSlack) return DomainPoint{center, ClampWeights(point)};
  for (int k = 0; k < 3; ++k) {
    if (point[k] >= 0) continue;
    const double gamma = -point[k];
    const double w1 = point[(k + 1) % 3] - gamma, w2 = point[(k + 2) % 3] - gamma;
    if (w1 < -kSlack || w2 < -kSlack) continue;
    const uint32_t edge = topology_.face_edges[center][k];
    const uint32_t face = FaceAcross(topology_, center, edge);
    if (face == kNone) return std::nullopt;
    const int apex = EdgeCorner(topology_, face, edge);
    DomainPoint result{face, {}};
    result.barycentric[apex] = gamma;
    result.barycentric[(apex + 1) % 3] = w2;
    result.barycentric[(apex + 2) % 3] = w1;
    result.barycentric = ClampWeights(result.barycentric);
    return result;
  }
  return std::nullopt;
}

}  // namespace lacerta
