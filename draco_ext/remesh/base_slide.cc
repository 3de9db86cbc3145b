#include "remesh/base_slide.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "common/butterfly.h"
#include "common/subdivision.h"
#include "geometry/triangle_tree.h"
#include "remesh/conjugate_gradients.h"

namespace lacerta {
namespace {

constexpr uint32_t kMostPoints = 40'000;  // of all levels that are looked at

// Base vertices and the midpoints of some levels, numbered as in the finest of these, and what is predicted from what.
struct MidpointsOver {
  struct Midpoint {
    std::array<uint32_t, 2> ends{};  // of its edge
    size_t first = 0;                // of its stencil, up to the first of the next midpoint
    double weight = 0.0;             // of what it takes; 0 on curves, which are coded otherwise
  };
  struct Entry {
    uint32_t point;
    double weight;
  };

  explicit MidpointsOver(const Topology& base);

  uint32_t num_base() const { return level_ends.front(); }
  uint32_t num_points() const { return level_ends.back(); }
  const Midpoint& midpoint(uint32_t point) const { return midpoints[point - num_base()]; }
  Vec3d Predicted(uint32_t point, const std::vector<Vec3d>& at) const {
    Vec3d sum;
    ForStencil(point, [&](const Entry& entry) { sum += at[entry.point] * entry.weight; });
    return sum;
  }
  template <typename Visit>
  void ForStencil(uint32_t point, const Visit& visit) const {
    for (size_t k = midpoint(point).first; k < midpoint(point + 1).first; ++k) visit(stencils[k]);
  }
  // visit(point) for all midpoints, a level after the other, on all cores.
  template <typename Visit>
  void ForLevels(const Visit& visit) const {
    for (size_t level = 1; level < level_ends.size(); ++level) tbb::parallel_for(level_ends[level - 1], level_ends[level], visit);
  }

  std::vector<uint32_t> level_ends;  // numbers of points up to each level, the base first
  std::vector<Midpoint> midpoints;   // and one more that ends the last stencil
  std::vector<Entry> stencils;
};

MidpointsOver::MidpointsOver(const Topology& base) : level_ends{base.num_vertices} {
  constexpr double kLevelWeight = 2.0;      // of a level, over that of the one before
  double weight = 1.0;
  for (Topology level = base;; level = Refine(level)) {
    const StencilTable table(level);
    for (uint32_t e = 0; e < level.num_edges(); ++e) {
      midpoints.push_back({level.edges[e], stencils.size(), level.on_curve[e] != 0 ? 0.0 : weight});
      VisitStencil(level, table, e, [&](uint32_t v, float w) { stencils.push_back({v, static_cast<double>(w)}); });
    }
    level_ends.push_back(level.num_vertices + level.num_edges());
    if (num_points() > kMostPoints / 4) break;
    weight *= kLevelWeight;
  }
  midpoints.push_back({{}, stencils.size(), 0.0});
}

// The corners opposite to an edge, then its ends.
using Flap = std::array<uint32_t, 4>;

std::vector<Flap> FlapsOf(const Topology& base) {
  std::vector<Flap> flaps;
  for (uint32_t e = 0; e < base.num_edges(); ++e) {
    const auto& [f, g] = base.edge_faces[e];
    if (g != kNone) flaps.push_back({OppositeVertex(base, f, e), OppositeVertex(base, g, e), base.edges[e][0], base.edges[e][1]});
  }
  return flaps;
}

Vec3d OffParallelogram(const Flap& flap, const std::vector<Vec3d>& at) { return at[flap[0]] + at[flap[1]] - at[flap[2]] - at[flap[3]]; }

Vec3d Along(const Vec3d& move, const Vec3d& normal) { return move - normal * Dot(move, normal); }
Vec3d Limited(const Vec3d& move, double most) { return Norm(move) > most ? move * (most / Norm(move)) : move; }

class BaseSlide {
 public:
  BaseSlide(const InputSurface& surface, const BaseDomain& domain, const std::vector<Vec3f>& positions);

  std::vector<DomainPoint> Run();

 private:
  struct State {
    std::vector<Vec3d> at;             // of each point, on the input
    std::vector<Vec3d> normals;        // of the input there
    std::vector<uint32_t> faces;       // of the input there; none of base vertices that have not slid
    std::vector<double> distances;     // of midpoints as predicted, with the sign of their side
    std::vector<DomainPoint> slid_to;  // of base vertices
    double cost = 0.0;
  };
  struct Weights {  // of squares
    std::vector<double> midpoints, flaps;
  };

  double Bits(double square) const { return 0.5 * std::log2(1.0 + square / squared_resolution_); }
  double SlopeOfBits(double square) const { return 1.0 / (squared_resolution_ + square); }  // over the square; but for a factor
  Vec3d NormalAt(const SurfacePoint& p) const { return Vec3Cast<double>(surface_.NormalAt(p.face, InputPoint(p).barycentric)); }
  double MeanDistanceOfFirstLevel() const;
  double MeanEdgeLength() const;
  void FindMidpoints(State* s) const;
  void FindMidpoint(uint32_t point, State* s) const;
  double Cost(const State& s) const;
  std::vector<Vec3d> Moves() const;
  std::vector<Vec3d> Applied(const std::vector<Vec3d>& moves, const Weights& weights) const;
  std::vector<Vec3d> Gradient(const std::vector<double>& distances, const std::vector<Vec3d>& off_parallelograms, const Weights& weights) const;
  State Moved(const std::vector<Vec3d>& moves, double factor) const;

  const InputSurface& surface_;
  const MidpointsOver points_;
  const std::vector<Flap> flaps_;
  std::vector<double> edge_lengths_;  // mean at each base vertex
  std::vector<char> is_movable_;      // of base vertices
  State start_, state_;
  double squared_resolution_ = 0.0;  // 0: there is nothing to code
};

BaseSlide::BaseSlide(const InputSurface& surface, const BaseDomain& domain, const std::vector<Vec3f>& positions)
    : surface_(surface), points_(domain.topology()), flaps_(FlapsOf(domain.topology())), edge_lengths_(points_.num_base(), 0.0) {
  constexpr double kResolution = 0.5;  // over the mean distance on the first level
  constexpr double kFlat = 1e-5;       // of that distance, over edges: what rounding makes
  const Topology& base = domain.topology();
  for (const auto& [a, b] : base.edges) {
    for (const uint32_t v : {a, b}) edge_lengths_[v] += Norm(positions[a] - positions[b]) / base.valence[v];
  }
  State& s = state_;
  s.at.resize(points_.num_points());
  s.normals.resize(points_.num_points());
  s.faces.resize(points_.num_points(), kNone);
  s.distances.resize(points_.num_points());
  s.slid_to.resize(points_.num_base());
  for (uint32_t v = 0; v < points_.num_base(); ++v) {
    s.at[v] = Vec3Cast<double>(positions[v]);
    const uint32_t on_input = domain.input_vertex(v);
    if (on_input != kNone) s.normals[v] = Vec3Cast<double>(surface.vertex_normal(on_input));
    is_movable_.push_back(base.valence[v] > 0 && base.role[v] == CurveRole::kSmooth && SquaredNorm(s.normals[v]) > 0.0);
  }
  FindMidpoints(&s);
  const double distance = MeanDistanceOfFirstLevel();
  if (distance > kFlat * MeanEdgeLength()) squared_resolution_ = kResolution * kResolution * distance * distance;
  s.cost = Cost(s);
  start_ = s;
}

std::vector<DomainPoint> BaseSlide::Run() {
  constexpr int kMostSteps = 8;
  constexpr double kFirstFactor = 1.5;     // of a step: curvatures of logarithms are less than what is taken for them
  constexpr double kLeastFactor = 0.3;
  constexpr double kWorthwhile = 0.003;    // of the cost
  double factor = kFirstFactor;
  for (int step = 0; step < kMostSteps && squared_resolution_ > 0.0; ++step) {
    const double before = state_.cost;
    const std::vector<Vec3d> moves = Moves();
    State next = Moved(moves, factor);
    while (!(next.cost < before) && factor > kLeastFactor) next = Moved(moves, factor /= 2);
    if (next.cost < before) state_ = std::move(next);
    if (!(state_.cost < (1.0 - kWorthwhile) * before)) break;
  }
  return state_.slid_to;
}

double BaseSlide::MeanDistanceOfFirstLevel() const {
  double sum = 0.0, count = 0.0;
  for (uint32_t point = points_.level_ends[0]; point < points_.level_ends[1]; ++point) {
    if (!(points_.midpoint(point).weight > 0.0)) continue;
    sum += std::fabs(state_.distances[point]);
    count += 1.0;
  }
  return sum / std::max(1.0, count);
}

double BaseSlide::MeanEdgeLength() const {
  double sum = 0.0;
  for (const double length : edge_lengths_) sum += length;
  return sum / std::max(1.0, static_cast<double>(edge_lengths_.size()));
}

void BaseSlide::FindMidpoints(State* s) const {
  points_.ForLevels([&](uint32_t point) { FindMidpoint(point, s); });
}

void BaseSlide::FindMidpoint(uint32_t point, State* s) const {
  constexpr double kLeastCosine = 0.2;     // between the normals of the midpoint and of the ends of its edge, or it is on another sheet
  constexpr double kOnAnotherSheet = 0.5;  // distance that it stands for, in lengths of the edge
  const auto& [a, b] = points_.midpoint(point).ends;
  const Vec3d predicted = points_.Predicted(point, s->at);
  const uint32_t hint = s->faces[point] != kNone ? s->faces[point] : s->faces[a];
  const SurfacePoint closest = surface_.tree().ClosestPointNear(Vec3Cast<float>(predicted), hint).point;
  const Vec3d expected = s->normals[a] + s->normals[b];
  s->faces[point] = closest.face;
  if (closest.face != kNone) s->normals[point] = NormalAt(closest);
  if (closest.face != kNone && Dot(s->normals[point], expected) > kLeastCosine * Norm(expected)) {
    s->at[point] = Vec3Cast<double>(closest.position);
    const Vec3d away = predicted - s->at[point];
    s->distances[point] = std::copysign(Norm(away), Dot(away, s->normals[point]));
  } else {
    s->at[point] = predicted;
    s->normals[point] = Normalized(expected);
    s->distances[point] = kOnAnotherSheet * Norm(s->at[a] - s->at[b]);
  }
}

double BaseSlide::Cost(const State& s) const {
  double cost = 0.0;
  for (uint32_t point = points_.num_base(); point < points_.num_points(); ++point) {
    cost += points_.midpoint(point).weight * Bits(s.distances[point] * s.distances[point]);
  }
  for (const Flap& flap : flaps_) cost += Bits(SquaredNorm(OffParallelogram(flap, s.at)) / 3.0);  // three coordinates, a third of which counts: a vertex has three flaps
  return cost;
}

// Of the base vertices, along the input: a Gauss-Newton step.
std::vector<Vec3d> BaseSlide::Moves() const {
  constexpr int kRounds = 10;
  Weights weights;
  weights.midpoints.resize(points_.num_points());
  for (uint32_t point = points_.num_base(); point < points_.num_points(); ++point) {
    weights.midpoints[point] = points_.midpoint(point).weight * SlopeOfBits(state_.distances[point] * state_.distances[point]);
  }
  std::vector<Vec3d> off_parallelograms;
  for (const Flap& flap : flaps_) {
    off_parallelograms.push_back(OffParallelogram(flap, state_.at));
    weights.flaps.push_back(SlopeOfBits(SquaredNorm(off_parallelograms.back()) / 3.0) / 3.0);
  }
  std::vector<Vec3d> downhill = Gradient(state_.distances, off_parallelograms, weights);
  for (Vec3d& pull : downhill) pull = pull * -1.0;
  return ConjugateGradients(std::move(downhill), kRounds, [&](const std::vector<Vec3d>& moves) { return Applied(moves, weights); });
}

// The matrix of the step, times moves along the input.
std::vector<Vec3d> BaseSlide::Applied(const std::vector<Vec3d>& moves, const Weights& weights) const {
  std::vector<Vec3d> of_points = moves;
  of_points.resize(points_.num_points());
  std::vector<double> across(points_.num_points());  // of midpoints as predicted; what they do along the input they take with them
  points_.ForLevels([&](uint32_t point) {
    const Vec3d predicted = points_.Predicted(point, of_points);
    across[point] = Dot(predicted, state_.normals[point]);
    of_points[point] = predicted - state_.normals[point] * across[point];
  });
  std::vector<Vec3d> off_parallelograms;
  for (const Flap& flap : flaps_) off_parallelograms.push_back(OffParallelogram(flap, of_points));
  return Gradient(across, off_parallelograms, weights);
}

// Half of that of the sum of weighted squares, at the base vertices and along the input.
std::vector<Vec3d> BaseSlide::Gradient(const std::vector<double>& distances, const std::vector<Vec3d>& off_parallelograms, const Weights& weights) const {
  std::vector<Vec3d> pulls(points_.num_points());
  for (uint32_t point = points_.num_points(); point-- > points_.num_base();) {
    const Vec3d& normal = state_.normals[point];
    const Vec3d pull = Along(pulls[point], normal) + normal * (weights.midpoints[point] * distances[point]);
    points_.ForStencil(point, [&](const MidpointsOver::Entry& entry) { pulls[entry.point] += pull * entry.weight; });
  }
  for (size_t f = 0; f < flaps_.size(); ++f) {
    const Vec3d pull = off_parallelograms[f] * weights.flaps[f];
    for (size_t k = 0; k < 4; ++k) pulls[flaps_[f][k]] += k < 2 ? pull : pull * -1.0;
  }
  pulls.resize(points_.num_base());
  for (uint32_t v = 0; v < points_.num_base(); ++v) pulls[v] = is_movable_[v] != 0 ? Along(pulls[v], state_.normals[v]) : Vec3d{};
  return pulls;
}

BaseSlide::State BaseSlide::Moved(const std::vector<Vec3d>& moves, double factor) const {
  constexpr double kFarthest = 0.5, kFarthestStep = 0.2;  // in lengths of edges
  constexpr double kLeastCosine = 0.8;                    // between the normals where a vertex was and where it goes: not around a tip
  State s = state_;
  for (uint32_t v = 0; v < points_.num_base(); ++v) {
    if (is_movable_[v] == 0) continue;
    const Vec3d to = s.at[v] + Limited(moves[v] * factor, kFarthestStep * edge_lengths_[v]);
    const Vec3d target = start_.at[v] + Limited(to - start_.at[v], kFarthest * edge_lengths_[v]);
    const SurfacePoint closest = surface_.tree().ClosestPointNear(Vec3Cast<float>(target), s.faces[v]).point;
    if (closest.face == kNone) continue;
    const Vec3d normal = NormalAt(closest);
    if (Dot(normal, start_.normals[v]) < kLeastCosine) continue;
    s.slid_to[v] = InputPoint(closest);
    s.faces[v] = closest.face;
    s.at[v] = Vec3Cast<double>(closest.position);
    s.normals[v] = normal;
  }
  FindMidpoints(&s);
  s.cost = Cost(s);
  return s;
}

}  // namespace

void SlideBase(const InputSurface& surface, BaseDomain* domain, std::vector<Vec3f>* positions) {
  if (domain->topology().num_vertices + domain->topology().num_edges() > kMostPoints) return;
  domain->Slide(BaseSlide(surface, *domain, *positions).Run(), *positions);
  for (uint32_t v = 0; v < positions->size(); ++v) {
    const DomainPoint& place = domain->slid_to(v);
    if (place.face != kNone) (*positions)[v] = surface.PositionAt(place.face, place.barycentric);
  }
}

}  // namespace lacerta
