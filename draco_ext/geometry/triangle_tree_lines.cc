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

// A line as the boxes of a node are tested against it: in float, for all four at once, and never short of a box that it meets. Lengths count
// along the axis where the direction is longest.
struct BoxLine {
  // origin: relative to that of the tree.
  BoxLine(const Vec3d& origin_d, const Vec3d& direction, double t_min_d, double t_max_d) : origin(Vec3Cast<float>(origin_d)) {
    constexpr double kLargest = 1e19;  // as good as 1 / 0, since boxes are padded; times any coordinate in the range of float
    const double longest = std::max({std::fabs(direction.x), std::fabs(direction.y), std::fabs(direction.z)});
    for (int axis = 0; axis < 3; ++axis) {
      const double inverse = std::clamp(longest / direction[axis], -kLargest, kLargest);
      along[axis] = static_cast<float>(inverse);
      across[axis] = static_cast<float>(std::fabs(inverse)) * (1 + kSlack);
      slack[axis] = std::fabs(origin[axis]) * kSlack;
    }
    const auto bound = [&](double t) { return static_cast<float>(std::clamp<double>(t * longest, -FLT_MAX, FLT_MAX)); };
    t_min = bound(t_min_d - std::fabs(t_min_d) * kSlack);
    t_max = bound(t_max_d + std::fabs(t_max_d) * kSlack);
  }

  static constexpr float kSlack = 1e-6f;  // some ulps: for the rounding of the origin, of differences and of quotients
  Vec3f origin, along, across, slack;
  float t_min, t_max;
};

}  // namespace

void TriangleTree::IntersectLine(const Vec3f& origin, const Vec3f& direction, float t_min, float t_max,
                                 std::vector<LineHit>* hits) const {
  if (nodes_.empty() || !IsUsable(origin) || !IsUsable(direction) || direction == Vec3f{} || !(t_min <= t_max)) return;
  const Vec3d origin_d = Vec3Cast<double>(origin), direction_d = Vec3Cast<double>(direction);
  const ShearedLine line(origin_d, direction_d);
  const BoxLine box_line(origin_d - Vec3Cast<double>(origin_), direction_d, t_min, t_max);
  uint32_t stack[kStackSize];
  int size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const Node& node = nodes_[stack[--size]];
    float enter[kWidth], leave[kWidth];
    for (int k = 0; k < kWidth; ++k) {
      enter[k] = box_line.t_min;
      leave[k] = box_line.t_max;
    }
    for (int axis = 0; axis < 3; ++axis) {
      const float from = box_line.origin[axis], along = box_line.along[axis], across = box_line.across[axis], slack = box_line.slack[axis];
      for (int k = 0; k < kWidth; ++k) {
        const float away = node.center[axis][k] - from;
        const float middle = away * along, half = (node.half_size[axis][k] + slack + std::fabs(away) * BoxLine::kSlack) * across;
        enter[k] = middle - half > enter[k] ? middle - half : enter[k];
        leave[k] = middle + half < leave[k] ? middle + half : leave[k];
      }
    }
    for (int k = 0; k < kWidth; ++k) {
      if (enter[k] > leave[k] || node.half_size[0][k] < 0.0f) continue;
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
