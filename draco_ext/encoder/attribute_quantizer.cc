#include "encoder/attribute_quantizer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "common/attribute_coding.h"
#include "common/attribute_prediction.h"
#include "common/coefficient_sets.h"
#include "encoder/bit_cost.h"
#include "encoder/quantizer.h"
#include "geometry/for_each_branch.h"
#include "geometry/value_difference.h"

namespace lacerta {
namespace {

Vec3f VectorAt(const std::vector<float>& rows, size_t i, uint32_t components) {
  return {rows[i * components], rows[i * components + 1], rows[i * components + 2]};
}

// Residuals of one midpoint, in attribute units or, of normals, as tangents of angles.
void Difference(const AttributeLattice& p, const AttributeWedges& wedges, const SurfaceLevel& surface, uint32_t edge,
                const std::vector<float>& predicted, const std::vector<float>& wanted, std::vector<float>* difference) {
  const size_t row = size_t{wedges.topology.num_vertices} + edge;
  if (p.kind == AttributeKind::kNormal) {
    const Vec3f normal = VectorAt(predicted, row, 3), goal = Normalized(VectorAt(wanted, row, 3));
    const auto axes = NormalAxes(wedges, surface, edge, normal);
    // On the plane that touches the sphere at the prediction; goals beyond 80 degrees are brought to there.
    constexpr float kFarthest = 5.67f;
    const float height = Dot(normal, goal), x = Dot(axes[0], goal), y = Dot(axes[1], goal), aside = std::max(std::hypot(x, y), 1e-6f);
    const float scale = aside < kFarthest * height ? 1 / height : kFarthest / aside;
    (*difference)[0] = x * scale;
    (*difference)[1] = y * scale;
    return;
  }
  for (uint32_t c = 0; c < difference->size(); ++c) (*difference)[c] = wanted[row * p.components + c] - predicted[row * p.components + c];
}

// The residual of a difference, in steps: that of the nearest value, or the one before it where that saves more bits
// than it is farther off. factor: by which it counts how far that is; where it counts less there may be none at all.
int32_t ChooseResidual(float difference, float factor, SetModels& models, const CoefficientContext& context) {
  constexpr float kSquaredStepsPerBit = 0.08f;  // 0.06 to 0.12 take about the same
  const auto nearest = static_cast<int32_t>(RoundToStep(difference, 1.0f));
  if (nearest == 0) return 0;
  const int32_t smaller = nearest - (nearest > 0 ? 1 : -1);
  const auto cost = [&](int32_t value) {
    const float off = factor * (difference - static_cast<float>(value));
    return off * off + kSquaredStepsPerBit * CoefficientBits(models, context, value);
  };
  const int32_t best = cost(smaller) < cost(nearest) ? smaller : nearest;
  return factor < 1 && cost(0) < cost(best) ? 0 : best;
}

// The steps of `count` levels with residuals: larger ones on finer levels, whose errors reach less far.
std::vector<float> StepsOf(float finest, int count, size_t num_levels) {
  constexpr float kGrowth = 2.0f;  // by what a value moves of the surface; 1.2 to 1.7 took 2 to 15 % more bytes
  std::vector<float> steps(num_levels, 0.0f);
  float step = finest;
  for (int i = count; i-- > 0; step /= kGrowth) steps[static_cast<size_t>(i)] = RoundStep(step);
  return steps;
}

constexpr double kCountedShare = 0.99;  // of the surface: as AttributeError::rms_99

// Weighted squares in classes an eighth of a power of two wide, to leave out the largest without sorting.
class SquaresBySize {
 public:
  void Add(double square, double weight) {
    const int size = square > 0 ? static_cast<int>(std::floor(kPerDoubling * std::log2(square))) : 0;
    Class& c = square > 0 ? classes_[static_cast<size_t>(std::clamp(size + kClasses / 2, 0, kClasses - 1))] : zero_;
    c.weight += weight;
    c.sum += weight * square;
    weight_ += weight;
  }

  // Over the given share of all weight.
  double MeanOfLeast(double share) const {
    double left = share * weight_ - zero_.weight, sum = 0;
    for (const Class& c : classes_) {
      if (!(left > 0)) break;
      if (c.weight > 0) sum += c.sum * std::min(1.0, left / c.weight);
      left -= c.weight;
    }
    return weight_ > 0 ? sum / (share * weight_) : 0;
  }

 private:
  static constexpr int kClasses = 1600, kPerDoubling = 8;  // from 2^-100 to 2^100
  struct Class {
    double weight = 0, sum = 0;
  };
  Class zero_;
  std::vector<Class> classes_ = std::vector<Class>(kClasses);
  double weight_ = 0;
};

}  // namespace

StatusOr<AttributeTarget> MakeAttributeTarget(const AttributeLattice& precision, const std::vector<Triangle>& split_corners,
                                              std::vector<float> base_values, std::vector<float> values,
                                              Span<const Topology> topologies, Span<const Vec3f> positions) {
  AttributeTarget target{precision, {}, std::move(base_values), std::move(values), {}};
  const auto num_base = static_cast<uint32_t>(target.base_values.size() / precision.components);
  LACERTA_ASSIGN_OR_RETURN(AttributeWedges wedges, MakeAttributeWedges(split_corners, num_base));
  for (size_t i = 0; i < topologies.size(); ++i) {
    if (i > 0) RefineWedges(&wedges);
    target.wedges.push_back(wedges);
  }
  target.weights.assign(target.values.size() / precision.components, 0.0f);
  if (topologies.empty()) return target;
  // The finest triangles lie on the surface in the same order as on the wedge mesh.
  const std::vector<Triangle> rows = RefineTriangles(wedges.topology), surface = RefineTriangles(topologies[topologies.size() - 1]);
  double whole = 0;
  for (uint32_t f = 0; f < rows.size(); ++f) {
    const Triangle& t = surface[4 * wedges.SurfaceFace(f / 4) + f % 4];
    const double area = Norm(Vec3Cast<double>(Cross(positions[t[1]] - positions[t[0]], positions[t[2]] - positions[t[0]])));
    whole += 3 * area;
    for (const uint32_t row : rows[f]) target.weights[row] += static_cast<float>(area);
  }
  for (float& w : target.weights) w = whole > 0 ? static_cast<float>(w / whole) : 0.0f;
  return target;
}

CodedAttribute QuantizeAttribute(const AttributeTarget& target, const AttributeHeader& header, Span<const Topology> topologies,
                                 Span<const Vec3f> positions) {
  CodedAttribute coded{header, std::vector<std::vector<int32_t>>(topologies.size()), target.base_values};
  std::vector<float> difference(CodedComponents(header.precision)), differences;
  AttributeCodingState state(CodedComponents(header.precision));
  BitMeter meter;
  for (size_t i = 0; i < topologies.size(); ++i) {
    const AttributeWedges& wedges = target.wedges[i];
    const SurfaceLevel surface{topologies[i], positions};
    const size_t num_edges = wedges.topology.num_edges();
    PredictAttribute(header, wedges, surface, &coded.decoded);
    const float step = header.steps[i];
    if (!(step > 0)) {
      CodeAttributeLevel(wedges.topology, step, false, &state, &coded.residuals[i], &meter);
      continue;
    }
    coded.residuals[i].resize(difference.size() * num_edges);
    differences.resize(difference.size() * num_edges);
    for (uint32_t e = 0; e < num_edges; ++e) {
      Difference(header.precision, wedges, surface, e, coded.decoded, target.values, &difference);
      for (size_t c = 0; c < difference.size(); ++c) differences[c * num_edges + e] = difference[c] / step;
    }
    const bool continues = i + 1 < header.steps.size() && header.steps[i + 1] > 0;
    std::vector<int32_t> before(num_edges, 0);  // of the component before, whole
    CodeAttributeLevel(
        wedges.topology, step, continues, &state, &coded.residuals[i], &meter,
        [&](uint32_t c, uint32_t e, SetModels& models, const CoefficientContext& context, int32_t* value) {
          const size_t row = size_t{wedges.topology.num_vertices} + e;
          const float factor = target.factors.empty() ? 1.0f : target.factors[row * header.precision.components + c];
          const int32_t known = IsChained(header, c) ? before[e] : 0;
          *value = ChooseResidual(differences[c * num_edges + e] - static_cast<float>(known), factor, models, context);
          before[e] = known + *value;
        });
    AddResiduals(header, wedges, surface, step, coded.residuals[i], &coded.decoded);
  }
  return coded;
}

double AttributeRmsError(const AttributeTarget& target, const std::vector<float>& decoded) {
  const uint32_t n = target.precision.components;
  const bool is_direction = IsDirection(target.precision.kind);
  SquaresBySize squares;
  for (size_t row = 0; row < target.weights.size(); ++row) {
    if (target.weights[row] == 0) continue;
    double square = 0;
    if (is_direction) {
      const Vec3d a = Vec3Cast<double>(Normalized(VectorAt(decoded, row, n))), b = Vec3Cast<double>(Normalized(VectorAt(target.values, row, n)));
      const double angle = std::atan2(Norm(Cross(a, b)), Dot(a, b)) * kDegreesPerRadian;
      square = angle * angle;
    } else {
      for (uint32_t c = 0; c < n; ++c) {
        const double factor = target.factors.empty() ? 1.0 : static_cast<double>(target.factors[row * n + c]);
        const double d = factor * (static_cast<double>(decoded[row * n + c]) - target.values[row * n + c]);
        square += d * d;
      }
    }
    squares.Add(square, target.weights[row]);
  }
  return std::sqrt(squares.MeanOfLeast(kCountedShare));
}

double AttributeBits(const AttributeTarget& target, const CodedAttribute& coded) {
  AttributeCodingState state(CodedComponents(coded.header.precision));
  BitMeter meter;
  const std::vector<float>& steps = coded.header.steps;
  for (size_t i = 0; i < steps.size(); ++i) {
    std::vector<int32_t> residuals = coded.residuals[i];
    const bool continues = i + 1 < steps.size() && steps[i + 1] > 0;
    CodeAttributeLevel(target.wedges[i].topology, steps[i], continues, &state, &residuals, &meter);
  }
  return meter.bits();
}

namespace {

// What one way of prediction leads to.
struct PredictedAttribute {
  CodedAttribute best;    // the fewest bits that keep the error
  CodedAttribute finest;  // the least error of all that was tried
  double bits = std::numeric_limits<double>::infinity(), least_error = std::numeric_limits<double>::infinity();
};

// header: all but the steps.
PredictedAttribute EncodePredicted(const AttributeTarget& target, AttributeHeader header, double largest_error, Span<const Topology> topologies,
                                   Span<const Vec3f> positions) {
  const bool is_direction = target.precision.kind == AttributeKind::kNormal || target.precision.kind == AttributeKind::kTangent;
  const double unit = is_direction ? largest_error / kDegreesPerRadian : largest_error;
  PredictedAttribute result;
  for (int count = 0; count <= static_cast<int>(topologies.size()); ++count) {
    // The step is largest at 8 times the error asked for, and comes down until that is met.
    constexpr int kSteps = 64;
    int coarse = -1, fine = count == 0 ? 0 : kSteps;  // the error is met at `fine`, or nowhere
    CodedAttribute met;
    const auto attempt = [&](int i) {
      const double step = 8 * unit * std::pow(2.0, -i / 8.0);
      header.steps = StepsOf(static_cast<float>(step), count, topologies.size());
      CodedAttribute coded = QuantizeAttribute(target, header, topologies, positions);
      const double error = AttributeRmsError(target, coded.decoded);
      if (error < result.least_error) {
        result.least_error = error;
        result.finest = coded;
      }
      const bool is_met = error <= largest_error;
      if (is_met) met = std::move(coded);
      return is_met;
    };
    if (!attempt(fine)) continue;
    while (fine - coarse > 1 && count > 0) {
      const int middle = (coarse + fine) / 2;
      (attempt(middle) ? fine : coarse) = middle;
    }
    const double bits = AttributeBits(target, met);
    if (bits >= result.bits) continue;
    result.bits = bits;
    result.best = std::move(met);
  }
  return result;
}

}  // namespace

CodedAttribute EncodeAttribute(const AttributeTarget& target, double largest_error, Span<const Topology> topologies, Span<const Vec3f> positions) {
  std::vector<AttributeHeader> headers;
  const auto consider = [&](AttributePrediction prediction, bool is_chained) { headers.push_back({target.precision, prediction, {}, is_chained}); };
  for (const bool is_chained : {false, true}) {
    if (is_chained && !HasChain(target.precision)) break;
    consider(AttributePrediction::kButterfly, is_chained);
    consider(AttributePrediction::kLinear, is_chained);
  }
  if (target.precision.kind == AttributeKind::kNormal) consider(AttributePrediction::kGeometry, false);
  std::vector<PredictedAttribute> found(headers.size());
  ForEachBranch(headers.size(), [&](size_t i) { found[i] = EncodePredicted(target, headers[i], largest_error, topologies, positions); });
  const auto fewest = std::min_element(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.bits < b.bits; });
  if (std::isfinite(fewest->bits)) return std::move(fewest->best);
  return std::move(std::min_element(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.least_error < b.least_error; })->finest);
}

}  // namespace lacerta
