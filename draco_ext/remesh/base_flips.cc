#include "remesh/base_flips.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <optional>

#include "common/subdivision.h"
#include "remesh/base_midpoints.h"
#include "remesh/edge_quad.h"

namespace lacerta {
namespace {

// Faces of the base as a mesh of their own.
struct Patch {
  std::vector<uint32_t> vertices;  // of the base
  std::vector<Triangle> triangles;
  std::vector<char> counts;  // of each triangle: whether what lies over it does
};

class FlipSearch {
 public:
  FlipSearch(const InputSurface& surface, const BaseDomain& domain, const std::vector<Vec3f>& positions);

  // Edges to turn, no two of which change what is predicted over the same faces.
  std::vector<uint32_t> Run() const;

 private:
  struct Trial {
    double gain = 0.0;
    std::vector<uint32_t> region;  // faces over which predictions change
  };

  bool MayTurn(const EdgeQuad& quad) const;
  Trial Try(const EdgeQuad& quad) const;
  std::vector<uint32_t> FacesAround(const std::vector<uint32_t>& vertices) const;
  std::vector<uint32_t> VerticesOf(const std::vector<uint32_t>& faces) const;
  std::optional<double> Cost(const Patch& patch) const;

  const InputSurface& surface_;
  const Topology& topology_;
  std::vector<std::vector<uint32_t>> faces_of_;  // of each base vertex
  PointsOnInput points_;                         // of the base, and of the first level
  std::optional<CodingBits> bits_;
};

void SortUnique(std::vector<uint32_t>* numbers) {
  std::sort(numbers->begin(), numbers->end());
  numbers->erase(std::unique(numbers->begin(), numbers->end()), numbers->end());
}

// Of a number that is one of those, in ascending order.
uint32_t IndexOf(uint32_t number, const std::vector<uint32_t>& numbers) {
  return static_cast<uint32_t>(std::lower_bound(numbers.begin(), numbers.end(), number) - numbers.begin());
}

FlipSearch::FlipSearch(const InputSurface& surface, const BaseDomain& domain, const std::vector<Vec3f>& positions)
    : surface_(surface), topology_(domain.topology()), faces_of_(topology_.num_vertices) {
  for (uint32_t f = 0; f < topology_.num_faces(); ++f) {
    for (const uint32_t v : topology_.triangles[f]) faces_of_[v].push_back(f);
  }
  const MidpointsOver first_level(topology_, 0);
  points_ = BaseOnInput(surface, domain, positions, first_level.num_points());
  first_level.ForLevels([&](uint32_t point) { FindMidpoint(surface, first_level, point, &points_); });
  bits_.emplace(first_level, points_);
}

std::vector<uint32_t> FlipSearch::Run() const {
  if (bits_->is_nothing()) return {};
  std::vector<Trial> trials(topology_.num_edges());
  tbb::parallel_for(uint32_t{0}, topology_.num_edges(), [&](uint32_t e) {
    if (topology_.on_curve[e] != 0) return;
    if (const EdgeQuad quad(topology_, e); MayTurn(quad)) trials[e] = Try(quad);
  });
  std::vector<uint32_t> gaining;
  for (uint32_t e = 0; e < trials.size(); ++e) {
    if (trials[e].gain > 0.0) gaining.push_back(e);
  }
  std::stable_sort(gaining.begin(), gaining.end(), [&](uint32_t a, uint32_t b) { return trials[a].gain > trials[b].gain; });
  std::vector<char> is_taken(topology_.num_faces());
  std::vector<uint32_t> turned;
  for (const uint32_t e : gaining) {
    const std::vector<uint32_t>& region = trials[e].region;
    if (std::any_of(region.begin(), region.end(), [&](uint32_t f) { return is_taken[f] != 0; })) continue;
    for (const uint32_t f : region) is_taken[f] = 1;
    turned.push_back(e);
  }
  return turned;
}

// Whether turning the edge is worth a trial: hardly one that becomes much longer gains, and none may lie across a fold.
bool FlipSearch::MayTurn(const EdgeQuad& q) const {
  constexpr int kLeastValence = 3, kMostValence = 9;
  constexpr double kMostLength = 1.6;   // over what it was
  constexpr double kLeastCosine = 0.5;  // between a new triangle's normal and the input's at its corners
  const std::vector<uint16_t>& valence = topology_.valence;
  if (std::min(valence[q.a], valence[q.b]) <= kLeastValence || std::max(valence[q.c], valence[q.d]) >= kMostValence) return false;
  if (Norm(points_.at[q.c] - points_.at[q.d]) > kMostLength * Norm(points_.at[q.a] - points_.at[q.b])) return false;
  const auto lies_along = [&](const std::array<uint32_t, 3>& corners) {
    const auto& [u, v, w] = corners;
    const Vec3d normal = Normalized(Cross(points_.at[v] - points_.at[u], points_.at[w] - points_.at[u]));
    return std::all_of(corners.begin(), corners.end(), [&](uint32_t corner) { return Dot(normal, points_.normals[corner]) > kLeastCosine; });
  };
  return lies_along({q.c, q.a, q.d}) && lies_along({q.d, q.b, q.c});
}

FlipSearch::Trial FlipSearch::Try(const EdgeQuad& q) const {
  constexpr double kIrregular = 3.0;  // bits that a vertex is worth for each edge that it has more or less than six
  Trial trial;
  trial.region = FacesAround({q.a, q.b, q.c, q.d});
  const std::vector<uint32_t> faces = FacesAround(VerticesOf(trial.region));  // their rim is wrong in the same way before and after
  Patch patch{VerticesOf(faces), {}, {}};
  for (const uint32_t f : faces) {
    Triangle t = topology_.triangles[f];
    for (uint32_t& v : t) v = IndexOf(v, patch.vertices);
    patch.triangles.push_back(t);
    patch.counts.push_back(std::binary_search(trial.region.begin(), trial.region.end(), f));
  }
  const std::optional<double> before = Cost(patch);
  q.Turn(IndexOf(q.f, faces), IndexOf(q.g, faces), &patch.triangles);
  const std::optional<double> after = Cost(patch);
  if (!before || !after) return trial;
  trial.gain = *before - *after;
  const auto irregularity = [&](uint32_t v, int more) { return kIrregular * std::abs(topology_.valence[v] + more - 6); };
  for (const uint32_t v : {q.a, q.b}) trial.gain += irregularity(v, 0) - irregularity(v, -1);
  for (const uint32_t v : {q.c, q.d}) trial.gain += irregularity(v, 0) - irregularity(v, 1);
  return trial;
}

std::vector<uint32_t> FlipSearch::FacesAround(const std::vector<uint32_t>& vertices) const {
  std::vector<uint32_t> faces;
  for (const uint32_t v : vertices) faces.insert(faces.end(), faces_of_[v].begin(), faces_of_[v].end());
  SortUnique(&faces);
  return faces;
}

std::vector<uint32_t> FlipSearch::VerticesOf(const std::vector<uint32_t>& faces) const {
  std::vector<uint32_t> vertices;
  for (const uint32_t f : faces) vertices.insert(vertices.end(), topology_.triangles[f].begin(), topology_.triangles[f].end());
  SortUnique(&vertices);
  return vertices;
}

// Of the midpoints that count, on the first level. None where the patch is no manifold, or one of them is on another sheet of the input: what there is to gain does not show.
std::optional<double> FlipSearch::Cost(const Patch& patch) const {
  const StatusOr<Topology> topology = BuildTopology(static_cast<uint32_t>(patch.vertices.size()), patch.triangles);
  if (!topology.ok()) return std::nullopt;
  const MidpointsOver midpoints(topology.value(), 0);
  PointsOnInput points;
  points.Resize(midpoints.num_points());
  for (size_t i = 0; i < patch.vertices.size(); ++i) {
    points.at[i] = points_.at[patch.vertices[i]];
    points.normals[i] = points_.normals[patch.vertices[i]];
    points.faces[i] = points_.faces[patch.vertices[i]];
  }
  double cost = 0.0;
  for (uint32_t point = midpoints.num_base(); point < midpoints.num_points(); ++point) {
    const MidpointsOver::Midpoint& midpoint = midpoints.midpoint(point);
    if (std::none_of(midpoint.faces.begin(), midpoint.faces.end(), [&](uint32_t f) { return f != kNone && patch.counts[f] != 0; })) continue;
    if (!FindMidpoint(surface_, midpoints, point, &points)) return std::nullopt;
    cost += midpoint.weight * bits_->Of(points.distances[point] * points.distances[point]);
  }
  for (const Flap& flap : FlapsOf(topology.value())) cost += bits_->OfFlap(flap, points.at);
  return cost;
}

}  // namespace

size_t FlipBaseEdges(const InputSurface& surface, BaseDomain* domain, const std::vector<Vec3f>& positions) {
  return domain->Flip(FlipSearch(surface, *domain, positions).Run(), positions);
}

}  // namespace lacerta
