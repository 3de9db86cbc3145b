#include "remesh/attribute_quadrics.h"

#include <algorithm>

namespace lacerta {

void AttributeQuadrics::Clear(uint32_t node) { std::fill_n(row(node), row_size(), 0.0); }

void AttributeQuadrics::AddTriangle(uint32_t node, const std::array<Vec3d, 3>& corners,
                                    const std::array<const double*, 3>& values) {
  const Vec3d e1 = corners[1] - corners[0], e2 = corners[2] - corners[0];
  const double area = Norm(Cross(e1, e2)) / 2;
  if (!(area > 0)) return;
  // Across a needle the slope is anything: the ridge keeps it small where the height is below 1/3000 of the length.
  constexpr double kRidge = 1e-7;
  const double ridge = kRidge * (SquaredNorm(e1) + SquaredNorm(e2));
  const double g11 = SquaredNorm(e1) + ridge, g12 = Dot(e1, e2), g22 = SquaredNorm(e2) + ridge;
  const double det = g11 * g22 - g12 * g12;
  const Vec3d center = (corners[0] + corners[1] + corners[2]) * (1.0 / 3);
  std::vector<double>& row = triangle_;
  std::fill(row.begin(), row.end(), 0.0);
  row[kArea] = area;
  for (uint32_t c = 0; c < components_; ++c) {
    const double s1 = values[1][c] - values[0][c], s2 = values[2][c] - values[0][c];
    const Vec3d g = e1 * ((g22 * s1 - g12 * s2) / det) + e2 * ((g11 * s2 - g12 * s1) / det);
    const double d = (values[0][c] + values[1][c] + values[2][c]) / 3 - Dot(g, center);
    const double squares[6] = {g.x * g.x, g.x * g.y, g.x * g.z, g.y * g.y, g.y * g.z, g.z * g.z};
    for (size_t i = 0; i < 6; ++i) row[i] += area * squares[i];
    for (int i = 0; i < 3; ++i) row[kLinear + static_cast<size_t>(i)] += area * d * g[i];
    row[kConstant] += area * d * d;
    double* own = row.data() + kFirstComponent + 4 * size_t{c};
    for (int i = 0; i < 3; ++i) own[i] = area * g[i];
    own[3] = area * d;
  }
  double* sum = this->row(node);
  for (size_t i = 0; i < row.size(); ++i) sum[i] += row[i];
}

void AttributeQuadrics::AddReduced(const double* row, Quadric* quadric) const {
  if (!(row[kArea] > 0)) return;
  double a[6], b[3], constant = row[kConstant];
  for (size_t i = 0; i < 6; ++i) a[i] = row[i];
  for (size_t i = 0; i < 3; ++i) b[i] = row[kLinear + i];
  const double per_area = 1 / row[kArea];
  for (uint32_t c = 0; c < components_; ++c) {
    const double* own = row + kFirstComponent + 4 * size_t{c};
    const double x = own[0] * per_area, y = own[1] * per_area, z = own[2] * per_area;
    a[0] -= x * own[0], a[1] -= x * own[1], a[2] -= x * own[2], a[3] -= y * own[1], a[4] -= y * own[2], a[5] -= z * own[2];
    b[0] -= x * own[3], b[1] -= y * own[3], b[2] -= z * own[3];
    constant -= own[3] * own[3] * per_area;
  }
  quadric->quadratic(0, 0) += a[0];
  quadric->quadratic(1, 1) += a[3];
  quadric->quadratic(2, 2) += a[5];
  const auto add_pair = [&](int i, int j, double value) {
    quadric->quadratic(i, j) += value;
    quadric->quadratic(j, i) += value;
  };
  add_pair(0, 1, a[1]);
  add_pair(0, 2, a[2]);
  add_pair(1, 2, a[4]);
  for (int i = 0; i < 3; ++i) quadric->linear[i] += b[i];
  quadric->constant += constant;
}

bool AttributeQuadrics::BestValue(const double* row, const Vec3d& p, double* value) const {
  if (!(row[kArea] > 0)) return false;
  for (uint32_t c = 0; c < components_; ++c) {
    const double* own = row + kFirstComponent + 4 * size_t{c};
    value[c] = (own[0] * p.x + own[1] * p.y + own[2] * p.z + own[3]) / row[kArea];
  }
  return true;
}

}  // namespace lacerta
