#include "remesh/piercing.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/butterfly.h"
#include "common/local_frame.h"

namespace lacerta {
namespace {

// Where a fine vertex stands.
struct Site {
  Vec3f position;
  Vec3f normal;          // of the input, unit
  DomainPoint parameter;  // in the base domain
  PiercingKind kind = PiercingKind::kNormal;
  double parameter_distance = 0;  // from the middle of its edge, in lengths of the edge
};

// Whether there is nothing left to fall back to.
bool IsLastResort(const Site& site) {
  return site.kind == PiercingKind::kParametric || (site.kind == PiercingKind::kCurve && site.parameter_distance == 0);
}

// Squared length of a difference of barycentric coordinates in an equilateral triangle of edge length 1.
double SquaredChartLength(const ChartPoint& d) { return -(d.x * d.y + d.y * d.z + d.z * d.x); }

// Twice the signed area in units of the base face; positive for counterclockwise triangles.
double ChartArea(const ChartPoint& a, const ChartPoint& b, const ChartPoint& c) { return Dot(a, Cross(b, c)); }

// A coarse face with the midpoints of its sides: corners, then midpoints, as kChildren numbers them.
struct FaceSites {
  const Site* site[6];
  ChartPoint q[6];  // in the chart of the base face
  double area;      // of the face in the chart
};

// One refinement step.
class LevelPiercer {
 public:
  LevelPiercer(const InputSurface& surface, const BaseDomain& domain, const PiercingOptions& options, int level,
               const Topology& coarse, const std::vector<Site>& sites)
      : surface_(surface), domain_(domain), options_(options), level_(level), coarse_(coarse), sites_(sites) {}

  // Sites of the midpoints of all edges.
  std::vector<Site> Run(const StencilTable& stencils, const std::vector<Vec3f>& positions);

 private:
  uint32_t BaseFace(uint32_t face) const { return face >> (2 * level_); }
  struct Expectation;
  Site FindSite(uint32_t edge, PiercingKind first_kind) const;
  Site PiercedSite(uint32_t edge) const;
  Site ClosestSite(uint32_t edge, const Vec3f& position) const;
  Site ParametricSite(const Expectation& expected) const;
  Site SiteOf(const DomainPoint& parameter, PiercingKind kind) const;
  Site CurveSite(uint32_t edge, double share) const;
  Site FindCurveSite(uint32_t edge, PiercingKind first_kind) const;
  bool Confirms(uint32_t edge, const ChartPoint& middle, double edge_length, Site* site) const;
  Expectation Expect(uint32_t edge) const;
  Site SiteAt(const SurfacePoint& point, PiercingKind kind) const;
  bool IsSound(uint32_t edge, const Expectation& expected, Site* site) const;
  FaceSites SitesOf(uint32_t face, const std::vector<Site>& midpoints) const;
  bool FoldsInChart(const FaceSites& sites, const int (&child)[3]) const;
  bool Folds(const FaceSites& sites, const int (&child)[3]) const;
  bool FoldsAround(uint32_t edge, const std::vector<Site>& midpoints) const;
  std::vector<uint8_t> FoldedMidpoints(const std::vector<Site>& midpoints) const;
  Vec3f NeighborMean(uint32_t edge, const std::vector<Site>& midpoints) const;
  void Relax(std::vector<Site>* midpoints) const;
  double TurnedOverAround(uint32_t edge, const std::vector<Site>& midpoints) const;
  std::vector<uint32_t> TurnedOverMidpoints(const std::vector<Site>& midpoints) const;
  std::vector<Site> PlacesNear(uint32_t edge, const Site& site, double step) const;
  void TurnBack(std::vector<Site>* midpoints) const;

  const InputSurface& surface_;
  const BaseDomain& domain_;
  const PiercingOptions& options_;
  const int level_;
  const Topology& coarse_;
  const std::vector<Site>& sites_;   // of the coarse vertices
  std::vector<Vec3f> predicted_;
  std::vector<LocalFrame> frames_;
};

// Whether the parametrization agrees that a point found on the input belongs to the middle of `edge`: not too far from it, and
// in the chart of the base face where folds are checked; on a base edge in the two faces there. So all vertices of a level
// over one base face lie in its chart, and so does the middle of any two of them, since chart and face pair are convex.
bool LevelPiercer::Confirms(uint32_t edge, const ChartPoint& middle, double edge_length, Site* site) const {
  const uint32_t b0 = BaseFace(coarse_.edge_faces[edge][0]), b1 = BaseFace(coarse_.edge_faces[edge][1]);
  const std::optional<ChartPoint> q = domain_.ToChart(b0, site->parameter);
  if (!q || (b1 != b0 && site->parameter.face != b0 && site->parameter.face != b1)) return false;
  for (int k = 0; k < 3; ++k) {  // not across a curve
    if ((*q)[k] < 0 && domain_.topology().on_curve[domain_.topology().face_edges[b0][k]]) return false;
  }
  site->parameter_distance = std::sqrt(std::max(0.0, SquaredChartLength(*q - middle))) / edge_length;
  return site->parameter_distance <= options_.max_parameter_distance;
}

// The point of a curve at a share of an edge in the parametrization.
Site LevelPiercer::CurveSite(uint32_t edge, double share) const {
  const auto& [a, b] = coarse_.edges[edge];
  const uint32_t center = BaseFace(coarse_.edge_faces[edge][0]);
  const ChartPoint qa = *domain_.ToChart(center, sites_[a].parameter), qb = *domain_.ToChart(center, sites_[b].parameter);
  const DomainPoint parameter{center, ClampWeights(qa * (1 - share) + qb * share)};
  Site site = SiteOf(parameter, PiercingKind::kCurve);
  site.parameter_distance = std::fabs(share - 0.5);
  return site;
}

// On a curve: where the plane across the edge at the predicted midpoint meets the input's curve, so that nothing is left to
// code along the edge, else halfway in the parametrization.
Site LevelPiercer::FindCurveSite(uint32_t edge, PiercingKind first_kind) const {
  if (first_kind == PiercingKind::kNormal) {
    const Vec3f along = frames_[edge].tangent1;
    const auto beyond = [&](const Site& site) { return Dot(site.position - predicted_[edge], along) > 0; };
    constexpr double kFarthest = 0.35;  // from the middle, in lengths of the edge
    double low = 0.5 - kFarthest, high = 0.5 + kFarthest;
    if (!beyond(CurveSite(edge, low)) && beyond(CurveSite(edge, high))) {
      for (int i = 0; i < 24; ++i) {
        const double middle = 0.5 * (low + high);
        (beyond(CurveSite(edge, middle)) ? high : low) = middle;
      }
      return CurveSite(edge, low);
    }
  }
  return CurveSite(edge, 0.5);
}

// What an edge expects of a site for its midpoint.
struct LevelPiercer::Expectation {
  uint32_t center;       // base face in whose chart it is looked at
  ChartPoint middle;     // of the edge
  double chart_length;   // of the edge
  float reach;           // model units
};

LevelPiercer::Expectation LevelPiercer::Expect(uint32_t edge) const {
  const auto& [a, b] = coarse_.edges[edge];
  const uint32_t center = BaseFace(coarse_.edge_faces[edge][0]);
  const ChartPoint qa = *domain_.ToChart(center, sites_[a].parameter), qb = *domain_.ToChart(center, sites_[b].parameter);
  return {center, (qa + qb) * 0.5, std::sqrt(std::max(1e-30, SquaredChartLength(qb - qa))),
          static_cast<float>(options_.max_distance) * Norm(sites_[b].position - sites_[a].position)};
}

Site LevelPiercer::SiteAt(const SurfacePoint& point, PiercingKind kind) const {
  const Vec3d w{point.barycentric[0], point.barycentric[1], point.barycentric[2]};
  return {point.position, surface_.NormalAt(point.face, w), domain_.FromInput({point.face, w}), kind, 0};
}

bool LevelPiercer::IsSound(uint32_t edge, const Expectation& expected, Site* site) const {
  return Dot(site->normal, frames_[edge].normal) >= options_.min_normal_cosine &&
         Confirms(edge, expected.middle, expected.chart_length, site);
}

// The point of the input closest to `position`, else the one at the middle of the edge in the parametrization.
Site LevelPiercer::ClosestSite(uint32_t edge, const Vec3f& position) const {
  const Expectation expected = Expect(edge);
  const ClosestPointResult closest = surface_.tree().ClosestPoint(position, expected.reach * expected.reach);
  if (closest.point.face != kNone) {
    Site site = SiteAt(closest.point, PiercingKind::kClosest);
    if (IsSound(edge, expected, &site)) return site;
  }
  return ParametricSite(expected);
}

// The point of the input at a point of the domain.
Site LevelPiercer::SiteOf(const DomainPoint& parameter, PiercingKind kind) const {
  const DomainPoint on_input = domain_.ToInput(parameter);
  return {surface_.PositionAt(on_input.face, on_input.barycentric), surface_.NormalAt(on_input.face, on_input.barycentric),
          parameter, kind, 0};
}

Site LevelPiercer::ParametricSite(const Expectation& expected) const {
  return SiteOf(*domain_.FromChart(expected.center, expected.middle), PiercingKind::kParametric);
}

// The nearest sound hit of the normal line, else the closest point.
Site LevelPiercer::PiercedSite(uint32_t edge) const {
  const Expectation expected = Expect(edge);
  const Vec3f &origin = predicted_[edge], &normal = frames_[edge].normal;
  std::vector<LineHit> hits;
  surface_.tree().IntersectLine(origin, normal, -expected.reach, expected.reach, &hits);
  std::sort(hits.begin(), hits.end(), [](const LineHit& x, const LineHit& y) { return std::fabs(x.t) < std::fabs(y.t); });
  for (const LineHit& hit : hits) {
    Site site = SiteAt(hit.point, PiercingKind::kNormal);
    site.position = origin + normal * hit.t;
    if (IsSound(edge, expected, &site)) return site;
  }
  return ClosestSite(edge, origin);
}

Site LevelPiercer::FindSite(uint32_t edge, PiercingKind first_kind) const {
  if (coarse_.on_curve[edge]) return FindCurveSite(edge, first_kind);
  if (first_kind == PiercingKind::kNormal) return PiercedSite(edge);
  return first_kind == PiercingKind::kClosest ? ClosestSite(edge, predicted_[edge]) : ParametricSite(Expect(edge));
}

Vec3f LevelPiercer::NeighborMean(uint32_t edge, const std::vector<Site>& midpoints) const {
  Vec3f sum;
  int count = 0;
  for (const uint32_t v : coarse_.edges[edge]) {
    sum += sites_[v].position;
    ++count;
  }
  for (const uint32_t face : coarse_.edge_faces[edge]) {
    if (face == kNone) continue;
    for (const uint32_t side : coarse_.face_edges[face]) {
      if (side == edge) continue;
      sum += midpoints[side].position;
      ++count;
    }
  }
  return sum * (1.0f / static_cast<float>(count));
}

// The four children of a coarse face: corners, then midpoints (0, 1, 2: corners; 3 + k: midpoint of the edge opposite to k).
constexpr int kChildren[4][3] = {{0, 5, 4}, {1, 3, 5}, {2, 4, 3}, {3, 4, 5}};

FaceSites LevelPiercer::SitesOf(uint32_t face, const std::vector<Site>& midpoints) const {
  FaceSites s;
  for (int k = 0; k < 3; ++k) {
    s.site[k] = &sites_[coarse_.triangles[face][k]];
    s.site[3 + k] = &midpoints[coarse_.face_edges[face][k]];
  }
  for (int k = 0; k < 6; ++k) s.q[k] = *domain_.ToChart(BaseFace(face), s.site[k]->parameter);
  s.area = ChartArea(s.q[0], s.q[1], s.q[2]);
  return s;
}

bool LevelPiercer::FoldsInChart(const FaceSites& s, const int (&child)[3]) const {
  return ChartArea(s.q[child[0]], s.q[child[1]], s.q[child[2]]) < options_.min_child_area * s.area;
}

// Twice the area of a fine triangle seen along the normals of the input at its corners; below zero where it is turned over.
float FacingArea(const FaceSites& s, const int (&child)[3]) {
  const Site &a = *s.site[child[0]], &b = *s.site[child[1]], &c = *s.site[child[2]];
  return Dot(Cross(b.position - a.position, c.position - a.position), Normalized(a.normal + b.normal + c.normal));
}

bool LevelPiercer::Folds(const FaceSites& s, const int (&child)[3]) const {
  return FoldsInChart(s, child) || FacingArea(s, child) <= 0;
}

bool LevelPiercer::FoldsAround(uint32_t edge, const std::vector<Site>& midpoints) const {
  for (const uint32_t face : coarse_.edge_faces[edge]) {
    if (face == kNone) continue;
    const int midpoint = 3 + EdgeCorner(coarse_, face, edge);
    const FaceSites sites = SitesOf(face, midpoints);
    for (const auto& child : kChildren) {
      if (std::find(child, child + 3, midpoint) != child + 3 && Folds(sites, child)) return true;
    }
  }
  return false;
}

// Marks midpoints that must fall back: in each fine triangle that folds, the one that strays farthest in the parametrization.
std::vector<uint8_t> LevelPiercer::FoldedMidpoints(const std::vector<Site>& midpoints) const {
  std::vector<uint8_t> folded_corners(coarse_.num_faces(), 0);  // bit k: the midpoint opposite to corner k
  tbb::parallel_for(uint32_t{0}, coarse_.num_faces(), [&](uint32_t f) {
    const FaceSites s = SitesOf(f, midpoints);
    for (const auto& child : kChildren) {
      if (!Folds(s, child)) continue;
      int worst = -1;
      for (const int corner : child) {
        if (corner < 3 || IsLastResort(*s.site[corner])) continue;
        if (worst < 0 || s.site[corner]->parameter_distance > s.site[worst]->parameter_distance) worst = corner;
      }
      if (worst >= 0) folded_corners[f] |= static_cast<uint8_t>(1 << (worst - 3));
    }
  });
  std::vector<uint8_t> marked(coarse_.num_edges(), 0);
  for (uint32_t f = 0; f < coarse_.num_faces(); ++f) {
    for (int k = 0; k < 3; ++k) {
      if ((folded_corners[f] >> k & 1) != 0) marked[coarse_.face_edges[f][k]] = 1;
    }
  }
  return marked;
}

// Midpoints that are not on their normal line stand where their fallback put them, however uneven. Each moves to the point of the
// input closest to the mean of its neighbors, and back to its normal line where that has become sound.
void LevelPiercer::Relax(std::vector<Site>* midpoints) const {
  std::vector<uint32_t> loose;
  for (uint32_t e = 0; e < coarse_.num_edges(); ++e) {
    const PiercingKind kind = (*midpoints)[e].kind;
    if (kind == PiercingKind::kClosest || kind == PiercingKind::kParametric) loose.push_back(e);
  }
  for (int round = 0; round < options_.relaxation_rounds; ++round) {
    for (const uint32_t e : loose) {
      Site& site = (*midpoints)[e];
      if (site.kind == PiercingKind::kNormal) continue;
      const Site before = site;
      site = FindSite(e, PiercingKind::kNormal);
      if (site.kind == PiercingKind::kNormal && !FoldsAround(e, *midpoints)) continue;
      site = ClosestSite(e, NeighborMean(e, *midpoints));
      if (site.kind != PiercingKind::kClosest || FoldsAround(e, *midpoints)) site = before;
    }
  }
}

// How much area is turned over among the fine triangles at a midpoint; infinite where one folds in the parametrization.
double LevelPiercer::TurnedOverAround(uint32_t edge, const std::vector<Site>& midpoints) const {
  double area = 0;
  for (const uint32_t face : coarse_.edge_faces[edge]) {
    if (face == kNone) continue;
    const int midpoint = 3 + EdgeCorner(coarse_, face, edge);
    const FaceSites sites = SitesOf(face, midpoints);
    for (const auto& child : kChildren) {
      if (std::find(child, child + 3, midpoint) == child + 3) continue;
      if (FoldsInChart(sites, child)) return std::numeric_limits<double>::infinity();
      area += std::max(0.0, -double{FacingArea(sites, child)});
    }
  }
  return area;
}

std::vector<uint32_t> LevelPiercer::TurnedOverMidpoints(const std::vector<Site>& midpoints) const {
  std::vector<uint32_t> turned;
  for (uint32_t f = 0; f < coarse_.num_faces(); ++f) {
    const FaceSites sites = SitesOf(f, midpoints);
    for (const auto& child : kChildren) {
      if (FacingArea(sites, child) >= 0) continue;
      for (const int corner : child) {
        if (corner >= 3) turned.push_back(coarse_.face_edges[f][corner - 3]);
      }
    }
  }
  std::sort(turned.begin(), turned.end());
  turned.erase(std::unique(turned.begin(), turned.end()), turned.end());
  return turned;
}

// Where a midpoint may move to: a step along the edge or across it in the parametrization; on a curve along it only.
std::vector<Site> LevelPiercer::PlacesNear(uint32_t edge, const Site& site, double step) const {
  std::vector<Site> places;
  if (coarse_.on_curve[edge]) {
    for (const double share : {0.5 - step, 0.5 - step / 2, 0.5, 0.5 + step / 2, 0.5 + step}) places.push_back(CurveSite(edge, share));
    return places;
  }
  const Expectation expected = Expect(edge);
  const uint32_t face = coarse_.edge_faces[edge][0];
  const std::optional<ChartPoint> at = domain_.ToChart(expected.center, site.parameter);
  const ChartPoint along = *domain_.ToChart(expected.center, sites_[coarse_.edges[edge][1]].parameter) - expected.middle;
  const ChartPoint across =
      *domain_.ToChart(expected.center, sites_[OppositeVertex(coarse_, face, edge)].parameter) - expected.middle;
  for (int i = -1; i <= 1; ++i) {
    for (int k = -1; k <= 1; ++k) {
      const std::optional<DomainPoint> p = domain_.FromChart(expected.center, *at + along * (2 * i * step) + across * (k * step));
      if (!p || (i == 0 && k == 0)) continue;
      Site place = SiteOf(*p, PiercingKind::kParametric);
      if (Confirms(edge, expected.middle, expected.chart_length, &place)) places.push_back(place);
    }
  }
  return places;
}

// Where even the last resort has left triangles turned over, the surface winds between the parametric points. Their midpoints
// move about, one after the other, as long as that turns some area back.
void LevelPiercer::TurnBack(std::vector<Site>* midpoints) const {
  double step = 0.2;
  for (int round = 0; round < options_.turning_rounds; ++round, step *= 0.75) {
    const std::vector<uint32_t> turned = TurnedOverMidpoints(*midpoints);
    if (turned.empty()) return;
    for (const uint32_t e : turned) {
      Site& site = (*midpoints)[e];
      Site best = site;
      double least = TurnedOverAround(e, *midpoints);
      for (const Site& place : PlacesNear(e, best, step)) {
        site = place;
        const double area = TurnedOverAround(e, *midpoints);
        if (area < least) {
          least = area;
          best = place;
        }
      }
      site = best;
    }
  }
}

std::vector<Site> LevelPiercer::Run(const StencilTable& stencils, const std::vector<Vec3f>& positions) {
  predicted_ = PredictMidpoints(coarse_, stencils, positions);
  frames_ = ComputeLocalFrames(coarse_, positions, predicted_);
  std::vector<Site> midpoints(coarse_.num_edges());
  tbb::parallel_for(uint32_t{0}, coarse_.num_edges(),
                    [&](uint32_t e) { midpoints[e] = FindSite(e, PiercingKind::kNormal); });
  // Each round moves at least one midpoint one kind further, so this ends; a few rounds settle it in practice.
  for (;;) {
    const std::vector<uint8_t> folded = FoldedMidpoints(midpoints);
    if (std::find(folded.begin(), folded.end(), 1) == folded.end()) break;
    tbb::parallel_for(uint32_t{0}, coarse_.num_edges(), [&](uint32_t e) {
      if (!folded[e]) return;
      const bool was_normal = midpoints[e].kind == PiercingKind::kNormal;
      midpoints[e] = FindSite(e, was_normal ? PiercingKind::kClosest : PiercingKind::kParametric);
    });
  }
  Relax(&midpoints);
  TurnBack(&midpoints);
  return midpoints;
}

}  // namespace

NormalMesh Pierce(const InputSurface& surface, const BaseDomain& domain, const std::vector<Vec3f>& base_positions,
                  const PiercingOptions& options) {
  NormalMesh result;
  result.mesh.base_triangles = domain.triangles();
  result.mesh.num_base_vertices = domain.num_vertices();
  result.mesh.num_levels = options.num_levels;
  result.mesh.tags = domain.tags();
  std::vector<Vec3f>& positions = result.mesh.positions;
  positions = base_positions;

  std::vector<Site> sites(domain.num_vertices());
  for (uint32_t f = 0; f < domain.triangles().size(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const uint32_t v = domain.triangles()[f][k];
      DomainPoint corner{f, {}};
      corner.barycentric[k] = 1;
      sites[v] = {base_positions[v], surface.vertex_normal(domain.input_vertex(v)), corner, PiercingKind::kNormal, 0};
    }
  }
  Topology topology = domain.topology();
  const StencilTable stencils(topology);
  for (int level = 0; level < options.num_levels; ++level) {
    const std::vector<Site> midpoints =
        LevelPiercer(surface, domain, options, level, topology, sites).Run(stencils, positions);
    sites.insert(sites.end(), midpoints.begin(), midpoints.end());
    for (const Site& site : midpoints) {
      positions.push_back(site.position);
      result.piercing.push_back(site.kind);
    }
    if (level + 1 < options.num_levels) topology = Refine(topology);
  }
  for (const Site& site : sites) result.surface_normals.push_back(site.normal);
  return result;
}

double NormalShare(const NormalMesh& mesh) {
  const auto count = [&](PiercingKind kind) {
    return static_cast<double>(std::count(mesh.piercing.begin(), mesh.piercing.end(), kind));
  };
  const double off_curves = static_cast<double>(mesh.piercing.size()) - count(PiercingKind::kCurve);
  return off_curves > 0 ? count(PiercingKind::kNormal) / off_curves : 1.0;
}

}  // namespace lacerta
