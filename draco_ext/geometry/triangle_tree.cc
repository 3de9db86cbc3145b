#include "geometry/triangle_tree.h"

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <utility>

namespace lacerta {
namespace {

constexpr int kLeafSize = 4;
constexpr int kNumBins = 16;
// From this depth on ranges are halved, which bounds the depth: the stack of a query never overflows.
constexpr int kMaxHeuristicDepth = 24;
// Halving 2^32 faces twice per level ends after 16 more; each level leaves at most three children waiting.
constexpr int kStackSize = 3 * (kMaxHeuristicDepth + 17);
// Boxes are compared in float, triangles in double: relative slack for the rounding of a squared box distance.
constexpr float kBoxSlack = 1.0f + 2e-6f;

bool IsUsable(const Vec3f& p) {
  // Written so that NaN is refused.
  return std::fabs(p.x) <= TriangleTree::kMaxCoordinate && std::fabs(p.y) <= TriangleTree::kMaxCoordinate &&
         std::fabs(p.z) <= TriangleTree::kMaxCoordinate;
}

struct Box {
  Vec3f min{FLT_MAX, FLT_MAX, FLT_MAX};
  Vec3f max{-FLT_MAX, -FLT_MAX, -FLT_MAX};

  void Add(const Vec3f& p) {
    min = {std::min(min.x, p.x), std::min(min.y, p.y), std::min(min.z, p.z)};
    max = {std::max(max.x, p.x), std::max(max.y, p.y), std::max(max.z, p.z)};
  }
  void Add(const Box& b) {
    min = {std::min(min.x, b.min.x), std::min(min.y, b.min.y), std::min(min.z, b.min.z)};
    max = {std::max(max.x, b.max.x), std::max(max.y, b.max.y), std::max(max.z, b.max.z)};
  }
  // Half the surface; 0 for an empty box.
  float HalfArea() const {
    const Vec3f d = max - min;
    return d.x < 0.0f ? 0.0f : d.x * d.y + d.y * d.z + d.z * d.x;
  }
};

// The point of a triangle closest to some p, as weights of the corners b and c.
struct TrianglePoint {
  double b = 0.0, c = 0.0;
  double squared_distance = 0.0;
};

// Closest to p on the segment from `start` to start + d, all relative to p: parameter in [0, 1] and squared distance.
std::pair<double, double> ClosestOnSegment(const Vec3d& start, const Vec3d& d) {
  const double length2 = SquaredNorm(d);
  const double along = -Dot(start, d);
  const double t = along <= 0.0 || length2 <= 0.0 ? 0.0 : along >= length2 ? 1.0 : along / length2;
  return {t, SquaredNorm(start + d * t)};
}

// False where the triangle is certainly not closer than sqrt(bound2). Differences of float coordinates are exact in
// double and so are, all but the last bit, the products in `normal`: thin triangles and small distances to large
// triangles stay accurate. A projection outside the triangle is closest to one of the edges that it is outside of.
bool ClosestOnTriangle(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c, double bound2,
                       TrianglePoint* out) {
  const Vec3d pa = a - p, pb = b - p, pc = c - p;
  const Vec3d ab = b - a, ac = c - a, bc = c - b;
  const Vec3d normal = Cross(ab, ac);
  const double area2 = SquaredNorm(normal);
  const double height = Dot(pa, normal);
  if (height * height > bound2 * area2) return false;
  const double side_ab = Dot(Cross(pa, pb), normal);
  const double side_bc = Dot(Cross(pb, pc), normal);
  const double side_ca = Dot(Cross(pc, pa), normal);
  const bool degenerate = !(area2 > 0.0);
  if (!degenerate && side_ab >= 0.0 && side_bc >= 0.0 && side_ca >= 0.0) {
    *out = {side_ca / area2, side_ab / area2, height * height / area2};
    return true;
  }
  out->squared_distance = std::numeric_limits<double>::infinity();
  if (degenerate || side_ab < 0.0) {
    const auto [t, d2] = ClosestOnSegment(pa, ab);
    if (d2 < out->squared_distance) *out = {t, 0.0, d2};
  }
  if (degenerate || side_bc < 0.0) {
    const auto [t, d2] = ClosestOnSegment(pb, bc);
    if (d2 < out->squared_distance) *out = {1.0 - t, t, d2};
  }
  if (degenerate || side_ca < 0.0) {
    const auto [t, d2] = ClosestOnSegment(pa, ac);
    if (d2 < out->squared_distance) *out = {0.0, t, d2};
  }
  return true;
}

struct StackEntry {
  float squared_distance;
  uint32_t child;
  uint32_t count;
};

}  // namespace

struct TriangleTree::Reference {
  Box box;
  uint32_t face;
  Vec3f Center() const { return (box.min + box.max) * 0.5f; }
};

struct TriangleTree::Search {
  Vec3f p;
  Vec3d pd;
  double bound2;     // squared distance to beat
  float box_bound2;  // the same for boxes, with slack
  uint32_t slot = SurfacePoint::kNone;
  TrianglePoint best;

  void SetBound(double squared_distance) {
    bound2 = squared_distance;
    box_bound2 = std::min(static_cast<float>(squared_distance) * kBoxSlack, FLT_MAX);
    // Where the square underflows, boxes that touch p must still be opened.
    box_bound2 = std::max(box_bound2, FLT_MIN);
  }
};

TriangleTree::TriangleTree(const TriangleMesh& mesh) {
  std::vector<Reference> references;
  references.reserve(mesh.triangles.size());
  slots_.assign(mesh.triangles.size(), SurfacePoint::kNone);
  float largest = 0.0f;
  for (uint32_t f = 0; f < mesh.triangles.size(); ++f) {
    Reference reference;
    reference.face = f;
    bool usable = true;
    for (const uint32_t v : mesh.triangles[f]) {
      usable = usable && v < mesh.positions.size() && IsUsable(mesh.positions[v]);
      if (usable) reference.box.Add(mesh.positions[v]);
    }
    if (!usable) continue;
    for (int k = 0; k < 3; ++k) {
      largest = std::max({largest, std::fabs(reference.box.min[k]), std::fabs(reference.box.max[k])});
    }
    references.push_back(reference);
  }
  if (references.empty()) return;
  padding_ = std::max(largest * 0x1p-22f, FLT_MIN);
  nodes_.reserve(references.size() / 2 + 1);
  BuildNode(references.data(), references.data() + references.size(), references.data(), 0);
  triangles_.reserve(references.size());
  faces_.reserve(references.size());
  for (const Reference& reference : references) {
    const Triangle& t = mesh.triangles[reference.face];
    slots_[reference.face] = static_cast<uint32_t>(faces_.size());
    faces_.push_back(reference.face);
    triangles_.push_back({mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]});
  }
}

namespace {

// Splits [first, last), at least two of them, into two parts that are not empty, and returns where.
template <typename Reference>
Reference* Split(Reference* first, Reference* last, bool halve) {
  Box centers;
  for (const Reference* r = first; r != last; ++r) centers.Add(r->Center());
  const Vec3f extent = centers.max - centers.min;
  const int widest = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
  if (!halve && extent[widest] > 0.0f) {
    float best_cost = FLT_MAX;
    int best_axis = -1, best_bin = 0;
    const auto bin_of = [&](const Reference& r, int axis) {
      const float share = (r.Center()[axis] - centers.min[axis]) / extent[axis];
      return std::min(static_cast<int>(share * kNumBins), kNumBins - 1);
    };
    for (int axis = 0; axis < 3; ++axis) {
      // Axes along which the range is thin seldom win.
      if (!(extent[axis] > 0.1f * extent[widest])) continue;
      Box boxes[kNumBins];
      uint32_t counts[kNumBins] = {};
      for (const Reference* r = first; r != last; ++r) {
        const int bin = bin_of(*r, axis);
        boxes[bin].Add(r->box);
        ++counts[bin];
      }
      float cost_after[kNumBins];  // of the bins from k on
      Box after;
      uint32_t num_after = 0;
      for (int k = kNumBins - 1; k > 0; --k) {
        after.Add(boxes[k]);
        num_after += counts[k];
        cost_after[k] = after.HalfArea() * static_cast<float>(num_after);
      }
      Box before;
      uint32_t num_before = 0;
      for (int k = 1; k < kNumBins; ++k) {
        before.Add(boxes[k - 1]);
        num_before += counts[k - 1];
        const float cost = before.HalfArea() * static_cast<float>(num_before) + cost_after[k];
        if (num_before > 0 && num_before < last - first && cost < best_cost) {
          best_cost = cost;
          best_axis = axis;
          best_bin = k;
        }
      }
    }
    if (best_axis >= 0) {
      return std::partition(first, last, [&](const Reference& r) { return bin_of(r, best_axis) < best_bin; });
    }
  }
  Reference* middle = first + (last - first) / 2;
  std::nth_element(first, middle, last, [widest](const Reference& a, const Reference& b) {
    const float x = a.Center()[widest], y = b.Center()[widest];
    return x != y ? x < y : a.face < b.face;
  });
  return middle;
}

}  // namespace

uint32_t TriangleTree::BuildNode(Reference* first, Reference* last, const Reference* all, int depth) {
  const bool halve = depth >= kMaxHeuristicDepth;
  // The ends of up to four parts: two, then each of them again in two.
  Reference* ends[kWidth + 1] = {first, last};
  int num_parts = 1;
  const auto split_part = [&](int part) {
    if (ends[part + 1] - ends[part] <= kLeafSize) return;
    Reference* middle = Split(ends[part], ends[part + 1], halve);
    for (int k = num_parts; k > part; --k) ends[k + 1] = ends[k];
    ends[part + 1] = middle;
    ++num_parts;
  };
  split_part(0);
  if (num_parts == 2) {
    split_part(1);
    split_part(0);
  }
  const uint32_t index = static_cast<uint32_t>(nodes_.size());
  nodes_.emplace_back();
  for (int k = 0; k < kWidth; ++k) {
    Box box;
    uint32_t child = 0, count = 0;
    if (k < num_parts) {
      for (const Reference* r = ends[k]; r != ends[k + 1]; ++r) box.Add(r->box);
      const Vec3f padding{padding_, padding_, padding_};
      box.min -= padding;
      box.max += padding;
      if (ends[k + 1] - ends[k] <= kLeafSize) {
        child = static_cast<uint32_t>(ends[k] - all);
        count = static_cast<uint32_t>(ends[k + 1] - ends[k]);
      } else {
        child = BuildNode(ends[k], ends[k + 1], all, depth + 1);
      }
    }
    // A missing child keeps the empty box, which is infinitely far and which no line meets.
    Node& node = nodes_[index];
    for (int axis = 0; axis < 3; ++axis) {
      node.min[axis][k] = box.min[axis];
      node.max[axis][k] = box.max[axis];
    }
    node.child[k] = child;
    node.count[k] = count;
  }
  return index;
}

void TriangleTree::TestSlot(uint32_t slot, Search* search) const {
  const Corners& t = triangles_[slot];
  TrianglePoint point;
  if (!ClosestOnTriangle(search->pd, Vec3Cast<double>(t.a), Vec3Cast<double>(t.b), Vec3Cast<double>(t.c),
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

void TriangleTree::Traverse(Search* search) const {
  if (nodes_.empty()) return;
  const float px = search->p.x, py = search->p.y, pz = search->p.z;
  StackEntry stack[kStackSize];
  int size = 0;
  uint32_t current = 0;
  while (true) {
    const Node& node = nodes_[current];
    float d2[kWidth];
    for (int k = 0; k < kWidth; ++k) {
      const float x = std::max(std::max(node.min[0][k] - px, px - node.max[0][k]), 0.0f);
      const float y = std::max(std::max(node.min[1][k] - py, py - node.max[1][k]), 0.0f);
      const float z = std::max(std::max(node.min[2][k] - pz, pz - node.max[2][k]), 0.0f);
      d2[k] = x * x + y * y + z * z;
    }
    // The children in reach go on the stack, the nearest on top.
    const int bottom = size;
    for (int k = 0; k < kWidth; ++k) {
      if (!(d2[k] < search->box_bound2)) continue;
      int at = size++;
      for (; at > bottom && stack[at - 1].squared_distance < d2[k]; --at) stack[at] = stack[at - 1];
      stack[at] = {d2[k], node.child[k], node.count[k]};
    }
    // Leaves are searched as they come up; the first node in reach is next.
    while (true) {
      if (size == 0) return;
      const StackEntry& top = stack[--size];
      if (!(top.squared_distance < search->box_bound2)) continue;
      if (top.count == 0) {
        current = top.child;
        break;
      }
      for (uint32_t slot = top.child; slot < top.child + top.count; ++slot) TestSlot(slot, search);
    }
  }
}

ClosestPointResult TriangleTree::Finish(const Search& search) const {
  ClosestPointResult result;
  if (search.slot == SurfacePoint::kNone) return result;
  const Corners& t = triangles_[search.slot];
  const double b = search.best.b, c = search.best.c, a = std::max(1.0 - b - c, 0.0);
  result.point.face = faces_[search.slot];
  result.point.barycentric = {static_cast<float>(a), static_cast<float>(b), static_cast<float>(c)};
  const Vec3d corner = Vec3Cast<double>(t.a);
  result.point.position =
      Vec3Cast<float>(corner + (Vec3Cast<double>(t.b) - corner) * b + (Vec3Cast<double>(t.c) - corner) * c);
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

namespace {

// A line prepared as in [Woop et al. 2013]: axes permuted so that z is where the direction is longest, then sheared so
// that it becomes the z axis. Every vertex goes through the same arithmetic in all its triangles, and the edge
// functions of the two triangles at an edge are exact negatives: no line slips through between them.
struct ShearedLine {
  int x, y, z;
  double shear_x, shear_y, scale_z;
  Vec3d origin;

  ShearedLine(const Vec3d& line_origin, const Vec3d& direction) : origin(line_origin) {
    const double dx = std::fabs(direction.x), dy = std::fabs(direction.y), dz = std::fabs(direction.z);
    z = dx >= dy && dx >= dz ? 0 : dy >= dz ? 1 : 2;
    x = (z + 1) % 3;
    y = (z + 2) % 3;
    shear_x = direction[x] / direction[z];
    shear_y = direction[y] / direction[z];
    scale_z = 1.0 / direction[z];
  }

  Vec3d Map(const Vec3f& p) const {
    const Vec3d d = Vec3Cast<double>(p) - origin;
    return {d[x] - shear_x * d[z], d[y] - shear_y * d[z], scale_z * d[z]};
  }
};

}  // namespace

void TriangleTree::IntersectLine(const Vec3f& origin, const Vec3f& direction, float t_min, float t_max,
                                 std::vector<LineHit>* hits) const {
  if (nodes_.empty() || !IsUsable(origin) || !IsUsable(direction) || direction == Vec3f{} || !(t_min <= t_max)) return;
  const Vec3d origin_d = Vec3Cast<double>(origin), direction_d = Vec3Cast<double>(direction);
  const ShearedLine line(origin_d, direction_d);
  // Boxes are padded, so that an origin in the plane of a side is inside; any large number then serves as 1 / 0.
  Vec3d inverse;
  for (int axis = 0; axis < 3; ++axis) inverse[axis] = direction_d[axis] == 0.0 ? 1e200 : 1.0 / direction_d[axis];
  uint32_t stack[kStackSize];
  int size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const Node& node = nodes_[stack[--size]];
    for (int k = 0; k < kWidth; ++k) {
      if (node.min[0][k] > node.max[0][k]) continue;  // a missing child
      double enter = t_min, leave = t_max;
      for (int axis = 0; axis < 3; ++axis) {
        const double t0 = (node.min[axis][k] - origin_d[axis]) * inverse[axis];
        const double t1 = (node.max[axis][k] - origin_d[axis]) * inverse[axis];
        enter = std::max(enter, std::min(t0, t1));
        leave = std::min(leave, std::max(t0, t1));
      }
      // Slack for the rounding of the quotients.
      if (enter - leave > 1e-14 * (std::fabs(enter) + std::fabs(leave))) continue;
      if (node.count[k] == 0) {
        stack[size++] = node.child[k];
        continue;
      }
      for (uint32_t slot = node.child[k]; slot < node.child[k] + node.count[k]; ++slot) {
        const Vec3d a = line.Map(triangles_[slot].a), b = line.Map(triangles_[slot].b),
                    c = line.Map(triangles_[slot].c);
        const double u = c.x * b.y - c.y * b.x, v = a.x * c.y - a.y * c.x, w = b.x * a.y - b.y * a.x;
        if ((u < 0.0 || v < 0.0 || w < 0.0) && (u > 0.0 || v > 0.0 || w > 0.0)) continue;
        const double sum = u + v + w;
        if (sum == 0.0) continue;
        const double t = (u * a.z + v * b.z + w * c.z) / sum;
        if (!(t >= t_min && t <= t_max)) continue;
        LineHit hit;
        hit.t = static_cast<float>(t);
        hit.point.face = faces_[slot];
        hit.point.barycentric = {static_cast<float>(u / sum), static_cast<float>(v / sum), static_cast<float>(w / sum)};
        hit.point.position = Vec3Cast<float>(origin_d + direction_d * t);
        hits->push_back(hit);
      }
    }
  }
}

}  // namespace lacerta
