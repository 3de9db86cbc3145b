#include "geometry/triangle_tree.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <cstddef>
#include <utility>

namespace lacerta {
namespace {

constexpr int kMaxBins = 16;
// Ranges at least this long are split by several threads.
constexpr std::ptrdiff_t kParallelSize = 8192;
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

// Faces that two levels of subdivision make of one.
constexpr uint32_t kGroupSize = 16;

// Whether four faces are the children that `Refine` (common/subdivision.h) makes of one face, the middle one last.
bool IsRefinedFace(const Triangle& a, const Triangle& b, const Triangle& c, const Triangle& middle) {
  return a[1] == middle[2] && a[2] == middle[1] && b[1] == middle[0] && b[2] == middle[2] && c[1] == middle[1] && c[2] == middle[0];
}

// Whether the mesh is the second level, or a finer one, of a mesh refined by splitting faces in four, children in a row.
bool IsInOrderOfSubdivision(const std::vector<Triangle>& t) {
  if (t.empty() || t.size() % kGroupSize != 0) return false;
  for (size_t f = 0; f < t.size(); f += 4) {
    if (!IsRefinedFace(t[f], t[f + 1], t[f + 2], t[f + 3])) return false;
  }
  const auto parent = [&](size_t f) { return Triangle{t[f][0], t[f + 1][0], t[f + 2][0]}; };
  for (size_t f = 0; f < t.size(); f += kGroupSize) {
    if (!IsRefinedFace(parent(f), parent(f + 4), parent(f + 8), parent(f + 12))) return false;
  }
  return true;
}

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
  uint32_t face;  // the first one
  Vec3f Center() const { return (box.min + box.max) * 0.5f; }
};

struct TriangleTree::Building {
  const TriangleMesh& mesh;
  const Reference* all;
  bool in_groups;  // of kGroupSize faces
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

namespace {

// The middle of the box of what faces use; zero where there is none.
Vec3f MiddleOf(const TriangleMesh& mesh) {
  Box box;
  for (const Triangle& t : mesh.triangles) {
    for (const uint32_t v : t) {
      if (v < mesh.positions.size() && IsUsable(mesh.positions[v])) box.Add(mesh.positions[v]);
    }
  }
  return box.min * 0.5f + box.max * 0.5f;
}

}  // namespace

TriangleTree::TriangleTree(const TriangleMesh& mesh) {
  slots_.assign(mesh.triangles.size(), SurfacePoint::kNone);
  origin_ = MiddleOf(mesh);
  std::vector<Reference> references;
  float largest = 0.0f;
  const auto refer_to_groups_of = [&](uint32_t size) {  // whether none had to be left out
    references.reserve(mesh.triangles.size() / size);
    bool complete = true;
    for (uint32_t first = 0; first < mesh.triangles.size(); first += size) {
      Reference reference;
      reference.face = first;
      bool usable = true;
      for (uint32_t f = first; f < first + size; ++f) {
        for (const uint32_t v : mesh.triangles[f]) {
          usable = usable && v < mesh.positions.size() && IsUsable(mesh.positions[v]);
          if (usable) reference.box.Add(mesh.positions[v] - origin_);
        }
      }
      complete = complete && usable;
      if (!usable) continue;
      for (int k = 0; k < 3; ++k) {
        largest = std::max({largest, std::fabs(reference.box.min[k]), std::fabs(reference.box.max[k])});
      }
      references.push_back(reference);
    }
    return complete;
  };
  bool in_groups = IsInOrderOfSubdivision(mesh.triangles) && refer_to_groups_of(kGroupSize);
  if (!in_groups) {
    references.clear();
    refer_to_groups_of(1);
  }
  if (references.empty()) return;
  padding_ = std::max(largest * 0x1p-21f, FLT_MIN);
  scale_ = std::ldexp(1.0f, 10 - std::ilogb(padding_ * 0x1p21f));
  const uint32_t group_size = in_groups ? kGroupSize : 1;
  nodes_.reserve(in_groups ? 2 * references.size() : references.size() / 2 + 1);
  BuildNode({mesh, references.data(), in_groups}, references.data(), references.data() + references.size(), 0, &nodes_);
  corners_.reserve(references.size() * group_size);
  faces_.reserve(references.size() * group_size);
  for (const Reference& reference : references) {
    for (uint32_t f = reference.face; f < reference.face + group_size; ++f) {
      const Triangle& t = mesh.triangles[f];
      slots_[f] = static_cast<uint32_t>(faces_.size());
      faces_.push_back(f);
      corners_.push_back({mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]});
    }
  }
}

namespace {

// Splits [first, last), at least two of them, along the widest axis of their centers into two parts that are not empty,
// and returns where. Trying all three axes doubles the time to build and gains queries less than 5 %.
template <typename Reference>
Reference* Split(Reference* first, Reference* last, bool halve) {
  Box centers;
  for (const Reference* r = first; r != last; ++r) centers.Add(r->Center());
  const Vec3f extent = centers.max - centers.min;
  const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
  const int num_bins = static_cast<int>(std::min<std::ptrdiff_t>(last - first, kMaxBins));
  const float bins_per_length = static_cast<float>(num_bins) / extent[axis];
  if (!halve && std::isfinite(bins_per_length)) {
    const auto bin_of = [&](const Reference& r) {
      return std::min(static_cast<int>((r.Center()[axis] - centers.min[axis]) * bins_per_length), num_bins - 1);
    };
    Box boxes[kMaxBins];
    uint32_t counts[kMaxBins] = {};
    for (const Reference* r = first; r != last; ++r) {
      const int bin = bin_of(*r);
      boxes[bin].Add(r->box);
      ++counts[bin];
    }
    float cost_after[kMaxBins];  // of the bins from k on
    Box after;
    uint32_t num_after = 0;
    for (int k = num_bins - 1; k > 0; --k) {
      after.Add(boxes[k]);
      num_after += counts[k];
      cost_after[k] = after.HalfArea() * static_cast<float>(num_after);
    }
    float best_cost = FLT_MAX;
    int best_bin = 0;
    Box before;
    uint32_t num_before = 0;
    for (int k = 1; k < num_bins; ++k) {
      before.Add(boxes[k - 1]);
      num_before += counts[k - 1];
      const float cost = before.HalfArea() * static_cast<float>(num_before) + cost_after[k];
      if (num_before > 0 && num_before < last - first && cost < best_cost) {
        best_cost = cost;
        best_bin = k;
      }
    }
    if (best_bin > 0) return std::partition(first, last, [&](const Reference& r) { return bin_of(r) < best_bin; });
  }
  Reference* middle = first + (last - first) / 2;
  std::nth_element(first, middle, last, [axis](const Reference& a, const Reference& b) {
    const float x = a.Center()[axis], y = b.Center()[axis];
    return x != y ? x < y : a.face < b.face;
  });
  return middle;
}

// The box of child k of a node; a missing child has an empty one.
template <typename Node>
void SetBox(const Box& box, float padding, int k, Node* node) {
  const bool is_missing = box.min.x > box.max.x;
  const Vec3f center = is_missing ? Vec3f() : (box.min + box.max) * 0.5f;
  const Vec3f half_size = is_missing ? Vec3f{-FLT_MAX, -FLT_MAX, -FLT_MAX} : (box.max - box.min) * 0.5f + Vec3f{padding, padding, padding};
  for (int axis = 0; axis < 3; ++axis) {
    node->center[axis][k] = center[axis];
    node->half_size[axis][k] = half_size[axis];
  }
}

}  // namespace

uint32_t TriangleTree::BuildNode(const Building& building, Reference* first, Reference* last, int depth,
                                 std::vector<Node>* nodes) const {
  const std::ptrdiff_t leaf_size = building.in_groups ? 1 : std::ptrdiff_t{kLeafSize};
  const bool halve = depth >= kMaxHeuristicDepth;
  // The ends of up to four parts: two, then each of them again in two.
  Reference* ends[kWidth + 1] = {first, last};
  int num_parts = 1;
  const auto split_part = [&](int part) {
    if (ends[part + 1] - ends[part] <= leaf_size) return;
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

  const auto index = static_cast<uint32_t>(nodes->size());
  nodes->emplace_back();
  const auto is_leaf = [&](int k) { return ends[k + 1] - ends[k] <= leaf_size; };
  uint32_t children[kWidth] = {};
  const auto build_part = [&](int k, std::vector<Node>* to) {
    if (!is_leaf(k)) return BuildNode(building, ends[k], ends[k + 1], depth + 1, to);
    to->push_back(GroupNode(building.mesh, ends[k]->face, static_cast<uint32_t>(ends[k] - building.all) * kGroupSize));
    return static_cast<uint32_t>(to->size() - 1);
  };
  const auto has_node = [&](int k) { return building.in_groups || !is_leaf(k); };
  if (last - first < kParallelSize) {
    for (int k = 0; k < num_parts; ++k) {
      if (has_node(k)) children[k] = build_part(k, nodes);
    }
  } else {
    // Every thread fills its own list; joined in order, they are the same list that one thread would have made.
    std::vector<Node> lists[kWidth];
    tbb::parallel_for(0, num_parts, [&](int k) {
      if (has_node(k)) build_part(k, &lists[k]);
    });
    for (int k = 0; k < num_parts; ++k) {
      const auto offset = static_cast<uint32_t>(nodes->size());
      if (has_node(k)) children[k] = offset;
      for (Node& node : lists[k]) {
        for (int j = 0; j < kWidth; ++j) node.child[j] += node.count[j] == 0 ? offset : 0;
        nodes->push_back(node);
      }
    }
  }

  Node& node = (*nodes)[index];
  for (int k = 0; k < kWidth; ++k) {
    Box box;
    for (const Reference* r = ends[std::min(k, num_parts)]; r != ends[std::min(k + 1, num_parts)]; ++r) box.Add(r->box);
    SetBox(box, padding_, k, &node);
    node.child[k] = children[k];
    node.count[k] = 0;
    if (k < num_parts && !has_node(k)) {
      node.child[k] = static_cast<uint32_t>(ends[k] - building.all);
      node.count[k] = static_cast<uint32_t>(ends[k + 1] - ends[k]);
    }
  }
  return index;
}

// Of four leaves, which hold four faces in a row each.
TriangleTree::Node TriangleTree::GroupNode(const TriangleMesh& mesh, uint32_t first_face, uint32_t first_slot) const {
  constexpr uint32_t kPartSize = kGroupSize / kWidth;
  Node node;
  for (uint32_t k = 0; k < kWidth; ++k) {
    Box box;
    for (uint32_t i = k * kPartSize; i < (k + 1) * kPartSize; ++i) {
      for (const uint32_t v : mesh.triangles[first_face + i]) box.Add(mesh.positions[v] - origin_);
    }
    SetBox(box, padding_, static_cast<int>(k), &node);
    node.child[k] = first_slot + k * kPartSize;
    node.count[k] = kPartSize;
  }
  return node;
}

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
  if (count == 1 || first + kLeafSize > corners_.size()) {
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
  TrianglePoint point;
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

void TriangleTree::Traverse(Search* search) const {
  if (nodes_.empty()) return;
  const Vec3f local = search->p - origin_;
  const float px = local.x, py = local.y, pz = local.z;
  StackEntry stack[kStackSize];
  int size = 0;
  uint32_t current = 0;
  while (true) {
    const Node& node = nodes_[current];
    float d2[kWidth];
    for (int k = 0; k < kWidth; ++k) {
      const float x = std::fabs(node.center[0][k] - px) - node.half_size[0][k];
      const float y = std::fabs(node.center[1][k] - py) - node.half_size[1][k];
      const float z = std::fabs(node.center[2][k] - pz) - node.half_size[2][k];
      // v + |v| is twice max(v, 0), without a branch.
      const float x2 = x + std::fabs(x), y2 = y + std::fabs(y), z2 = z + std::fabs(z);
      d2[k] = 0.25f * (x2 * x2 + y2 * y2 + z2 * z2);
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
      TestLeaf(top.child, top.count, search);
    }
  }
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

template <typename IsWanted, typename Visit>
void TriangleTree::VisitLeaves(const IsWanted& is_wanted, const Visit& visit) const {
  uint32_t stack[kStackSize];
  int size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const Node& node = nodes_[stack[--size]];
    for (int k = 0; k < kWidth; ++k) {
      if (!is_wanted(node, k)) continue;
      if (node.count[k] == 0) {
        stack[size++] = node.child[k];
      } else if (!visit(node.child[k], node.child[k] + node.count[k])) {
        return;
      }
    }
  }
}

void TriangleTree::PointsNear(const Vec3f& p, float max_squared_distance, size_t max_points,
                              std::vector<ClosestPointResult>* points) const {
  if (nodes_.empty() || !IsUsable(p) || !(max_squared_distance >= 0.0f)) return;
  Search search;
  search.p = p;
  search.pd = Vec3Cast<double>(p);
  search.SetBound(max_squared_distance);
  const size_t most = points->size() + max_points;
  const Vec3f local = p - origin_;
  const auto is_near = [&](const Node& node, int k) {
    float d2 = 0.0f;
    for (int axis = 0; axis < 3; ++axis) {
      const float beyond = std::max(std::fabs(node.center[axis][k] - local[axis]) - node.half_size[axis][k], 0.0f);
      d2 += beyond * beyond;
    }
    return d2 < search.box_bound2;
  };
  VisitLeaves(is_near, [&](uint32_t first_slot, uint32_t end_slot) {
    for (uint32_t slot = first_slot; slot < end_slot; ++slot) {
      if (points->size() == most) return false;
      const Corners& t = corners_[slot];
      if (ClosestOnTriangle(search.pd, Vec3Cast<double>(t[0]), Vec3Cast<double>(t[1]), Vec3Cast<double>(t[2]), search.bound2,
                            &search.best) &&
          search.best.squared_distance <= search.bound2) {
        search.slot = slot;
        points->push_back(Finish(search));
      }
    }
    return true;
  });
}

double TriangleTree::Crowding() const {
  if (nodes_.empty()) return 0.0;
  constexpr size_t kMostPoints = 256;
  const size_t num_points = std::min(kMostPoints, corners_.size());
  uint64_t faces = 0;
  for (size_t i = 0; i < num_points; ++i) {
    const Corners& t = corners_[i * corners_.size() / num_points];
    const Vec3f point = (t[0] - origin_) * (1 / 3.0f) + (t[1] - origin_) * (1 / 3.0f) + (t[2] - origin_) * (1 / 3.0f);
    const auto is_inside = [&](const Node& node, int k) {
      bool inside = true;
      for (int axis = 0; axis < 3; ++axis) inside = inside && std::fabs(node.center[axis][k] - point[axis]) <= node.half_size[axis][k];
      return inside;
    };
    VisitLeaves(is_inside, [&](uint32_t first_slot, uint32_t end_slot) {
      faces += end_slot - first_slot;
      return true;
    });
  }
  return static_cast<double>(faces) / static_cast<double>(num_points);
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
  const Vec3d local = origin_d - Vec3Cast<double>(origin_);
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
      if (node.half_size[0][k] < 0.0f) continue;
      double enter = t_min, leave = t_max;
      for (int axis = 0; axis < 3; ++axis) {
        const double middle = (static_cast<double>(node.center[axis][k]) - local[axis]) * inverse[axis];
        const double half = static_cast<double>(node.half_size[axis][k]) * std::fabs(inverse[axis]);
        enter = std::max(enter, middle - half);
        leave = std::min(leave, middle + half);
      }
      // Slack for the rounding of the quotients.
      if (enter - leave > 1e-14 * (std::fabs(enter) + std::fabs(leave))) continue;
      if (node.count[k] == 0) {
        stack[size++] = node.child[k];
        continue;
      }
      for (uint32_t slot = node.child[k]; slot < node.child[k] + node.count[k]; ++slot) {
        const Corners& corners = corners_[slot];
        const Vec3d a = line.Map(corners[0]), b = line.Map(corners[1]), c = line.Map(corners[2]);
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
