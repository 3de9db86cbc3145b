#include "pack/rounding_forecast.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/for_each_branch.h"
#include "geometry/value_difference.h"
#include "geometry/vertex_area_vectors.h"
#include "pack/attribute_value.h"
#include "pack/slide_fit.h"

namespace lacerta {
namespace {

std::vector<AttributeValue> ValuesOf(const AccessorData& data, bool direction) {
  std::vector<AttributeValue> values;
  values.reserve(static_cast<size_t>(data.count));
  for (uint64_t i = 0; i < data.count; ++i) values.push_back(ValueAt(data, i, direction));
  return values;
}

// How far surfaces move along their normals, and which of their area comes to look to the other side.
class Moves {
 public:
  // Where nothing has area everything counts, in whichever direction it moves.
  explicit Moves(bool has_area) : has_area_(has_area) {}

  // moved: where the vertices of the surface go.
  void Add(const TriangleMesh& surface, const std::vector<Vec3f>& moved) {
    for (const Triangle& t : surface.triangles) {
      const Vec3d before = AreaVector(surface.positions, t);
      const double area = has_area_ ? Norm(before) : 1.0;
      AttributeValue along[3];
      for (size_t i = 0; i < 3; ++i) {
        const Vec3d move = Vec3Cast<double>(moved[t[i]]) - Vec3Cast<double>(surface.positions[t[i]]);
        along[i] = has_area_ ? AttributeValue{lacerta::Dot(move, Normalized(before)), 0, 0, 0} : AttributeValue{move.x, move.y, move.z, 0};
      }
      squares_ += area * MeanSquare(along[0], along[1], along[2]);
      area_ += area;
      if (lacerta::Dot(before, AreaVector(moved, t)) < 0.0) flipped_ += area;
    }
  }

  double Distance() const { return area_ > 0.0 ? std::sqrt(squares_ / area_) : 0.0; }  // RMS
  double Flipped() const { return has_area_ && area_ > 0.0 ? flipped_ / area_ : 0.0; }

 private:
  const bool has_area_;
  double squares_ = 0.0, area_ = 0.0, flipped_ = 0.0;
};

}  // namespace

RoundingForecast::RoundingForecast(const std::vector<const Primitive*>& primitives, const std::vector<RoundedAttribute>& attributes, const Skin* skin)
    : primitives_(primitives), attributes_(attributes), skin_(skin) {
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
      has_area_ = has_area_ || Norm(AreaVector(surfaces_.back().positions, t)) > 0.0;
    }
  }
  box_ = PositionLattice(min, max, 1);
  descent_.emplace(surfaces_);
}

int RoundingForecast::StartLevel(double error) const {
  const double steps = box_.range / (error * std::sqrt(36.0));  // a step moves by sqrt(1/12), interpolation and the descent take two thirds of squares
  return std::min(LevelOfSteps(steps) + 1, kMostLevel);
}

Lattice RoundingForecast::LatticeAt(int level) const { return LatticeOfStep(box_, box_.range * std::exp2(-static_cast<float>(level) / kLevelsPerBit)); }

const RoundedPositions& RoundingForecast::Positions(int level) {
  const auto known = positions_.find(level);
  if (known != positions_.end()) return known->second;
  RoundedPositions result;
  result.lattice = LatticeAt(level);
  result.moved = descent_->On(result.lattice);
  const std::vector<std::vector<Vec3f>>& moved = result.moved;
  Moves moves(has_area_);
  for (size_t m = 0; m < surfaces_.size(); ++m) moves.Add(surfaces_[m], moved[m]);
  result.distance = moves.Distance();
  result.flipped = moves.Flipped();
  result.slides.assign(attributes_.size(), 0.0);
  ForEachBranch(attributes_.size(), [&](size_t a) {
    if (!has_area_ || !attributes_[a].is_shown) return;
    SlideFit fit = FitToSlides(primitives_, surfaces_, attributes_[a], moved);
    result.slides[a] = ErrorsOf(attributes_[a], &fit.squares).rms;
  });
  return positions_.emplace(level, std::move(result)).first->second;
}

const std::vector<AccessorData>& RoundingForecast::Fitted(size_t index, int level) {
  const auto [known, is_new] = fitted_.emplace(std::make_pair(index, level), std::vector<AccessorData>());
  if (!is_new) return known->second;
  const RoundedAttribute& attribute = attributes_[index];
  if (has_area_ && attribute.is_shown) return known->second = FitToSlides(primitives_, surfaces_, attribute, Positions(level).moved).values;
  for (const RoundedAttribute::Part& part : attribute.parts) known->second.push_back(primitives_[part.member]->attributes[part.index].data);
  return known->second;
}

const RoundingForecast::Errors& RoundingForecast::ErrorsOf(size_t index, int level) {
  const auto [known, is_new] = rounded_.emplace(std::make_pair(index, level), Errors());
  if (!is_new || level > kMostLevel) return known->second;
  const RoundedAttribute& attribute = attributes_[index];
  std::vector<AccessorData> values, rounded;
  for (const RoundedAttribute::Part& part : attribute.parts) {
    values.push_back(primitives_[part.member]->attributes[part.index].data);
    rounded.push_back(attribute.RoundedAt(values.back(), part, level));
  }
  return known->second = ErrorsOf(index, values, rounded);
}

double RoundingForecast::Posed(size_t index, int level) {
  const auto [known, is_new] = posed_.emplace(std::make_pair(index, level), 0.0);
  if (!is_new || level > kMostLevel || skin_ == nullptr) return known->second;
  const RoundedAttribute& attribute = attributes_[index];
  std::vector<Moves> moves(skin_->poses.size(), Moves(has_area_));
  for (const RoundedAttribute::Part& part : attribute.parts) {
    const Primitive& exact = *primitives_[part.member];
    Primitive rounded = exact;
    AccessorData& weights = rounded.attributes[part.index].data;
    weights = attribute.RoundedAt(weights, part, level);
    for (size_t pose = 0; pose < moves.size(); ++pose) {
      const StatusOr<TriangleMesh> before = PosedSurface({&exact}, *skin_, pose), after = PosedSurface({&rounded}, *skin_, pose);
      if (before.ok() && after.ok()) moves[pose].Add(before.value(), after.value().positions);
    }
  }
  for (const Moves& in_pose : moves) known->second = std::max(known->second, in_pose.Distance());
  return known->second;
}

RoundingForecast::Errors RoundingForecast::ErrorsOf(size_t index, const std::vector<AccessorData>& values, const std::vector<AccessorData>& rounded) const {
  const RoundedAttribute& attribute = attributes_[index];
  std::vector<std::pair<double, double>> squares;
  for (size_t p = 0; p < attribute.parts.size(); ++p) {
    const RoundedAttribute::Part& part = attribute.parts[p];
    std::vector<AttributeValue> errors = ValuesOf(values[p], attribute.direction);
    for (size_t v = 0; v < errors.size(); ++v) {
      const bool is_zero = attribute.direction && errors[v] == AttributeValue{};  // points nowhere before or after
      errors[v] = is_zero ? AttributeValue{} : ValueAt(rounded[p], v, attribute.direction) - errors[v];
    }
    const TriangleMesh& surface = surfaces_[part.member];
    for (const Triangle& t : surface.triangles) {
      const double area = has_area_ ? Norm(AreaVector(surface.positions, t)) : 1.0;
      squares.emplace_back(MeanSquare(errors[t[0]], errors[t[1]], errors[t[2]]), area);
    }
  }
  return ErrorsOf(attribute, &squares);
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
