#include "pack/value_descent.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "geometry/equal_rows.h"
#include "geometry/for_each_branch.h"
#include "geometry/value_difference.h"
#include "pack/attribute_value.h"
#include "pack/for_each_near.h"
#include "pack/lattice_points.h"
#include "pack/value_predictions.h"
#include "pack/value_wedges.h"

namespace lacerta {
namespace {

double Square(double x) { return x * x; }

// The wedges of a part while they move.
struct Moving {
  std::vector<LatticePoint> points;
  std::vector<AttributeValue> errors;  // of each from what it should be
  std::vector<char> stands;
};

// What is around a wedge: the integral of its squared error over the triangles there is weight |e|^2 + pull e, but for a constant.
struct Surroundings {
  double weight = 0.0;
  AttributeValue pull = {};
};

Surroundings SurroundingsOf(const ValueWedges& wedges, const Moving& moving, size_t w) {
  constexpr double kCorners = 6.0;
  Surroundings result;
  for (const uint32_t corner : wedges.corners[w]) {
    const std::array<uint32_t, 3>& t = wedges.triangles[corner / 3];
    const double share = wedges.areas[corner / 3] / kCorners;
    result.pull = result.pull + share * (moving.errors[t[(corner + 1) % 3]] + moving.errors[t[(corner + 2) % 3]]);
    result.weight += share;
  }
  return result;
}

// Whether normals turn from a triangle: the sum of those at its corners looks the other way.
class Facing {
 public:
  Facing(const ValueWedges& wedges, const Moving& moving, size_t w) {
    for (const uint32_t corner : wedges.corners[w]) {
      const std::array<uint32_t, 3>& t = wedges.triangles[corner / 3];
      const Vec3d area = Cross(wedges.positions[t[1]] - wedges.positions[t[0]], wedges.positions[t[2]] - wedges.positions[t[0]]);
      AttributeValue others = {};
      for (const size_t k : {(corner + 1) % 3, (corner + 2) % 3}) others = others + wedges.wanted[t[k]] + moving.errors[t[k]];
      sides_.push_back({{area.x, area.y, area.z, 0.0}, others});
    }
    for (const Side& side : sides_) before_.push_back(Dot(side.area, side.others + wedges.wanted[w] + moving.errors[w]));
  }

  bool IsKept(const AttributeValue& normal) const {
    for (size_t i = 0; i < sides_.size(); ++i) {
      if (Dot(sides_[i].area, sides_[i].others + normal) < std::min(before_[i], 0.0)) return false;
    }
    return true;
  }

 private:
  struct Side {
    AttributeValue area, others;  // of the triangle; sum at its other corners
  };
  std::vector<Side> sides_;
  std::vector<double> before_;
};

}  // namespace

// A part of the attribute: one primitive's.
class ValueDescent::Part {
 public:
  Part(ValueWedges wedges, AccessorData rounded) : wedges_(std::move(wedges)), rounded_(std::move(rounded)), is_fixed_(wedges_.size(), 0) {}
  virtual ~Part() = default;

  const ValueWedges& wedges() const { return wedges_; }
  void Fix(size_t wedge) { is_fixed_[wedge] = 1; }

  // most2: of the squared error; slope: of the squared error, summed up over the area, over bits.
  virtual AccessorData At(double most2, double slope) const = 0;

 protected:
  const ValueWedges wedges_;
  const AccessorData rounded_;  // every value at the point next to it
  std::vector<char> is_fixed_;
};

template <typename Points, typename Prediction>
class ValueDescent::PartOf : public ValueDescent::Part {
 public:
  PartOf(ValueWedges wedges, AccessorData rounded, const Points& lattice)
      : Part(std::move(wedges), std::move(rounded)), lattice_(lattice), nearest_(Nearest(wedges_, lattice_)), prediction_(wedges_, lattice_, nearest_) {}

  // Each value in turn goes to the best point near it, in a few sweeps.
  AccessorData At(double most2, double slope) const override {
    constexpr int kSweeps = 3;
    Moving moving{nearest_, {}, is_fixed_};
    std::vector<double> most;
    for (size_t w = 0; w < wedges_.size(); ++w) {
      const std::optional<AttributeValue> error = ErrorOf(w, nearest_[w]);
      if (!error.has_value()) moving.stands[w] = 1;
      moving.errors.push_back(error.value_or(AttributeValue{}));
      most.push_back(std::max(most2, Dot(moving.errors[w], moving.errors[w])));
    }
    for (int sweep = 0; sweep < kSweeps; ++sweep) {
      ResidualCosts costs;
      prediction_.Count(moving.points, &costs);
      costs.Settle();
      for (size_t w = 0; w < wedges_.size(); ++w) {
        if (moving.stands[w] == 0) Move(w, most[w], slope, costs, &moving);
      }
    }
    AccessorData data = rounded_;
    for (uint64_t v = 0; v < data.count; ++v) {
      const size_t w = wedges_.of_vertex[v];
      if (moving.points[w] != nearest_[w]) StoreValue(lattice_.Stored(moving.points[w]), lattice_.components(), v, &data);
    }
    return data;
  }

 private:
  static std::vector<LatticePoint> Nearest(const ValueWedges& wedges, const Points& lattice) {
    std::vector<LatticePoint> points;
    for (const AttributeValue& value : wedges.wanted) points.push_back(lattice.Nearest(value));
    return points;
  }

  std::optional<AttributeValue> ErrorOf(size_t wedge, const LatticePoint& point) const {
    const std::optional<AttributeValue> value = lattice_.At(point);
    return value.has_value() ? std::optional<AttributeValue>(*value - wedges_.wanted[wedge]) : std::nullopt;
  }

  void Move(size_t w, double most2, double slope, const ResidualCosts& costs, Moving* moving) const {
    const Surroundings around = SurroundingsOf(wedges_, *moving, w);
    const auto bits = prediction_.BitsNear(w, moving->points, costs);
    const std::optional<Facing> facing = Prediction::kIsNormal ? std::optional<Facing>(Facing(wedges_, *moving, w)) : std::nullopt;
    double least = std::numeric_limits<double>::infinity();
    LatticePoint best = moving->points[w];
    AttributeValue best_error = moving->errors[w];
    const auto visit = [&](const LatticePoint& point) {
      const std::optional<AttributeValue> error = ErrorOf(w, point);
      if (!error.has_value()) return;
      const double square = Dot(*error, *error), distortion = around.weight * square + Dot(around.pull, *error);
      if (square > most2 || distortion >= least) return;
      const double cost = distortion + slope * bits(point);
      if (cost >= least || (facing.has_value() && !facing->IsKept(wedges_.wanted[w] + *error))) return;
      least = cost;
      best = point;
      best_error = *error;
    };
    ForEachNear(moving->points[w], lattice_.coordinates(), Points::kReach, visit);
    if (const std::optional<LatticePoint> predicted = prediction_.Predicted(w); predicted.has_value()) visit(*predicted);
    moving->points[w] = best;
    moving->errors[w] = best_error;
  }

  const Points lattice_;
  const std::vector<LatticePoint> nearest_;
  const Prediction prediction_;
};

namespace {

// Whether texture coordinates are rather predicted from the triangle than by parallelograms.
bool IsByTriangles(const ValueWedges& wedges, const LatticeNumbers& lattice) {
  std::vector<LatticePoint> points;
  for (const AttributeValue& value : wedges.wanted) points.push_back(lattice.Nearest(value));
  return TexturePrediction(wedges, lattice, points).Bits(points) <= FlapPrediction(wedges, lattice, points).Bits(points);
}

}  // namespace

std::unique_ptr<ValueDescent::Part> ValueDescent::MakePart(const Primitive& primitive, const std::vector<Vec3f>& positions, const RoundedAttribute& attribute,
                                                           const RoundedAttribute::Part& part, const AccessorData& values, int level) {
  AccessorData rounded = attribute.RoundedAt(values, part, level);
  ValueWedges wedges = WedgesOf(primitive, positions, values, rounded, attribute.direction);
  if (attribute.octahedral) {
    return std::make_unique<PartOf<LatticeDirections, NormalPrediction>>(std::move(wedges), std::move(rounded), LatticeDirections(level / kLevelsPerBit));
  }
  const LatticeNumbers lattice(attribute.LatticeAt(part, level), attribute.direction ? 3 : values.components, attribute.direction);
  if (attribute.unit == "texels" && values.components == 2 && IsByTriangles(wedges, lattice)) {
    return std::make_unique<PartOf<LatticeNumbers, TexturePrediction>>(std::move(wedges), std::move(rounded), lattice);
  }
  return std::make_unique<PartOf<LatticeNumbers, FlapPrediction>>(std::move(wedges), std::move(rounded), lattice);
}

ValueDescent::ValueDescent(const std::vector<const Primitive*>& primitives, const std::vector<std::vector<Vec3f>>& positions, const RoundedAttribute& attribute,
                           const std::vector<AccessorData>& values, int level, double most_error)
    : unit_(attribute.direction ? kDegreesPerRadian : attribute.scale), most2_(Square(most_error / unit_)) {
  std::vector<float> rows;  // what all parts should have at their vertices
  for (size_t p = 0; p < attribute.parts.size(); ++p) {
    const Primitive& primitive = *primitives[attribute.parts[p].member];
    const std::vector<Vec3f>& at = positions[attribute.parts[p].member];
    parts_.push_back(MakePart(primitive, at, attribute, attribute.parts[p], values[p], level));
    for (const double area : parts_.back()->wedges().areas) area_ += area;
    for (uint64_t v = 0; v < primitive.num_vertices; ++v) {
      rows.insert(rows.end(), {at[v].x, at[v].y, at[v].z});
      for (uint32_t c = 0; c < kMostComponents; ++c) rows.push_back(c < values[p].components ? values[p].Float(v, c) : 0.0f);
    }
  }
  if (parts_.size() > 1) FixCommonValues(rows);
}

ValueDescent::~ValueDescent() = default;

void ValueDescent::FixCommonValues(const std::vector<float>& rows) {
  std::vector<std::pair<size_t, uint32_t>> owners;  // part and wedge of each row
  for (size_t p = 0; p < parts_.size(); ++p) {
    for (const uint32_t wedge : parts_[p]->wedges().of_vertex) owners.emplace_back(p, wedge);
  }
  const std::vector<uint32_t> first = FirstEqualRow(Span<const float>(rows), 3 + kMostComponents);
  for (size_t row = 0; row < owners.size(); ++row) {
    const auto [part, wedge] = owners[row];
    const auto [other_part, other_wedge] = owners[first[row]];
    if (part == other_part) continue;
    parts_[part]->Fix(wedge);
    parts_[other_part]->Fix(other_wedge);
  }
}

size_t ValueDescent::num_values() const {
  size_t sum = 0;
  for (const std::unique_ptr<Part>& part : parts_) sum += part->wedges().size();
  return sum;
}

std::vector<AccessorData> ValueDescent::At(double slope) const {
  std::vector<AccessorData> values(parts_.size());
  ForEachBranch(parts_.size(), [&](size_t p) { values[p] = parts_[p]->At(most2_, area_ * slope / Square(unit_)); });
  return values;
}

}  // namespace lacerta
