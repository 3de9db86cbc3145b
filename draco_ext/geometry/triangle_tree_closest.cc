#include <algorithm>
#include <cfloat>
#include <cmath>
#include <cstddef>

#include "geometry/closest_on_triangle.h"
#include "geometry/triangle_tree.h"

namespace lacerta {
namespace {

// Boxes are compared in float, triangles in double: relative slack for the rounding of a squared box distance.
constexpr float kBoxSlack = 1.0f + 2e-6f;

struct StackEntry {
  float squared_distance;
  uint32_t child;
  uint32_t count;
};

}  // namespace

struct TriangleTree::Search {
  Vec3f p;
  Vec3d pd;
  double bound2;     // squared distance to beat
  float box_bound2;  // the same for boxes, with slack
  uint32_t slot = SurfacePoint::kNone;
  ClosestWeights best;

  void SetBound(double squared_distance) {
    bound2 = squared_distance;
    box_bound2 = std::min(static_cast<float>(squared_distance) * kBoxSlack, FLT_MAX);
    // Where the square underflows, boxes that touch p must still be opened.
    box_bound2 = std::max(box_bound2, FLT_MIN);
  }
};

// Lower bounds of the squared distances of a point to four triangles in a row. In float and for all four at once: most of those that a query
// comes across are ruled out so, at a fraction of the time that an exact look at them takes.
//
// Four times the area squared, the squared distance is at least height^2 + beyond^2: that to the plane and, in the plane, that to the line of a
// side beyond which the point lies. Differences of coordinates are right but for the last bit, u = 2^-24; what comes of that is at most
// some 20 u s^(3/2) in either distance, where s bounds the squares of all lengths. 3 % and 4e-10 s^3 of the squares are slack enough.
// Lengths are scaled to the size of the mesh: nothing underflows that counts.
void TriangleTree::LowerBounds(uint32_t first, const Vec3f& point, std::array<float, kLeafSize>* bounds) const {
  constexpr int kCount = kLeafSize;
  constexpr float kShare = 0.97f, kSlack = 4e-10f, kTiny = 1e-30f;
  using Lanes = float[kCount];  // plain loops over them, which the compiler takes in one step
  const Corners* const t = &corners_[first];
  Lanes pa[3], ab[3], ac[3], bc[3], n[3];
  for (int axis = 0; axis < 3; ++axis) {
    for (int k = 0; k < kCount; ++k) {
      const float a = t[k][0][axis], b = t[k][1][axis], c = t[k][2][axis];
      pa[axis][k] = (a - point[axis]) * scale_;
      ab[axis][k] = (b - a) * scale_;
      ac[axis][k] = (c - a) * scale_;
      bc[axis][k] = (c - b) * scale_;
    }
  }
  for (int k = 0; k < kCount; ++k) {
    n[0][k] = ab[1][k] * ac[2][k] - ab[2][k] * ac[1][k];
    n[1][k] = ab[2][k] * ac[0][k] - ab[0][k] * ac[2][k];
    n[2][k] = ab[0][k] * ac[1][k] - ab[1][k] * ac[0][k];
  }
  Lanes beyond2 = {};
  const auto look_beyond = [&](const Lanes (&corner)[3], const Lanes (&edge)[3], float sign) {
    for (int k = 0; k < kCount; ++k) {
      const float side = sign * (n[0][k] * (corner[1][k] * edge[2][k] - corner[2][k] * edge[1][k]) +
                                 n[1][k] * (corner[2][k] * edge[0][k] - corner[0][k] * edge[2][k]) +
                                 n[2][k] * (corner[0][k] * edge[1][k] - corner[1][k] * edge[0][k]));
      const float length2 = edge[0][k] * edge[0][k] + edge[1][k] * edge[1][k] + edge[2][k] * edge[2][k];
      const float outside = side - std::fabs(side);  // twice that, or 0
      const float square = 0.25f * outside * outside / length2;
      beyond2[k] = square > beyond2[k] ? square : beyond2[k];
    }
  };
  look_beyond(pa, ab, 1.0f);
  look_beyond(pa, ac, -1.0f);
  Lanes ab2, pb[3];
  for (int k = 0; k < kCount; ++k) {
    ab2[k] = ab[0][k] * ab[0][k] + ab[1][k] * ab[1][k] + ab[2][k] * ab[2][k];
    for (int axis = 0; axis < 3; ++axis) pb[axis][k] = pa[axis][k] + ab[axis][k];
  }
  look_beyond(pb, bc, 1.0f);
  const float unscaled = 1 / (scale_ * scale_);
  Lanes bound;
  for (int k = 0; k < kCount; ++k) {
    const float normal2 = n[0][k] * n[0][k] + n[1][k] * n[1][k] + n[2][k] * n[2][k];
    const float height = pa[0][k] * n[0][k] + pa[1][k] * n[1][k] + pa[2][k] * n[2][k];
    const float pa2 = pa[0][k] * pa[0][k] + pa[1][k] * pa[1][k] + pa[2][k] * pa[2][k];
    const float ac2 = ac[0][k] * ac[0][k] + ac[1][k] * ac[1][k] + ac[2][k] * ac[2][k];
    const float s = pa2 + ab2[k] + ac2;
    bound[k] = (kShare * (height * height + beyond2[k]) - kSlack * s * s * s - kTiny) / normal2 * unscaled;
  }
  for (int k = 0; k < kCount; ++k) (*bounds)[k] = bound[k] > 0 ? bound[k] : 0;  // degenerate ones have none: NaN
}

void TriangleTree::TestLeaf(uint32_t first, uint32_t count, Search* search) const {
  if (!AreWorthBounds(first, count)) {
    for (uint32_t slot = first; slot < first + count; ++slot) TestSlot(slot, search);
    return;
  }
  std::array<float, kLeafSize> bounds;
  LowerBounds(first, search->p, &bounds);
  for (uint32_t i = 0; i < count; ++i) {  // the nearest first
    uint32_t nearest = count;
    float least = search->box_bound2;
    for (uint32_t k = 0; k < count; ++k) {
      if (bounds[k] >= least) continue;
      least = bounds[k];
      nearest = k;
    }
    if (nearest == count) return;
    TestSlot(first + nearest, search);
    bounds[nearest] = std::numeric_limits<float>::infinity();
  }
}

void TriangleTree::TestSlot(uint32_t slot, Search* search) const {
  const Corners& t = corners_[slot];
  ClosestWeights point;
  if (!ClosestOnTriangle(search->pd, Vec3Cast<double>(t[0]), Vec3Cast<double>(t[1]), Vec3Cast<double>(t[2]),
                         search->bound2, &point)) {
    return;
  }
  const bool first = search->slot == SurfacePoint::kNone;
  if (point.squared_distance < search->bound2 || (first && point.squared_distance <= search->bound2)) {
    search->SetBound(point.squared_distance);
    search->slot = slot;
    search->best = point;
  }
}

template <typename Visit>
void TriangleTree::VisitLeaves(const Vec3f& point, const float& max_squared_distance, const Visit& visit) const {
  if (nodes_.empty()) return;
  StackEntry stack[kStackSize];
  int size = 0;
  uint32_t current = 0;
  while (true) {
    const Node& node = nodes_[current];
    float d2[kWidth];
    node.SquaredDistances(point, d2);
    // The children in reach go on the stack, the nearest on top.
    const int bottom = size;
    for (int k = 0; k < kWidth; ++k) {
      if (!(d2[k] < max_squared_distance)) continue;
      int at = size++;
      for (; at > bottom && stack[at - 1].squared_distance < d2[k]; --at) stack[at] = stack[at - 1];
      stack[at] = {d2[k], node.child[k], node.count[k]};
    }
    // Leaves are visited as they come up; the first node in reach is next.
    while (true) {
      if (size == 0) return;
      const StackEntry& top = stack[--size];
      if (!(top.squared_distance < max_squared_distance)) continue;
      if (top.count == 0) {
        current = top.child;
        break;
      }
      visit(top.child, top.count);
    }
  }
}

void TriangleTree::Traverse(Search* search) const {
  VisitLeaves(search->p - origin_, search->box_bound2, [&](uint32_t first, uint32_t count) { TestLeaf(first, count, search); });
}

ClosestPointResult TriangleTree::Finish(const Search& search) const {
  ClosestPointResult result;
  if (search.slot == SurfacePoint::kNone) return result;
  const Corners& t = corners_[search.slot];
  const double b = search.best.b, c = search.best.c, a = std::max(1.0 - b - c, 0.0);
  result.point.face = faces_[search.slot];
  result.point.barycentric = {static_cast<float>(a), static_cast<float>(b), static_cast<float>(c)};
  const Vec3d corner = Vec3Cast<double>(t[0]);
  result.point.position =
      Vec3Cast<float>(corner + (Vec3Cast<double>(t[1]) - corner) * b + (Vec3Cast<double>(t[2]) - corner) * c);
  result.squared_distance = static_cast<float>(search.best.squared_distance);
  return result;
}

ClosestPointResult TriangleTree::ClosestPoint(const Vec3f& p, float max_squared_distance) const {
  if (!IsUsable(p) || !(max_squared_distance >= 0.0f)) return {};
  Search search;
  search.p = p;
  search.pd = Vec3Cast<double>(p);
  search.SetBound(max_squared_distance);
  Traverse(&search);
  return Finish(search);
}

ClosestPointResult TriangleTree::ClosestPointNear(const Vec3f& p, uint32_t hint) const {
  if (!IsUsable(p)) return {};
  Search search;
  search.p = p;
  search.pd = Vec3Cast<double>(p);
  search.SetBound(std::numeric_limits<double>::infinity());
  if (hint < slots_.size() && slots_[hint] != SurfacePoint::kNone) TestSlot(slots_[hint], &search);
  Traverse(&search);
  return Finish(search);
}

bool TriangleTree::IsNear(const Vec3f& p, float max_squared_distance) const {
  if (!IsUsable(p) || !(max_squared_distance >= 0.0f)) return false;
  Search search;
  search.p = p;
  search.pd = Vec3Cast<double>(p);
  search.SetBound(max_squared_distance);
  VisitLeaves(p - origin_, search.box_bound2, [&](uint32_t first, uint32_t count) {
    for (uint32_t slot = first; slot < first + count && search.slot == SurfacePoint::kNone; ++slot) TestSlot(slot, &search);
    if (search.slot != SurfacePoint::kNone) search.box_bound2 = -1;  // nothing else is in reach then
  });
  return search.slot != SurfacePoint::kNone;
}

void TriangleTree::PointsNear(const Vec3f& p, float max_squared_distance, size_t max_points,
                              std::vector<ClosestPointResult>* points) const {
  if (max_points == 0 || !IsUsable(p) || !(max_squared_distance >= 0.0f)) return;
  Search search;
  search.p = p;
  search.pd = Vec3Cast<double>(p);
  search.SetBound(max_squared_distance);
  // A heap, the farthest on top, which bounds the search as soon as there are enough.
  const auto first_point = static_cast<std::ptrdiff_t>(points->size());
  const auto is_nearer = [](const ClosestPointResult& a, const ClosestPointResult& b) {
    return a.squared_distance != b.squared_distance ? a.squared_distance < b.squared_distance : a.point.face < b.point.face;
  };
  const auto add = [&](const ClosestPointResult& point) {
    const auto heap = points->begin() + first_point;
    if (static_cast<size_t>(points->end() - heap) == max_points) {
      if (!is_nearer(point, *heap)) return;
      std::pop_heap(heap, points->end(), is_nearer);
      points->pop_back();
    }
    points->push_back(point);
    std::push_heap(points->begin() + first_point, points->end(), is_nearer);
    if (points->size() - static_cast<size_t>(first_point) == max_points) search.SetBound(static_cast<double>((*points)[static_cast<size_t>(first_point)].squared_distance));
  };
  VisitLeaves(p - origin_, search.box_bound2, [&](uint32_t first_slot, uint32_t count) {
    std::array<float, kLeafSize> bounds{};
    if (AreWorthBounds(first_slot, count)) LowerBounds(first_slot, p, &bounds);
    for (uint32_t k = 0; k < count; ++k) {
      if (bounds[k] >= search.box_bound2) continue;
      const Corners& t = corners_[first_slot + k];
      if (ClosestOnTriangle(search.pd, Vec3Cast<double>(t[0]), Vec3Cast<double>(t[1]), Vec3Cast<double>(t[2]), search.bound2,
                            &search.best) &&
          search.best.squared_distance <= search.bound2) {
        search.slot = first_slot + k;
        add(Finish(search));
      }
    }
  });
  std::sort_heap(points->begin() + first_point, points->end(), is_nearer);
}

double TriangleTree::Crowding() const {
  if (nodes_.empty()) return 0.0;
  constexpr size_t kMostPoints = 256;
  constexpr float kInside = FLT_MIN;
  const size_t num_points = std::min(kMostPoints, corners_.size());
  uint64_t faces = 0;
  for (size_t i = 0; i < num_points; ++i) {
    const Corners& t = corners_[i * corners_.size() / num_points];
    const Vec3f point = (t[0] - origin_) * (1 / 3.0f) + (t[1] - origin_) * (1 / 3.0f) + (t[2] - origin_) * (1 / 3.0f);
    VisitLeaves(point, kInside, [&](uint32_t, uint32_t count) { faces += count; });
  }
  return static_cast<double>(faces) / static_cast<double>(num_points);
}

}  // namespace lacerta
