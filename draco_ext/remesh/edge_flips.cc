#include "remesh/edge_flips.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <set>
#include <utility>
#include <vector>

#include "geometry/closest_on_triangle.h"
#include "geometry/triangle_points.h"
#include "geometry/vertex_area_vectors.h"
#include "remesh/mesh_neighbors.h"

namespace lacerta {
namespace {

constexpr uint32_t kNone = SurfacePoint::kNone;
constexpr size_t kGrain = 64;  // of work for a thread
constexpr uint64_t kPointsOfFace = 6;  // that tell how far a triangle is from the input

Vec3d Vertex(const TriangleMesh& mesh, uint32_t v) { return Vec3Cast<double>(mesh.positions[v]); }

Vec3f PointOfFace(const TriangleMesh& mesh, const Triangle& t, uint64_t i) {
  const Vec3d weights = TrianglePoint(i, 0.5);
  return Vec3Cast<float>(Vertex(mesh, t[0]) * weights[0] + Vertex(mesh, t[1]) * weights[1] + Vertex(mesh, t[2]) * weights[2]);
}

double DoubledArea(const TriangleMesh& mesh) {
  double area = 0;
  for (const Triangle& t : mesh.triangles) area += Norm(AreaVector(mesh.positions, t));
  return area;
}

// Which of two triangles is closer to a point, and its squared distance.
std::pair<size_t, double> CloserOf(const TriangleMesh& mesh, const std::array<Triangle, 2>& triangles, const Vec3f& point) {
  std::pair<size_t, double> result{0, std::numeric_limits<double>::infinity()};
  for (size_t i = 0; i < 2; ++i) {
    const Triangle& t = triangles[i];
    ClosestWeights closest;
    const bool is_closer = ClosestOnTriangle(Vec3Cast<double>(point), Vertex(mesh, t[0]), Vertex(mesh, t[1]), Vertex(mesh, t[2]), result.second, &closest);
    if (is_closer && closest.squared_distance < result.second) result = {i, closest.squared_distance};
  }
  return result;
}

}  // namespace

// An edge from a to b of the triangle abc, and from b to a of the triangle bad.
struct EdgeFlipper::Edge {
  uint32_t a = kNone, b = kNone, c = kNone, d = kNone;
  std::array<uint32_t, 2> faces{kNone, kNone};
  std::array<uint32_t, 4> beyond{kNone, kNone, kNone, kNone};  // the corners on the other sides of bc, ca, ad and db, where there is one triangle

  std::array<Triangle, 2> Flipped() const { return {Triangle{a, d, c}, Triangle{d, b, c}}; }

  // Those of the mesh that may be turned.
  static std::vector<Edge> FindAll(const TriangleMesh& mesh, const MeshNeighbors& neighbors);
};

struct EdgeFlipper::Turn {
  Edge edge;
  double gain = 0;
};

std::vector<EdgeFlipper::Edge> EdgeFlipper::Edge::FindAll(const TriangleMesh& mesh, const MeshNeighbors& neighbors) {
  std::vector<Edge> all(neighbors.edges.size());
  std::vector<uint8_t> num_faces(all.size(), 0);  // 3: as good as any number of them
  for (uint32_t f = 0; f < mesh.triangles.size(); ++f) {
    const Triangle& t = mesh.triangles[f];
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t from = t[(k + 1) % 3], to = t[(k + 2) % 3], i = neighbors.face_edges[f][k];
      Edge& e = all[i];
      if (num_faces[i] == 0) {
        e = {from, to, t[k], kNone, {f, kNone}};
        num_faces[i] = 1;
      } else if (num_faces[i] == 1 && from == e.b && t[k] != e.c) {
        e.d = t[k];
        e.faces[1] = f;
        num_faces[i] = 2;
      } else {
        num_faces[i] = 3;
      }
    }
  }
  const auto beyond = [&](uint32_t f, uint32_t corner) {
    const Triangle& t = mesh.triangles[f];
    const uint32_t i = neighbors.face_edges[f][t[0] == corner ? 0 : t[1] == corner ? 1 : 2];
    return num_faces[i] != 2 ? kNone : all[i].faces[0] == f ? all[i].d : all[i].c;
  };
  const auto are_joined = [&](uint32_t u, uint32_t v) {
    const Span<const uint32_t> around = neighbors.vertex_edges[u];
    return std::any_of(around.begin(), around.end(), [&](uint32_t e) { return neighbors.edges[e][0] == v || neighbors.edges[e][1] == v; });
  };
  std::vector<Edge> result;
  for (size_t i = 0; i < all.size(); ++i) {
    Edge& e = all[i];
    if (num_faces[i] != 2 || are_joined(e.c, e.d)) continue;
    e.beyond = {beyond(e.faces[0], e.a), beyond(e.faces[0], e.b), beyond(e.faces[1], e.b), beyond(e.faces[1], e.a)};
    result.push_back(e);
  }
  return result;
}

// What flips of single edges are worth.
class EdgeFlipper::Meter {
 public:
  Meter(const EdgeFlipper& flipper, const RateModel& rate, const MeshNeighbors& neighbors)
      : target_(flipper.target_),
        rate_(rate),
        mesh_(flipper.mesh_),
        neighbors_(neighbors),
        distances_(flipper.distances_),
        hits_(flipper.hits_),
        first_(mesh_.triangles.size() + 1, 0),
        doubled_area_(DoubledArea(mesh_)) {
    for (const FitTarget::Hit& hit : hits_) {
      if (hit.face != kNone) ++first_[hit.face + 1];
    }
    for (size_t f = 0; f < mesh_.triangles.size(); ++f) first_[f + 1] += first_[f];
    order_.resize(first_.back());
    std::vector<uint32_t> next(first_.begin(), first_.end() - 1);
    for (uint32_t i = 0; i < hits_.size(); ++i) {
      if (hits_[i].face != kNone) order_[next[hits_[i].face]++] = i;
    }
  }

  // What the sum of both mean squared distances falls by, and what the bits saved are worth besides; not above 0 where the edge has to stay.
  double Gain(const Edge& edge) const {
    constexpr double kLeastShare = 0.02;  // of what there is: samples are few, and what seems best among many edges is so in part by chance
    constexpr double kTwoSides = 2;       // a bit's worth is told in their mean
    const std::array<Triangle, 2> old{mesh_.triangles[edge.faces[0]], mesh_.triangles[edge.faces[1]]}, flipped = edge.Flipped();
    if (LookAway(old, flipped)) return 0;
    const double worth_of_bits = rate_.distortion_per_bit > 0 ? kTwoSides * rate_.distortion_per_bit * BitsSaved(edge) : 0;
    const auto [forward, flipped_forward] = ForwardOf(edge, flipped);
    double before = forward;
    for (const uint32_t f : edge.faces) before += AreaShare(mesh_.triangles[f]) * distances_[f].mean_square;
    return GainOf(flipped, (1 - kLeastShare) * before + worth_of_bits - flipped_forward, distances_[edge.faces[0]].near);
  }

 private:
  Vec3d At(uint32_t v) const { return Vertex(mesh_, v); }

  bool LookAway(const std::array<Triangle, 2>& old, const std::array<Triangle, 2>& flipped) const {
    constexpr double kLeastCosine = 0.2;
    for (const Triangle& t : old) {
      const Vec3d normal = AreaVector(mesh_.positions, t);
      for (const Triangle& u : flipped) {
        const Vec3d other = AreaVector(mesh_.positions, u);
        if (!(Dot(normal, other) > kLeastCosine * Norm(normal) * Norm(other))) return true;
      }
    }
    return false;
  }

  // Of the samples of the input that are closest to the edge's triangles now: their part of the mean squared distance, and the same once it is turned.
  std::pair<double, double> ForwardOf(const Edge& edge, const std::array<Triangle, 2>& flipped) const {
    double now = 0, then = 0;
    for (const uint32_t f : edge.faces) {
      for (uint32_t i = first_[f]; i < first_[f + 1]; ++i) {
        const FitTarget::Hit& hit = hits_[order_[i]];
        now += hit.share * hit.squared_distance;
        then += hit.share * CloserOf(mesh_, flipped, hit.position).second;
      }
    }
    return {now, then};
  }

  double AreaShare(const Triangle& t) const { return Norm(AreaVector(mesh_.positions, t)) / doubled_area_; }

  // What is left of `gain` once the two triangles have their part in the mean squared distance from the mesh to the input; not above 0 where
  // nothing is. hint: a face of the input that may be near.
  double GainOf(const std::array<Triangle, 2>& triangles, double gain, uint32_t hint) const {
    for (const Triangle& t : triangles) {
      const double share = AreaShare(t) / kPointsOfFace;
      for (uint64_t i = 0; i < kPointsOfFace && gain > 0; ++i) gain -= share * target_.SquaredDistance(PointOfFace(mesh_, t, i), &hint);
    }
    return gain;
  }

  // Of positions, by the flaps over the four edges around, whose corners across change, and of the connectivity.
  double BitsSaved(const Edge& e) const {
    struct Flap {
      uint32_t from, to, across, across_flipped, beyond;
    };
    double saved = 0;
    for (const Flap& flap : {Flap{e.b, e.c, e.a, e.d, e.beyond[0]}, Flap{e.c, e.a, e.b, e.d, e.beyond[1]}, Flap{e.a, e.d, e.b, e.c, e.beyond[2]},
                             Flap{e.d, e.b, e.a, e.c, e.beyond[3]}}) {
      if (flap.beyond == kNone) continue;
      const Vec3d rest = At(flap.from) + At(flap.to) - At(flap.beyond);
      saved += rate_.BitsOfFlap(SquaredNorm(rest - At(flap.across))) - rate_.BitsOfFlap(SquaredNorm(rest - At(flap.across_flipped)));
    }
    // About a bit for every edge by which a vertex has other than six.
    const auto irregularity = [&](uint32_t v, int change) { return std::abs(static_cast<int>(neighbors_.vertex_edges[v].size()) + change - 6); };
    for (const uint32_t v : {e.a, e.b}) saved += irregularity(v, 0) - irregularity(v, -1);
    for (const uint32_t v : {e.c, e.d}) saved += irregularity(v, 0) - irregularity(v, 1);
    return saved;
  }

  const FitTarget& target_;
  const RateModel& rate_;
  const TriangleMesh& mesh_;
  const MeshNeighbors& neighbors_;
  const std::vector<FaceDistance>& distances_;
  const std::vector<FitTarget::Hit>& hits_;
  std::vector<uint32_t> first_, order_;  // hits on face f: order_[first_[f]] .. order_[first_[f + 1] - 1]
  const double doubled_area_;
};

EdgeFlipper::EdgeFlipper(const FitTarget& target, TriangleMesh* mesh)
    : target_(target), mesh_(*mesh), distances_(mesh->triangles.size()), hits_(target.HitsOn(*mesh)) {
  tbb::parallel_for(tbb::blocked_range<uint32_t>(0, static_cast<uint32_t>(distances_.size()), kGrain), [&](const tbb::blocked_range<uint32_t>& range) {
    uint32_t hint = kNone;
    for (uint32_t f = range.begin(); f != range.end(); ++f) {
      distances_[f] = DistanceOf(f, hint);
      hint = distances_[f].near;
    }
  });
}

EdgeFlipper::FaceDistance EdgeFlipper::DistanceOf(uint32_t face, uint32_t hint) const {
  FaceDistance result{0, hint};
  for (uint64_t i = 0; i < kPointsOfFace; ++i) {
    result.mean_square += target_.SquaredDistance(PointOfFace(mesh_, mesh_.triangles[face], i), &result.near) / kPointsOfFace;
  }
  return result;
}

double EdgeFlipper::Distortion() const {
  double forward = 0, backward = 0;
  for (const FitTarget::Hit& hit : hits_) forward += hit.share * hit.squared_distance;
  const double doubled_area = DoubledArea(mesh_);
  if (!(doubled_area > 0)) return target_.diagonal() * target_.diagonal();
  for (size_t f = 0; f < distances_.size(); ++f) backward += Norm(AreaVector(mesh_.positions, mesh_.triangles[f])) / doubled_area * distances_[f].mean_square;
  return std::max(forward, backward);
}

// Those that gain, the best first, of edges near vertices that are marked.
std::vector<EdgeFlipper::Turn> EdgeFlipper::FindTurns(const RateModel& rate, const std::vector<uint8_t>& is_marked) const {
  const MeshNeighbors neighbors(mesh_);
  const Meter meter(*this, rate, neighbors);
  std::vector<Turn> turns;
  for (const Edge& edge : Edge::FindAll(mesh_, neighbors)) {
    if ((is_marked[edge.a] | is_marked[edge.b] | is_marked[edge.c] | is_marked[edge.d]) != 0) turns.push_back({edge, 0});
  }
  tbb::parallel_for(tbb::blocked_range<size_t>(0, turns.size(), kGrain), [&](const tbb::blocked_range<size_t>& range) {
    for (size_t i = range.begin(); i != range.end(); ++i) turns[i].gain = meter.Gain(turns[i].edge);
  });
  turns.erase(std::remove_if(turns.begin(), turns.end(), [](const Turn& turn) { return !(turn.gain > 0); }), turns.end());
  std::stable_sort(turns.begin(), turns.end(), [](const Turn& x, const Turn& y) { return x.gain > y.gain; });
  return turns;
}

// Samples stay with the two faces of an edge that was turned, for the closer one. turned_with: of each face the other one, or kNone.
void EdgeFlipper::GiveHits(const std::vector<uint32_t>& turned_with) {
  for (FitTarget::Hit& hit : hits_) {
    if (hit.face == kNone || turned_with[hit.face] == kNone) continue;
    const std::array<uint32_t, 2> faces{hit.face, turned_with[hit.face]};
    const auto [closer, squared_distance] = CloserOf(mesh_, {mesh_.triangles[faces[0]], mesh_.triangles[faces[1]]}, hit.position);
    hit.face = faces[closer];
    hit.squared_distance = squared_distance;
  }
}

size_t EdgeFlipper::Flip(const RateModel& rate) {
  constexpr int kMostPasses = 3;
  size_t num_flipped = 0;
  std::vector<uint8_t> is_changed(mesh_.positions.size(), 1);  // by the last pass: elsewhere nothing gained then, nor does it now
  for (int pass = 0; pass < kMostPasses; ++pass) {
    const size_t before = num_flipped;
    const std::vector<Turn> turns = FindTurns(rate, is_changed);
    std::fill(is_changed.begin(), is_changed.end(), uint8_t{0});
    std::vector<uint32_t> turned_with(mesh_.triangles.size(), kNone);
    std::set<std::pair<uint32_t, uint32_t>> made;  // edges
    for (const auto& [edge, gain] : turns) {
      const auto [first, second] = edge.faces;
      if (turned_with[first] != kNone || turned_with[second] != kNone || !made.emplace(std::minmax(edge.c, edge.d)).second) continue;
      turned_with[first] = second;
      turned_with[second] = first;
      const std::array<Triangle, 2> flipped = edge.Flipped();
      mesh_.triangles[first] = flipped[0];
      mesh_.triangles[second] = flipped[1];
      for (const uint32_t f : edge.faces) distances_[f] = DistanceOf(f, distances_[f].near);
      for (const uint32_t v : {edge.a, edge.b, edge.c, edge.d}) is_changed[v] = 1;
      ++num_flipped;
    }
    if (num_flipped == before) break;
    GiveHits(turned_with);
  }
  return num_flipped;
}

}  // namespace lacerta
