#include "remesh/domain_slides.h"

#include <algorithm>
#include <utility>

namespace lacerta {

DomainSlides::DomainSlides(const Topology& topology)
    : triangles_(topology.triangles), first_face_(topology.num_vertices, kNone), stars_(topology.num_vertices) {
  for (uint32_t f = 0; f < triangles_.size(); ++f) {
    for (const uint32_t v : triangles_[f]) first_face_[v] = std::min(first_face_[v], f);
  }
}

bool DomainSlides::Move(uint32_t v, const DomainPoint& to, const Topology& topology, const std::vector<Vec3d>& positions) {
  constexpr double kLeastArea = 0.1;  // of a triangle, over what it was
  Star star;
  for (uint32_t face = first_face_[v]; star.fan.faces.empty() || face != first_face_[v];) {
    if (face == kNone) return false;
    const Triangle& t = triangles_[face];
    const int corner = t[0] == v ? 0 : t[1] == v ? 1 : 2;
    star.fan.faces.push_back(face);
    star.fan.ring.push_back(t[(corner + 1) % 3]);
    star.corners.push_back(static_cast<uint8_t>(corner));
    face = FaceAcross(topology, face, topology.face_edges[face][(corner + 1) % 3]);
  }
  star.chart = FlattenFan(positions[v], star.fan, positions);
  const size_t k = star.chart.size();
  if (!IsStarShaped(star.chart, k)) return false;
  const DomainPoint now = Forward(to);
  if (std::find(star.fan.faces.begin(), star.fan.faces.end(), now.face) == star.fan.faces.end()) return false;
  star.center = Place(star, now, {});
  for (size_t i = 0; i < k; ++i) {
    const Vec2d &a = star.chart[i], &b = star.chart[(i + 1) % k];
    if (!(DoubledArea(star.center, a, b) > kLeastArea * DoubledArea({}, a, b))) return false;
  }
  stars_[v] = std::move(star);
  return true;
}

// Of a point of one of the faces, with the vertex at `center`.
Vec2d DomainSlides::Place(const Star& star, const DomainPoint& point, const Vec2d& center) {
  const auto i = static_cast<size_t>(std::find(star.fan.faces.begin(), star.fan.faces.end(), point.face) - star.fan.faces.begin());
  const int corner = star.corners[i];
  const double w = point.barycentric[corner], wa = point.barycentric[(corner + 1) % 3], wb = point.barycentric[(corner + 2) % 3];
  const Vec2d &a = star.chart[i], &b = star.chart[(i + 1) % star.chart.size()];
  return {w * center.x + wa * a.x + wb * b.x, w * center.y + wa * a.y + wb * b.y};
}

DomainPoint DomainSlides::At(const Star& star, const Vec2d& place, const Vec2d& center) {
  const int k = star.fan.size();
  const PlaceInFan found = FindInFan(place, center, star.chart.data(), k, k);
  const auto i = static_cast<size_t>(found.face);
  DomainPoint point{star.fan.faces[i], {}};
  for (int corner = 0; corner < 3; ++corner) point.barycentric[(star.corners[i] + corner) % 3] = found.weights[corner];
  return point;
}

DomainPoint DomainSlides::Forward(DomainPoint point) const {
  for (uint32_t first = 0;;) {  // of the vertices whose moves are still to come
    uint32_t next = kNone;
    for (const uint32_t v : triangles_[point.face]) {
      if (v >= first && has_moved(v)) next = std::min(next, v);
    }
    if (next == kNone) return point;
    const Star& star = stars_[next];
    point = At(star, Place(star, point, {}), star.center);
    first = next + 1;
  }
}

DomainPoint DomainSlides::Backward(DomainPoint point) const {
  for (auto end = static_cast<uint32_t>(stars_.size());;) {
    uint32_t next = kNone;
    for (const uint32_t v : triangles_[point.face]) {
      if (v < end && has_moved(v)) next = next == kNone ? v : std::max(next, v);
    }
    if (next == kNone) return point;
    const Star& star = stars_[next];
    point = At(star, Place(star, point, star.center), {});
    end = next;
  }
}

}  // namespace lacerta
