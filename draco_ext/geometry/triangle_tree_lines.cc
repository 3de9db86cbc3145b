#include <algorithm>
#include <cfloat>
#include <cmath>

#include "geometry/triangle_tree.h"

namespace lacerta {
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

// The part of a line that boxes are tested against: by separating axes, in float and for the four boxes of a node at once, and never short of
// one that it meets.
struct Segment {
  // origin: relative to that of the tree; largest: no coordinate of the mesh is larger there.
  Segment(const Vec3d& origin, const Vec3d& direction, double t_min, double t_max, double largest) {
    // Beyond the mesh there is nothing to meet.
    const double farthest = (2 * Norm(origin) + 4 * largest) / Norm(direction);
    const double from = std::clamp(t_min, -farthest, farthest), to = std::clamp(t_max, -farthest, farthest);
    middle = Vec3Cast<float>(origin + direction * (0.5 * (from + to)));
    half = Vec3Cast<float>(direction * (0.5 * (to - from)));
    for (int axis = 0; axis < 3; ++axis) {
      reach[axis] = std::fabs(half[axis]);
      slack[axis] = (std::fabs(middle[axis]) + reach[axis]) * kSlack;
    }
  }

  static constexpr float kSlack = 1e-6f;  // some ulps
  Vec3f middle, half;
  Vec3f reach;  // the absolute values of `half`
  Vec3f slack;  // for the rounding of both
};

}  // namespace

void TriangleTree::IntersectLine(const Vec3f& origin, const Vec3f& direction, float t_min, float t_max,
                                 std::vector<LineHit>* hits) const {
  if (nodes_.empty() || !IsUsable(origin) || !IsUsable(direction) || direction == Vec3f{} || !(t_min <= t_max)) return;
  const Vec3d origin_d = Vec3Cast<double>(origin), direction_d = Vec3Cast<double>(direction);
  const ShearedLine line(origin_d, direction_d);
  const Segment segment(origin_d - Vec3Cast<double>(origin_), direction_d, t_min, t_max, std::ldexp(1.0, 11) / scale_);
  const Vec3f &middle = segment.middle, &half = segment.half, &reach = segment.reach, &slack = segment.slack;
  uint32_t stack[kStackSize];
  int size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const Node& node = nodes_[stack[--size]];
    float apart[kWidth];  // above 0 where some axis separates box and segment
    for (int k = 0; k < kWidth; ++k) {
      const float x = node.center[0][k] - middle.x, y = node.center[1][k] - middle.y, z = node.center[2][k] - middle.z;
      const float size_x = node.half_size[0][k] + slack.x + std::fabs(x) * Segment::kSlack;
      const float size_y = node.half_size[1][k] + slack.y + std::fabs(y) * Segment::kSlack;
      const float size_z = node.half_size[2][k] + slack.z + std::fabs(z) * Segment::kSlack;
      const float beyond_x = std::fabs(x) - size_x - reach.x;
      const float beyond_y = std::fabs(y) - size_y - reach.y;
      const float beyond_z = std::fabs(z) - size_z - reach.z;
      const float across_x = std::fabs(y * half.z - z * half.y) - (size_y * reach.z + size_z * reach.y);
      const float across_y = std::fabs(z * half.x - x * half.z) - (size_z * reach.x + size_x * reach.z);
      const float across_z = std::fabs(x * half.y - y * half.x) - (size_x * reach.y + size_y * reach.x);
      // v + |v| is above 0 where v is, without a branch.
      apart[k] = (beyond_x + std::fabs(beyond_x)) + (beyond_y + std::fabs(beyond_y)) + (beyond_z + std::fabs(beyond_z)) +
                 (across_x + std::fabs(across_x)) + (across_y + std::fabs(across_y)) + (across_z + std::fabs(across_z));
    }
    for (int k = 0; k < kWidth; ++k) {
      if (apart[k] > 0.0f || node.half_size[0][k] < 0.0f) continue;
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
