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

// An edge from a to b of the triangle abc, and from b to a of the triangle bad.
struct Edge {
  uint32_t a = kNone, b = kNone, c = kNone, d = kNone;
  std::array<uint32_t, 2> faces{kNone, kNone};
  std::array<uint32_t, 4> beyond{kNone, kNone, kNone, kNone};  // the corners on the other sides of bc, ca, ad and db, where there is one triangle

  std::array<Triangle, 2> Flipped() const { return {Triangle{a, d, c}, Triangle{d, b, c}}; }
};

// Of edges of the mesh, those that may be turned.
std::vector<Edge> FindEdges(const TriangleMesh& mesh, const MeshNeighbors& neighbors) {
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

constexpr uint64_t kPointsOfFace = 6;  // that tell how far a triangle is from the input

Vec3f PointOfFace(const TriangleMesh& mesh, const Triangle& t, uint64_t i) {
  const Vec3d weights = TrianglePoint(i, 0.5);
  Vec3d point;
  for (int k = 0; k < 3; ++k) point += Vec3Cast<double>(mesh.positions[t[k]]) * weights[k];
  return Vec3Cast<float>(point);
}

// How far a triangle is from the input.
struct FaceDistance {
  double mean_square = 0;
  uint32_t near = kNone;  // a face of the input there
};

FaceDistance DistanceOfFace(const FitTarget& target, const TriangleMesh& mesh, uint32_t face, uint32_t hint) {
  FaceDistance result{0, hint};
  for (uint64_t i = 0; i < kPointsOfFace; ++i) {
    result.mean_square += target.SquaredDistance(PointOfFace(mesh, mesh.triangles[face], i), &result.near) / kPointsOfFace;
  }
  return result;
}

std::vector<FaceDistance> DistancesOfFaces(const FitTarget& target, const TriangleMesh& mesh) {
  std::vector<FaceDistance> result(mesh.triangles.size());
  tbb::parallel_for(tbb::blocked_range<uint32_t>(0, static_cast<uint32_t>(result.size()), kGrain), [&](const tbb::blocked_range<uint32_t>& range) {
    uint32_t hint = kNone;
    for (uint32_t f = range.begin(); f != range.end(); ++f) {
      result[f] = DistanceOfFace(target, mesh, f, hint);
      hint = result[f].near;
    }
  });
  return result;
}

// What flips of single edges of a mesh are worth.
class FlipMeter {
 public:
  // distances: of the mesh's faces.
  FlipMeter(const FitTarget& target, const RateModel& rate, const TriangleMesh& mesh, const MeshNeighbors& neighbors,
            const std::vector<FaceDistance>& distances)
      : target_(target),
        rate_(rate),
        mesh_(mesh),
        neighbors_(neighbors),
        distances_(distances),
        hits_(target.HitsOn(mesh)),
        first_(mesh.triangles.size() + 1, 0) {
    for (const FitTarget::Hit& hit : hits_) {
      if (hit.face != kNone) ++first_[hit.face + 1];
    }
    for (size_t f = 0; f < mesh.triangles.size(); ++f) first_[f + 1] += first_[f];
    order_.resize(first_.back());
    std::vector<uint32_t> next(first_.begin(), first_.end() - 1);
    for (uint32_t i = 0; i < hits_.size(); ++i) {
      if (hits_[i].face != kNone) order_[next[hits_[i].face]++] = i;
    }
    for (const Triangle& t : mesh.triangles) doubled_area_ += Norm(AreaVector(mesh.positions, t));
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
  Vec3d At(uint32_t v) const { return Vec3Cast<double>(mesh_.positions[v]); }

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
        double least = std::numeric_limits<double>::infinity();
        for (const Triangle& t : flipped) {
          ClosestWeights closest;
          const bool is_closer = ClosestOnTriangle(Vec3Cast<double>(hit.position), At(t[0]), At(t[1]), At(t[2]), least, &closest);
          if (is_closer) least = std::min(least, closest.squared_distance);
        }
        then += hit.share * least;
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
  const std::vector<FitTarget::Hit> hits_;
  std::vector<uint32_t> first_, order_;  // hits on face f: order_[first_[f]] .. order_[first_[f + 1] - 1]
  double doubled_area_ = 0;
};

struct Flip {
  Edge edge;
  double gain = 0;
};

// Those that gain, the best first, of edges near vertices that are marked.
std::vector<Flip> FindFlips(const FitTarget& target, const RateModel& rate, const TriangleMesh& mesh, const std::vector<FaceDistance>& distances,
                            const std::vector<uint8_t>& is_marked) {
  const MeshNeighbors neighbors(mesh);
  const FlipMeter meter(target, rate, mesh, neighbors, distances);
  std::vector<Flip> flips;
  for (const Edge& edge : FindEdges(mesh, neighbors)) {
    if ((is_marked[edge.a] | is_marked[edge.b] | is_marked[edge.c] | is_marked[edge.d]) != 0) flips.push_back({edge, 0});
  }
  tbb::parallel_for(tbb::blocked_range<size_t>(0, flips.size(), kGrain), [&](const tbb::blocked_range<size_t>& range) {
    for (size_t i = range.begin(); i != range.end(); ++i) flips[i].gain = meter.Gain(flips[i].edge);
  });
  flips.erase(std::remove_if(flips.begin(), flips.end(), [](const Flip& flip) { return !(flip.gain > 0); }), flips.end());
  std::stable_sort(flips.begin(), flips.end(), [](const Flip& x, const Flip& y) { return x.gain > y.gain; });
  return flips;
}

}  // namespace

size_t FlipEdges(const FitTarget& target, const RateModel& rate, TriangleMesh* mesh) {
  constexpr int kMostPasses = 3;
  size_t num_flipped = 0;
  std::vector<FaceDistance> distances = DistancesOfFaces(target, *mesh);
  std::vector<uint8_t> is_changed(mesh->positions.size(), 1);  // by the last pass: elsewhere nothing gained then, nor does it now
  for (int pass = 0; pass < kMostPasses; ++pass) {
    const size_t before = num_flipped;
    const std::vector<Flip> flips = FindFlips(target, rate, *mesh, distances, is_changed);
    std::fill(is_changed.begin(), is_changed.end(), uint8_t{0});
    std::vector<uint8_t> is_taken(mesh->triangles.size(), 0);
    std::set<std::pair<uint32_t, uint32_t>> made;  // edges
    for (const auto& [edge, gain] : flips) {
      const auto [first, second] = edge.faces;
      if (is_taken[first] != 0 || is_taken[second] != 0 || !made.emplace(std::minmax(edge.c, edge.d)).second) continue;
      is_taken[first] = is_taken[second] = 1;
      const std::array<Triangle, 2> flipped = edge.Flipped();
      mesh->triangles[first] = flipped[0];
      mesh->triangles[second] = flipped[1];
      for (const uint32_t f : edge.faces) distances[f] = DistanceOfFace(target, *mesh, f, distances[f].near);
      for (const uint32_t v : {edge.a, edge.b, edge.c, edge.d}) is_changed[v] = 1;
      ++num_flipped;
    }
    if (num_flipped == before) break;
  }
  return num_flipped;
}

}  // namespace lacerta
