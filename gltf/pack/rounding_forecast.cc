#include "pack/rounding_forecast.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/value_difference.h"

namespace lacerta {
namespace {

using Value = std::array<double, 4>;

Value operator-(const Value& a, const Value& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2], a[3] - b[3]}; }
double Dot(const Value& a, const Value& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]; }

// Mean over a triangle of |e|^2 with e linear between its corners.
double MeanSquare(const Value& a, const Value& b, const Value& c) {
  return (Dot(a, a) + Dot(b, b) + Dot(c, c) + Dot(a, b) + Dot(b, c) + Dot(c, a)) / 6.0;
}

Value ValueAt(const AccessorData& data, uint64_t i, bool direction) {
  if (direction) {
    const Vec3d unit = Normalized(Vec3Cast<double>(VectorAt(data, i)));
    return {unit.x, unit.y, unit.z, 0.0};
  }
  Value value = {};
  for (uint32_t c = 0; c < data.components; ++c) value[c] = data.Float(i, c);
  return value;
}

std::vector<Value> ValuesOf(const AccessorData& data, bool direction) {
  std::vector<Value> values;
  values.reserve(static_cast<size_t>(data.count));
  for (uint64_t i = 0; i < data.count; ++i) values.push_back(ValueAt(data, i, direction));
  return values;
}

// Two edges from the first corner of a triangle, and the area vector.
struct Frame {
  Vec3d u, v, area;
  Frame(const TriangleMesh& mesh, const Triangle& t)
      : u(Vec3Cast<double>(mesh.positions[t[1]]) - Vec3Cast<double>(mesh.positions[t[0]])),
        v(Vec3Cast<double>(mesh.positions[t[2]]) - Vec3Cast<double>(mesh.positions[t[0]])), area(Cross(u, v) * 0.5) {}

  // Coordinates (p, q) of `move` within the plane: p u + q v. No farther than across the triangle, beyond which its
  // values say nothing. Only of triangles with area.
  std::array<double, 2> Within(const Vec3d& move) const {
    const double uu = lacerta::Dot(u, u), uv = lacerta::Dot(u, v), vv = lacerta::Dot(v, v);
    const double mu = lacerta::Dot(move, u), mv = lacerta::Dot(move, v);
    const double det = uu * vv - uv * uv;
    if (!(det > 0.0)) return {0.0, 0.0};
    return {std::clamp((vv * mu - uv * mv) / det, -1.0, 1.0), std::clamp((uu * mv - uv * mu) / det, -1.0, 1.0)};
  }
};

}  // namespace

RoundingForecast::RoundingForecast(const std::vector<const Primitive*>& primitives,
                                   const std::vector<RoundedAttribute>& attributes)
    : primitives_(primitives), attributes_(attributes) {
  Vec3f min, max;
  bool is_first = true;
  for (const Primitive* primitive : primitives) {
    surfaces_.push_back(Surface(*primitive));
    for (const Vec3f& position : surfaces_.back().positions) {
      for (int axis = 0; axis < 3; ++axis) {
        min[axis] = is_first ? position[axis] : std::min(min[axis], position[axis]);
        max[axis] = is_first ? position[axis] : std::max(max[axis], position[axis]);
      }
      is_first = false;
    }
    for (const Triangle& t : surfaces_.back().triangles) {
      has_area_ = has_area_ || Norm(Frame(surfaces_.back(), t).area) > 0.0;
    }
  }
  box_ = PositionLattice(min, max, 1);
}

int RoundingForecast::StartLevel(double error) const {
  const double steps = box_.range / (error * std::sqrt(24.0));  // a step moves by sqrt(1/12), interpolation halves squares
  if (!(steps > 1.0)) return 1;
  return std::isfinite(steps) ? std::min(static_cast<int>(kLevelsPerBit * std::log2(steps)) + 1, kMostLevel) : kMostLevel;
}

const RoundedPositions& RoundingForecast::Positions(int level) {
  const auto known = positions_.find(level);
  if (known != positions_.end()) return known->second;
  RoundedPositions result;
  result.lattice = LatticeOfStep(box_, box_.range * std::exp2(-static_cast<float>(level) / kLevelsPerBit));
  std::vector<std::vector<Vec3f>> moved(surfaces_.size());
  double squares = 0.0, area_sum = 0.0, flipped = 0.0;
  for (size_t m = 0; m < surfaces_.size(); ++m) {
    for (Vec3f position : surfaces_[m].positions) {
      for (int axis = 0; axis < 3; ++axis) {
        const auto c = static_cast<uint32_t>(axis);
        position[axis] = result.lattice.At(result.lattice.Round(position[axis], c), c);
      }
      moved[m].push_back(position);
    }
    for (const Triangle& t : surfaces_[m].triangles) {
      const Frame before(surfaces_[m], t);
      const double area = has_area_ ? Norm(before.area) : 1.0;
      Value along[3];
      for (size_t i = 0; i < 3; ++i) {
        const Vec3d move = Vec3Cast<double>(moved[m][t[i]]) - Vec3Cast<double>(surfaces_[m].positions[t[i]]);
        along[i] = has_area_ ? Value{lacerta::Dot(move, Normalized(before.area)), 0, 0, 0} : Value{move.x, move.y, move.z, 0};
      }
      squares += area * MeanSquare(along[0], along[1], along[2]);
      area_sum += area;
      const Vec3d u = Vec3Cast<double>(moved[m][t[1]]) - Vec3Cast<double>(moved[m][t[0]]);
      const Vec3d v = Vec3Cast<double>(moved[m][t[2]]) - Vec3Cast<double>(moved[m][t[0]]);
      if (lacerta::Dot(before.area, Cross(u, v)) < 0.0) flipped += area;
    }
  }
  result.distance = area_sum > 0.0 ? std::sqrt(squares / area_sum) : 0.0;
  result.flipped = has_area_ ? flipped / area_sum : 0.0;
  for (const RoundedAttribute& attribute : attributes_) {
    result.slides.push_back(has_area_ && attribute.is_shown ? SlideOf(attribute, moved) : 0.0);
  }
  return positions_.emplace(level, std::move(result)).first->second;
}

double RoundingForecast::SlideOf(const RoundedAttribute& attribute, const std::vector<std::vector<Vec3f>>& moved) const {
  std::vector<std::pair<double, double>> squares;
  for (const RoundedAttribute::Part& part : attribute.parts) {
    const TriangleMesh& surface = surfaces_[part.member];
    const std::vector<Value> values = ValuesOf(primitives_[part.member]->attributes[part.index].data, attribute.direction);
    for (const Triangle& t : surface.triangles) {
      const Frame frame(surface, t);
      const double area = Norm(frame.area);
      if (!(area > 0.0)) continue;
      const Value along_u = values[t[1]] - values[t[0]], along_v = values[t[2]] - values[t[0]];
      Value slide[3];
      for (size_t i = 0; i < 3; ++i) {
        const auto [p, q] =
            frame.Within(Vec3Cast<double>(moved[part.member][t[i]]) - Vec3Cast<double>(surface.positions[t[i]]));
        for (size_t c = 0; c < 4; ++c) slide[i][c] = p * along_u[c] + q * along_v[c];
      }
      squares.emplace_back(MeanSquare(slide[0], slide[1], slide[2]), area);
    }
  }
  return ErrorsOf(attribute, &squares).rms;
}

const RoundingForecast::Errors& RoundingForecast::ErrorsOf(size_t index, int level) {
  const auto [known, is_new] = rounded_.emplace(std::make_pair(index, level), Errors());
  if (!is_new || level > kMostLevel) return known->second;
  const RoundedAttribute& attribute = attributes_[index];
  std::vector<std::pair<double, double>> squares;
  for (const RoundedAttribute::Part& part : attribute.parts) {
    const Primitive& member = *primitives_[part.member];
    const AccessorData rounded = attribute.RoundedAt(member, part, level);
    std::vector<Value> errors = ValuesOf(member.attributes[part.index].data, attribute.direction);
    for (size_t v = 0; v < errors.size(); ++v) {
      const bool is_zero = attribute.direction && errors[v] == Value{};  // points nowhere before or after
      errors[v] = is_zero ? Value{} : ValueAt(rounded, v, attribute.direction) - errors[v];
    }
    const TriangleMesh& surface = surfaces_[part.member];
    for (const Triangle& t : surface.triangles) {
      const double area = has_area_ ? Norm(Frame(surface, t).area) : 1.0;
      squares.emplace_back(MeanSquare(errors[t[0]], errors[t[1]], errors[t[2]]), area);
    }
  }
  return known->second = ErrorsOf(attribute, &squares);
}

RoundingForecast::Errors RoundingForecast::ErrorsOf(const RoundedAttribute& attribute, std::vector<std::pair<double, double>>* squares) {
  constexpr double kLeftOut = 0.01;
  double area_sum = 0.0;
  for (const auto& [square, area] : *squares) area_sum += area;
  if (!(area_sum > 0.0)) return {};
  double kept = area_sum;
  if (!attribute.unit.empty()) {
    std::sort(squares->begin(), squares->end());
    kept *= 1.0 - kLeftOut;
  }
  double sum = 0.0, covered = 0.0, most = 0.0;
  for (const auto& [square, area] : *squares) {
    const double share = std::clamp(kept - covered, 0.0, area);
    sum += share * square;
    covered += share;
    most = std::max(most, square);
  }
  const auto shown = [&](double error) {
    return attribute.direction ? 2.0 * std::asin(std::min(error / 2.0, 1.0)) * kDegreesPerRadian : error * attribute.scale;
  };
  return {shown(std::sqrt(sum / kept)), shown(std::sqrt(most))};
}

}  // namespace lacerta
