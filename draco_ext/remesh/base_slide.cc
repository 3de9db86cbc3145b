#include "remesh/base_slide.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "geometry/triangle_tree.h"
#include "remesh/base_midpoints.h"
#include "remesh/conjugate_gradients.h"

namespace lacerta {
namespace {

Vec3d Along(const Vec3d& move, const Vec3d& normal) { return move - normal * Dot(move, normal); }
Vec3d Limited(const Vec3d& move, double most) { return Norm(move) > most ? move * (most / Norm(move)) : move; }

class BaseSlide {
 public:
  BaseSlide(const InputSurface& surface, const BaseDomain& domain, const std::vector<Vec3f>& positions, uint32_t enough_points);

  std::vector<DomainPoint> Run();

 private:
  struct State {
    PointsOnInput points;
    std::vector<DomainPoint> slid_to;  // of base vertices
    double cost = 0.0;
  };
  struct Weights {  // of squares
    std::vector<double> midpoints, flaps;
  };

  void FindMidpoints(PointsOnInput* points) const {
    midpoints_.ForLevels([&](uint32_t point) { FindMidpoint(surface_, midpoints_, point, points); });
  }
  double Cost(const PointsOnInput& points) const;
  std::vector<Vec3d> Moves() const;
  std::vector<Vec3d> Applied(const std::vector<Vec3d>& moves, const Weights& weights) const;
  std::vector<Vec3d> Gradient(const std::vector<double>& distances, const std::vector<Vec3d>& off_parallelograms, const Weights& weights) const;
  State Moved(const std::vector<Vec3d>& moves, double factor) const;

  const InputSurface& surface_;
  const MidpointsOver midpoints_;
  const std::vector<Flap> flaps_;
  std::vector<double> edge_lengths_;          // mean at each base vertex
  std::vector<char> is_movable_;              // of base vertices
  std::vector<Vec3d> first_at_, first_normals_;  // of base vertices, where they begin
  State state_;
  std::optional<CodingBits> bits_;
};

BaseSlide::BaseSlide(const InputSurface& surface, const BaseDomain& domain, const std::vector<Vec3f>& positions, uint32_t enough_points)
    : surface_(surface), midpoints_(domain.topology(), enough_points), flaps_(FlapsOf(domain.topology())), edge_lengths_(midpoints_.num_base(), 0.0) {
  const Topology& base = domain.topology();
  for (const auto& [a, b] : base.edges) {
    for (const uint32_t v : {a, b}) edge_lengths_[v] += Norm(positions[a] - positions[b]) / base.valence[v];
  }
  PointsOnInput& points = state_.points;
  points = BaseOnInput(surface, domain, positions, midpoints_.num_points());
  for (uint32_t v = 0; v < midpoints_.num_base(); ++v) {
    state_.slid_to.push_back(domain.slid_to(v));
    first_at_.push_back(points.at[v]);
    first_normals_.push_back(points.normals[v]);
    is_movable_.push_back(base.valence[v] > 0 && base.role[v] == CurveRole::kSmooth && SquaredNorm(points.normals[v]) > 0.0);
  }
  FindMidpoints(&points);
  bits_.emplace(midpoints_, points);
  if (!bits_->is_nothing()) state_.cost = Cost(points);
}

std::vector<DomainPoint> BaseSlide::Run() {
  constexpr int kMostSteps = 8;
  constexpr double kFirstFactor = 1.5;   // of a step: curvatures of logarithms are less than what is taken for them
  constexpr double kLeastFactor = 0.3;
  constexpr double kWorthwhile = 0.003;  // of the cost
  double factor = kFirstFactor;
  for (int step = 0; step < kMostSteps && !bits_->is_nothing(); ++step) {
    const double before = state_.cost;
    const std::vector<Vec3d> moves = Moves();
    State next = Moved(moves, factor);
    while (!(next.cost < before) && factor > kLeastFactor) next = Moved(moves, factor /= 2);
    if (next.cost < before) state_ = std::move(next);
    if (!(state_.cost < (1.0 - kWorthwhile) * before)) break;
  }
  return state_.slid_to;
}

double BaseSlide::Cost(const PointsOnInput& points) const {
  double cost = 0.0;
  for (uint32_t point = midpoints_.num_base(); point < midpoints_.num_points(); ++point) {
    cost += midpoints_.midpoint(point).weight * bits_->Of(points.distances[point] * points.distances[point]);
  }
  for (const Flap& flap : flaps_) cost += bits_->OfFlap(flap, points.at);
  return cost;
}

// Of the base vertices, along the input: a Gauss-Newton step.
std::vector<Vec3d> BaseSlide::Moves() const {
  constexpr int kRounds = 10;
  const PointsOnInput& points = state_.points;
  Weights weights;
  weights.midpoints.resize(midpoints_.num_points());
  for (uint32_t point = midpoints_.num_base(); point < midpoints_.num_points(); ++point) {
    weights.midpoints[point] = midpoints_.midpoint(point).weight * bits_->Slope(points.distances[point] * points.distances[point]);
  }
  std::vector<Vec3d> off_parallelograms;
  for (const Flap& flap : flaps_) {
    off_parallelograms.push_back(OffParallelogram(flap, points.at));
    weights.flaps.push_back(bits_->Slope(SquaredNorm(off_parallelograms.back()) / 3.0) / 3.0);
  }
  std::vector<Vec3d> downhill = Gradient(points.distances, off_parallelograms, weights);
  for (Vec3d& pull : downhill) pull = pull * -1.0;
  return ConjugateGradients(std::move(downhill), kRounds, [&](const std::vector<Vec3d>& moves) { return Applied(moves, weights); });
}

// The matrix of the step, times moves along the input.
std::vector<Vec3d> BaseSlide::Applied(const std::vector<Vec3d>& moves, const Weights& weights) const {
  std::vector<Vec3d> of_points = moves;
  of_points.resize(midpoints_.num_points());
  std::vector<double> across(midpoints_.num_points());  // of midpoints as predicted; what they do along the input they take with them
  midpoints_.ForLevels([&](uint32_t point) {
    const Vec3d predicted = midpoints_.Predicted(point, of_points);
    across[point] = Dot(predicted, state_.points.normals[point]);
    of_points[point] = predicted - state_.points.normals[point] * across[point];
  });
  std::vector<Vec3d> off_parallelograms;
  for (const Flap& flap : flaps_) off_parallelograms.push_back(OffParallelogram(flap, of_points));
  return Gradient(across, off_parallelograms, weights);
}

// Half of that of the sum of weighted squares, at the base vertices and along the input.
std::vector<Vec3d> BaseSlide::Gradient(const std::vector<double>& distances, const std::vector<Vec3d>& off_parallelograms, const Weights& weights) const {
  std::vector<Vec3d> pulls(midpoints_.num_points());
  for (uint32_t point = midpoints_.num_points(); point-- > midpoints_.num_base();) {
    const Vec3d& normal = state_.points.normals[point];
    const Vec3d pull = Along(pulls[point], normal) + normal * (weights.midpoints[point] * distances[point]);
    midpoints_.ForStencil(point, [&](const MidpointsOver::Entry& entry) { pulls[entry.point] += pull * entry.weight; });
  }
  for (size_t f = 0; f < flaps_.size(); ++f) {
    const Vec3d pull = off_parallelograms[f] * weights.flaps[f];
    for (size_t k = 0; k < 4; ++k) pulls[flaps_[f][k]] += k < 2 ? pull : pull * -1.0;
  }
  pulls.resize(midpoints_.num_base());
  for (uint32_t v = 0; v < midpoints_.num_base(); ++v) pulls[v] = is_movable_[v] != 0 ? Along(pulls[v], state_.points.normals[v]) : Vec3d{};
  return pulls;
}

BaseSlide::State BaseSlide::Moved(const std::vector<Vec3d>& moves, double factor) const {
  constexpr double kFarthest = 0.5, kFarthestStep = 0.2;  // in lengths of edges
  constexpr double kLeastCosine = 0.8;                    // between the normals where a vertex was and where it goes: not around a tip
  State s = state_;
  PointsOnInput& points = s.points;
  for (uint32_t v = 0; v < midpoints_.num_base(); ++v) {
    if (is_movable_[v] == 0) continue;
    const Vec3d to = points.at[v] + Limited(moves[v] * factor, kFarthestStep * edge_lengths_[v]);
    const Vec3d target = first_at_[v] + Limited(to - first_at_[v], kFarthest * edge_lengths_[v]);
    const SurfacePoint closest = surface_.tree().ClosestPointNear(Vec3Cast<float>(target), points.faces[v]).point;
    if (closest.face == kNone) continue;
    const DomainPoint place = InputPoint(closest);
    const auto normal = Vec3Cast<double>(surface_.NormalAt(place.face, place.barycentric));
    if (Dot(normal, first_normals_[v]) < kLeastCosine) continue;
    s.slid_to[v] = place;
    points.faces[v] = closest.face;
    points.at[v] = Vec3Cast<double>(closest.position);
    points.normals[v] = normal;
  }
  FindMidpoints(&points);
  s.cost = Cost(points);
  return s;
}

}  // namespace

void SlideBase(const InputSurface& surface, BaseDomain* domain, std::vector<Vec3f>* positions, uint32_t enough_points) {
  domain->Slide(BaseSlide(surface, *domain, *positions, enough_points).Run(), *positions);
  for (uint32_t v = 0; v < positions->size(); ++v) {
    const DomainPoint& place = domain->slid_to(v);
    if (place.face != kNone) (*positions)[v] = surface.PositionAt(place.face, place.barycentric);
  }
}

}  // namespace lacerta
