#include "geometry/lean_tree.h"

#include <algorithm>
#include <array>
#include <cfloat>
#include <cmath>

#include "geometry/closest_on_triangle.h"
#include "geometry/for_each_branch.h"

namespace lacerta {

// A face while faces are sorted along an axis.
struct LeanTree::KeyedFace {
  float key;
  uint32_t face;
  bool operator<(const KeyedFace& b) const { return key != b.key ? key < b.key : face < b.face; }
};

struct LeanTree::Search {
  Vec3d p;
  double bound2 = std::numeric_limits<double>::infinity();
  float box_bound2 = FLT_MAX;  // the same for boxes, which are compared in float, with slack for their rounding
  uint32_t face = kNone;

  void SetBound(double squared_distance) {
    constexpr float kSlack = 1.0f + 2e-6f;
    bound2 = squared_distance;
    box_bound2 = std::clamp(static_cast<float>(std::min(squared_distance, 1e38)) * kSlack, FLT_MIN, FLT_MAX);
  }
};

namespace {

constexpr size_t kParallelSize = 8192;  // ranges at least this long are taken by several threads

Vec3f CenterOf(const TriangleMesh& mesh, uint32_t face) {
  const Triangle& t = mesh.triangles[face];
  constexpr float kThird = 1 / 3.0f;  // before they are added: sums might leave the range of float
  return mesh.positions[t[0]] * kThird + mesh.positions[t[1]] * kThird + mesh.positions[t[2]] * kThird;
}

template <typename Function>
void ForHalves(size_t count, const Function& function) {
  if (count < kParallelSize) {
    for (int half = 0; half < 2; ++half) function(half);
  } else {
    ForEachBranch(2, [&](size_t half) { function(static_cast<int>(half)); });
  }
}

}  // namespace

LeanTree::Range LeanTree::ChildOf(Range range, uint32_t k) {
  const auto middle = [](uint32_t a, uint32_t b) { return a + (b - a) / 2; };
  const uint32_t half = middle(range.first, range.last);
  const Range in = k < 2 ? Range{range.first, half} : Range{half, range.last};
  return k % 2 == 0 ? Range{in.first, middle(in.first, in.last)} : Range{middle(in.first, in.last), in.last};
}

LeanTree::LeanTree(const TriangleMesh& mesh) : mesh_(mesh) {
  BoundingBox box;
  for (const Triangle& t : mesh.triangles) {
    for (const uint32_t v : t) Extend(mesh.positions[v], &box);
  }
  origin_ = box.low * 0.5f + box.high * 0.5f;
  float largest = 0;
  for (int axis = 0; axis < 3; ++axis) largest = std::max({largest, box.high[axis] - origin_[axis], origin_[axis] - box.low[axis]});
  padding_ = std::max(largest * 0x1p-21f, FLT_MIN);
  const auto count = static_cast<uint32_t>(mesh.triangles.size());
  size_t num_nodes = 0, num_parts = 1;
  for (; num_parts * kLargestLeaf < count; ++depth_, num_parts *= kWidth) num_nodes += num_parts;
  {
    std::vector<KeyedFace> keyed(count);
    for (uint32_t f = 0; f < count; ++f) keyed[f].face = f;
    Sort(keyed.data(), count, 2 * depth_);
    faces_.reserve(count);
    for (const KeyedFace& k : keyed) faces_.push_back(k.face);
  }
  nodes_.resize(num_nodes);
  if (depth_ > 0) FillNode(0, {0, count}, 0);
}

// Halves faces across the longest side of the box of their centers, `depth` times.
void LeanTree::Sort(KeyedFace* faces, size_t count, int depth) const {
  if (depth == 0 || count < 2) return;
  BoundingBox box;
  for (size_t i = 0; i < count; ++i) Extend(CenterOf(mesh_, faces[i].face), &box);
  const Vec3f sides = box.high - box.low;
  const int axis = sides.x >= sides.y && sides.x >= sides.z ? 0 : sides.y >= sides.z ? 1 : 2;
  for (size_t i = 0; i < count; ++i) faces[i].key = CenterOf(mesh_, faces[i].face)[axis];
  const size_t half = count / 2;
  std::nth_element(faces, faces + half, faces + count);
  ForHalves(count, [&](int k) { k == 0 ? Sort(faces, half, depth - 1) : Sort(faces + half, count - half, depth - 1); });
}

// Boxes of a node and all below it; returns the one around them.
BoundingBox LeanTree::FillNode(uint32_t index, Range range, int depth) {
  std::array<BoundingBox, kWidth> boxes;
  const auto fill = [&](uint32_t k) {
    const Range child = ChildOf(range, k);
    if (depth + 1 < depth_) {
      boxes[k] = FillNode(kWidth * index + k + 1, child, depth + 1);
      return;
    }
    for (uint32_t slot = child.first; slot < child.last; ++slot) {
      for (const uint32_t v : mesh_.triangles[faces_[slot]]) Extend(mesh_.positions[v] - origin_, &boxes[k]);
    }
  };
  ForHalves(range.last - range.first, [&](int half) {
    for (uint32_t k = 0; k < 2; ++k) fill(2 * static_cast<uint32_t>(half) + k);
  });
  BoundingBox all;
  for (uint32_t k = 0; k < kWidth; ++k) {
    Extend(boxes[k], &all);
    for (int axis = 0; axis < 3; ++axis) {
      nodes_[index].low[axis][k] = boxes[k].low[axis] - padding_;
      nodes_[index].high[axis][k] = boxes[k].high[axis] + padding_;
    }
  }
  return all;
}

void LeanTree::TestFace(uint32_t face, Search* search) const {
  const Triangle& t = mesh_.triangles[face];
  const std::vector<Vec3f>& p = mesh_.positions;
  ClosestWeights point;
  if (!ClosestOnTriangle(search->p, Vec3Cast<double>(p[t[0]]), Vec3Cast<double>(p[t[1]]), Vec3Cast<double>(p[t[2]]), search->bound2, &point)) return;
  if (!(point.squared_distance < search->bound2)) return;
  search->SetBound(point.squared_distance);
  search->face = face;
}

double LeanTree::SquaredDistance(const Vec3f& p, uint32_t* hint) const {
  Search search;
  search.p = Vec3Cast<double>(p);
  if (*hint < mesh_.triangles.size()) TestFace(*hint, &search);
  const Vec3f local = p - origin_;
  std::array<Entry, kStackSize> stack;
  size_t size = 0;
  stack[size++] = {0, 0, {0, static_cast<uint32_t>(faces_.size())}, 0};
  while (size > 0) {
    const Entry top = stack[--size];
    if (!(top.squared_distance < search.box_bound2)) continue;
    if (top.depth == depth_) {
      for (uint32_t slot = top.range.first; slot < top.range.last; ++slot) TestFace(faces_[slot], &search);
      continue;
    }
    const Node& node = nodes_[top.node];
    const size_t bottom = size;
    for (uint32_t k = 0; k < kWidth; ++k) {
      float d2 = 0;
      for (int axis = 0; axis < 3; ++axis) {
        const float beyond = std::max({node.low[axis][k] - local[axis], local[axis] - node.high[axis][k], 0.0f});
        d2 += beyond * beyond;
      }
      if (!(d2 < search.box_bound2)) continue;
      size_t at = size++;  // the nearest on top
      for (; at > bottom && stack[at - 1].squared_distance < d2; --at) stack[at] = stack[at - 1];
      stack[at] = {d2, kWidth * top.node + k + 1, ChildOf(top.range, k), top.depth + 1};
    }
  }
  *hint = search.face;
  return search.bound2;
}

// Faces whose boxes hold a point.
uint64_t LeanTree::NumFacesAround(const Vec3f& point) const {
  const Vec3f local = point - origin_;
  const auto is_between = [](const Vec3f& p, const Vec3f& low, const Vec3f& high) {
    return low.x <= p.x && p.x <= high.x && low.y <= p.y && p.y <= high.y && low.z <= p.z && p.z <= high.z;
  };
  uint64_t count = 0;
  std::array<Entry, kStackSize> stack;
  size_t size = 0;
  stack[size++] = {0, 0, {0, static_cast<uint32_t>(faces_.size())}, 0};
  while (size > 0) {
    const Entry top = stack[--size];
    if (top.depth == depth_) {
      for (uint32_t slot = top.range.first; slot < top.range.last; ++slot) {
        BoundingBox box;
        for (const uint32_t v : mesh_.triangles[faces_[slot]]) Extend(mesh_.positions[v], &box);
        const Vec3f padding{padding_, padding_, padding_};
        count += is_between(point, box.low - padding, box.high + padding) ? 1 : 0;
      }
      continue;
    }
    const Node& node = nodes_[top.node];
    for (uint32_t k = 0; k < kWidth; ++k) {
      const Vec3f low{node.low[0][k], node.low[1][k], node.low[2][k]}, high{node.high[0][k], node.high[1][k], node.high[2][k]};
      if (is_between(local, low, high)) stack[size++] = {0, kWidth * top.node + k + 1, ChildOf(top.range, k), top.depth + 1};
    }
  }
  return count;
}

double LeanTree::Crowding() const {
  constexpr size_t kMostPoints = 256;
  const size_t num_points = std::min(kMostPoints, faces_.size());
  uint64_t faces = 0;
  for (size_t i = 0; i < num_points; ++i) faces += NumFacesAround(CenterOf(mesh_, faces_[i * faces_.size() / num_points]));
  return static_cast<double>(faces) / static_cast<double>(num_points);
}

}  // namespace lacerta
