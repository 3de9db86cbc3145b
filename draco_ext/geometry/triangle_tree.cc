#include "geometry/triangle_tree.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <cstddef>
#include <utility>

#include "geometry/bounding_box.h"
#include "geometry/for_each_branch.h"

namespace lacerta {
namespace {

constexpr int kMaxBins = 16;
// Ranges at least this long are split by several threads.
constexpr std::ptrdiff_t kParallelSize = 8192;

// Half the surface; 0 for an empty box.
float HalfArea(const BoundingBox& box) {
  const Vec3f d = box.high - box.low;
  return IsEmpty(box) ? 0.0f : d.x * d.y + d.y * d.z + d.z * d.x;
}

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

}  // namespace

struct TriangleTree::Reference {
  BoundingBox box;
  uint32_t face;  // the first one
  Vec3f Center() const { return (box.low + box.high) * 0.5f; }
};

struct TriangleTree::Building {
  const TriangleMesh& mesh;
  const Reference* all;
  bool in_groups;  // of kGroupSize faces
};

namespace {

// The middle of the box of what faces use; zero where there is none.
Vec3f MiddleOf(const TriangleMesh& mesh) {
  BoundingBox box;
  for (const Triangle& t : mesh.triangles) {
    for (const uint32_t v : t) {
      if (v < mesh.positions.size() && TriangleTree::IsUsable(mesh.positions[v])) Extend(mesh.positions[v], &box);
    }
  }
  return box.low * 0.5f + box.high * 0.5f;
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
          if (usable) Extend(mesh.positions[v] - origin_, &reference.box);
        }
      }
      complete = complete && usable;
      if (!usable) continue;
      for (int k = 0; k < 3; ++k) {
        largest = std::max({largest, std::fabs(reference.box.low[k]), std::fabs(reference.box.high[k])});
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
  faces_.resize(references.size() * group_size);
  for (uint32_t slot = 0; slot < faces_.size(); ++slot) faces_[slot] = references[slot / group_size].face + slot % group_size;
  references = {};  // before the corners come: both are large
  nodes_.shrink_to_fit();
  corners_.resize(faces_.size());
  tbb::parallel_for(tbb::blocked_range<uint32_t>(0, static_cast<uint32_t>(faces_.size()), kParallelSize), [&](const tbb::blocked_range<uint32_t>& range) {
    for (uint32_t slot = range.begin(); slot != range.end(); ++slot) {
      const Triangle& t = mesh.triangles[faces_[slot]];
      slots_[faces_[slot]] = slot;
      corners_[slot] = {mesh.positions[t[0]], mesh.positions[t[1]], mesh.positions[t[2]]};
    }
  });
}

namespace {

// Splits [first, last), at least two of them, along the widest axis of their centers into two parts that are not empty,
// and returns where. Trying all three axes doubles the time to build and gains queries less than 5 %.
template <typename Reference>
Reference* Split(Reference* first, Reference* last, bool halve) {
  BoundingBox centers;
  for (const Reference* r = first; r != last; ++r) Extend(r->Center(), &centers);
  const Vec3f extent = centers.high - centers.low;
  const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
  const int num_bins = static_cast<int>(std::min<std::ptrdiff_t>(last - first, kMaxBins));
  const float bins_per_length = static_cast<float>(num_bins) / extent[axis];
  if (!halve && std::isfinite(bins_per_length)) {
    const auto bin_of = [&](const Reference& r) {
      return std::min(static_cast<int>((r.Center()[axis] - centers.low[axis]) * bins_per_length), num_bins - 1);
    };
    BoundingBox boxes[kMaxBins];
    uint32_t counts[kMaxBins] = {};
    for (const Reference* r = first; r != last; ++r) {
      const int bin = bin_of(*r);
      Extend(r->box, &boxes[bin]);
      ++counts[bin];
    }
    float cost_after[kMaxBins];  // of the bins from k on
    BoundingBox after;
    uint32_t num_after = 0;
    for (int k = num_bins - 1; k > 0; --k) {
      Extend(boxes[k], &after);
      num_after += counts[k];
      cost_after[k] = HalfArea(after) * static_cast<float>(num_after);
    }
    float best_cost = FLT_MAX;
    int best_bin = 0;
    BoundingBox before;
    uint32_t num_before = 0;
    for (int k = 1; k < num_bins; ++k) {
      Extend(boxes[k - 1], &before);
      num_before += counts[k - 1];
      const float cost = HalfArea(before) * static_cast<float>(num_before) + cost_after[k];
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
void SetBox(const BoundingBox& box, float padding, int k, Node* node) {
  const bool is_missing = IsEmpty(box);
  const Vec3f center = is_missing ? Vec3f() : (box.low + box.high) * 0.5f;
  const Vec3f half_size = is_missing ? Vec3f{-FLT_MAX, -FLT_MAX, -FLT_MAX} : (box.high - box.low) * 0.5f + Vec3f{padding, padding, padding};
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
    ForEachBranch(static_cast<size_t>(num_parts), [&](size_t k) {
      if (has_node(static_cast<int>(k))) build_part(static_cast<int>(k), &lists[k]);
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
    BoundingBox box;
    for (const Reference* r = ends[std::min(k, num_parts)]; r != ends[std::min(k + 1, num_parts)]; ++r) Extend(r->box, &box);
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
    BoundingBox box;
    for (uint32_t i = k * kPartSize; i < (k + 1) * kPartSize; ++i) {
      for (const uint32_t v : mesh.triangles[first_face + i]) Extend(mesh.positions[v] - origin_, &box);
    }
    SetBox(box, padding_, static_cast<int>(k), &node);
    node.child[k] = first_slot + k * kPartSize;
    node.count[k] = kPartSize;
  }
  return node;
}

}  // namespace lacerta
