#include "remesh/domain_moves.h"

#include <algorithm>
#include <utility>

#include "remesh/edge_quad.h"

namespace lacerta {
namespace {

constexpr double kLeastArea = 0.1;  // of a triangle that is slid, over what it was

}  // namespace

bool DomainMoves::Slide(uint32_t v, const DomainPoint& to, const Topology& topology, const std::vector<Vec3d>& positions) {
  const DomainPoint now = Forward(to);
  const auto corner_of = [&](uint32_t face) {
    const Triangle& t = topology.triangles[face];
    return t[0] == v ? 0 : t[1] == v ? 1 : t[2] == v ? 2 : 3;
  };
  if (corner_of(now.face) == 3) return false;
  Fan fan;
  std::vector<int> corners;
  for (uint32_t face = now.face; fan.faces.empty() || face != now.face;) {
    if (face == kNone) return false;
    const int corner = corner_of(face);
    fan.faces.push_back(face);
    fan.ring.push_back(topology.triangles[face][(corner + 1) % 3]);
    corners.push_back(corner);
    face = FaceAcross(topology, face, topology.face_edges[face][(corner + 1) % 3]);
  }
  const std::vector<Vec2d> chart = FlattenFan(positions[v], fan, positions);
  const size_t k = chart.size();
  if (!IsStarShaped(chart, k)) return false;
  const Vec2d &first = chart[0], &second = chart[1];
  const double wa = now.barycentric[(corners[0] + 1) % 3], wb = now.barycentric[(corners[0] + 2) % 3];
  const Vec2d center = {wa * first.x + wb * second.x, wa * first.y + wb * second.y};
  Move move;
  move.faces = fan.faces;
  for (size_t i = 0; i < k; ++i) {
    const Vec2d &a = chart[i], &b = chart[(i + 1) % k];
    if (!(DoubledArea(center, a, b) > kLeastArea * DoubledArea({}, a, b))) return false;
    for (std::vector<Corners>* triangles : {&move.before, &move.after}) {
      Corners t;
      t[corners[i]] = triangles == &move.before ? Vec2d{} : center;
      t[(corners[i] + 1) % 3] = a;
      t[(corners[i] + 2) % 3] = b;
      triangles->push_back(t);
    }
  }
  Append(std::move(move));
  return true;
}

bool DomainMoves::Flip(uint32_t edge, const Topology& topology, const std::vector<Vec3d>& positions) {
  constexpr double kLeastShare = 0.15;  // of the quadrangle that either new triangle has
  if (topology.is_border(edge)) return false;
  const EdgeQuad q(topology, edge);
  const Vec3d &a = positions[q.a], &b = positions[q.b];
  const Vec3d along = Normalized(b - a);
  const auto unfolded = [&](const Vec3d& p, double side) {
    const double x = Dot(p - a, along);
    return Vec2d{x, side * Norm(p - a - along * x)};
  };
  const Vec2d flat_a{}, flat_b{Norm(b - a), 0.0}, flat_c = unfolded(positions[q.c], 1.0), flat_d = unfolded(positions[q.d], -1.0);
  const double area_a = DoubledArea(flat_c, flat_a, flat_d), area_b = DoubledArea(flat_d, flat_b, flat_c);
  if (!(std::min(area_a, area_b) > kLeastShare * (area_a + area_b))) return false;
  Move move{{q.f, q.g}, std::vector<Corners>(2), std::vector<Corners>(2)};
  const auto set = [](int corner, const Vec2d& first, const Vec2d& second, const Vec2d& third, Corners* corners) {
    (*corners)[corner] = first;
    (*corners)[(corner + 1) % 3] = second;
    (*corners)[(corner + 2) % 3] = third;
  };
  set(q.at_c, flat_c, flat_a, flat_b, &move.before[0]);
  set(q.at_d, flat_d, flat_b, flat_a, &move.before[1]);
  set(q.at_c, flat_c, flat_a, flat_d, &move.after[0]);
  set(q.at_d, flat_d, flat_b, flat_c, &move.after[1]);
  Append(std::move(move));
  return true;
}

void DomainMoves::Append(Move move) {
  for (const uint32_t f : move.faces) moves_of_face_[f].push_back(static_cast<uint32_t>(moves_.size()));
  moves_.push_back(std::move(move));
}

// A point of one of the faces, which has `from` in the chart, as one of those that have `to`.
DomainPoint DomainMoves::Moved(const DomainPoint& point, const std::vector<uint32_t>& faces, const std::vector<Corners>& from, const std::vector<Corners>& to) {
  const Corners& t = from[static_cast<size_t>(std::find(faces.begin(), faces.end(), point.face) - faces.begin())];
  Vec2d place;
  for (size_t k = 0; k < 3; ++k) place = {place.x + point.barycentric[static_cast<int>(k)] * t[k].x, place.y + point.barycentric[static_cast<int>(k)] * t[k].y};
  const PlaceInTriangles found = FindInTriangles(place, static_cast<int>(faces.size()), [&](int i) { return to[static_cast<size_t>(i)]; });
  return {faces[static_cast<size_t>(found.triangle)], found.weights};
}

DomainPoint DomainMoves::Forward(DomainPoint point) const {
  for (uint32_t first = 0;;) {  // of the moves that are still to come
    const std::vector<uint32_t>& moves = moves_of_face_[point.face];
    const auto next = std::lower_bound(moves.begin(), moves.end(), first);
    if (next == moves.end()) return point;
    const Move& move = moves_[*next];
    point = Moved(point, move.faces, move.before, move.after);
    first = *next + 1;
  }
}

DomainPoint DomainMoves::Backward(DomainPoint point) const {
  for (auto end = static_cast<uint32_t>(moves_.size());;) {
    const std::vector<uint32_t>& moves = moves_of_face_[point.face];
    const auto next = std::lower_bound(moves.begin(), moves.end(), end);
    if (next == moves.begin()) return point;
    const Move& move = moves_[*(next - 1)];
    point = Moved(point, move.faces, move.after, move.before);
    end = *(next - 1);
  }
}

}  // namespace lacerta
