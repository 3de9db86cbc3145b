#include "remesh/level_piercer.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace lacerta {

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

Expectation LevelPiercer::Expect(uint32_t edge) const {
  const auto& [a, b] = coarse_.edges[edge];
  const uint32_t center = BaseFace(coarse_.edge_faces[edge][0]);
  const ChartPoint qa = *domain_.ToChart(center, sites_[a].parameter), qb = *domain_.ToChart(center, sites_[b].parameter);
  return {center, (qa + qb) * 0.5, std::sqrt(std::max(1e-30, SquaredChartLength(qb - qa))),
          static_cast<float>(options_.max_distance) * Norm(sites_[b].position - sites_[a].position)};
}

// parameter: of the point, in the base domain.
Site LevelPiercer::SiteAt(const SurfacePoint& point, PiercingKind kind, const DomainPoint& parameter) const {
  return {point.position, surface_.NormalAt(point.face, InputPoint(point).barycentric), parameter, kind, 0};
}

Site LevelPiercer::SiteOn(const LineHit& hit, uint32_t edge, const DomainPoint& parameter) const {
  Site site = SiteAt(hit.point, PiercingKind::kNormal, parameter);
  site.position = predicted_[edge] + frames_[edge].normal * hit.t;
  return site;
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
    Site site = SiteAt(closest.point, PiercingKind::kClosest, domain_.FromInput(InputPoint(closest.point)));
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

// Of the normal line, the nearest first.
std::vector<LineHit> LevelPiercer::HitsOf(uint32_t edge, float reach) const {
  std::vector<LineHit> hits;
  surface_.tree().IntersectLine(predicted_[edge], frames_[edge].normal, -reach, reach, &hits);
  std::sort(hits.begin(), hits.end(), [](const LineHit& x, const LineHit& y) { return std::fabs(x.t) < std::fabs(y.t); });
  return hits;
}

// The nearest sound hit of the normal line, else the closest point.
Site LevelPiercer::PiercedSite(uint32_t edge) const {
  const Expectation expected = Expect(edge);
  for (const LineHit& hit : HitsOf(edge, expected.reach)) {
    Site site = SiteOn(hit, edge, domain_.FromInput(InputPoint(hit.point)));
    if (IsSound(edge, expected, &site)) return site;
  }
  return ClosestSite(edge, predicted_[edge]);
}

// FindSite of a range of edges. The nearest hit mostly is sound, and the points of the domain of many are found faster than of one.
void LevelPiercer::PierceRange(uint32_t first_edge, uint32_t end_edge, std::vector<Site>* midpoints) const {
  struct Nearest {
    uint32_t edge;
    Expectation expected;
    LineHit hit;
  };
  std::vector<Nearest> nearest;
  std::vector<DomainPoint> parameters;
  for (uint32_t e = first_edge; e < end_edge; ++e) {
    if (coarse_.on_curve[e]) {
      (*midpoints)[e] = FindCurveSite(e, PiercingKind::kNormal);
      continue;
    }
    const Expectation expected = Expect(e);
    const std::vector<LineHit> hits = HitsOf(e, expected.reach);
    if (hits.empty()) {
      (*midpoints)[e] = ClosestSite(e, predicted_[e]);
      continue;
    }
    nearest.push_back({e, expected, hits.front()});
    parameters.push_back(InputPoint(hits.front().point));
  }
  domain_.FromInput(&parameters);
  for (size_t i = 0; i < nearest.size(); ++i) {
    const uint32_t e = nearest[i].edge;
    Site site = SiteOn(nearest[i].hit, e, parameters[i]);
    (*midpoints)[e] = IsSound(e, nearest[i].expected, &site) ? site : PiercedSite(e);
  }
}

Site LevelPiercer::FindSite(uint32_t edge, PiercingKind first_kind) const {
  if (coarse_.on_curve[edge]) return FindCurveSite(edge, first_kind);
  if (first_kind == PiercingKind::kNormal) return PiercedSite(edge);
  return first_kind == PiercingKind::kClosest ? ClosestSite(edge, predicted_[edge]) : ParametricSite(Expect(edge));
}

FaceSites LevelPiercer::SitesOf(uint32_t face, const std::vector<Site>& midpoints) const {
  FaceSites s;
  for (int k = 0; k < 3; ++k) {
    s.site[k] = &sites_[coarse_.triangles[face][k]];
    s.site[3 + k] = &midpoints[coarse_.face_edges[face][k]];
  }
  return s;
}

ChartedFaceSites LevelPiercer::ChartedSitesOf(uint32_t face, const std::vector<Site>& midpoints) const {
  ChartedFaceSites s{SitesOf(face, midpoints), {}, 0};
  for (int k = 0; k < 6; ++k) s.q[k] = *domain_.ToChart(BaseFace(face), s.site[k]->parameter);
  s.area = ChartArea(s.q[0], s.q[1], s.q[2]);
  return s;
}

bool LevelPiercer::FoldsInChart(const ChartedFaceSites& s, const int (&child)[3]) const {
  return ChartArea(s.q[child[0]], s.q[child[1]], s.q[child[2]]) < options_.min_child_area * s.area;
}

bool LevelPiercer::Folds(const ChartedFaceSites& s, const int (&child)[3]) const {
  return FoldsInChart(s, child) || FacingArea(s, child) <= 0;
}

bool LevelPiercer::FoldsAround(uint32_t edge, const std::vector<Site>& midpoints) const {
  for (const uint32_t face : coarse_.edge_faces[edge]) {
    if (face == kNone) continue;
    const int midpoint = 3 + EdgeCorner(coarse_, face, edge);
    const ChartedFaceSites sites = ChartedSitesOf(face, midpoints);
    for (const auto& child : kChildren) {
      if (std::find(child, child + 3, midpoint) != child + 3 && Folds(sites, child)) return true;
    }
  }
  return false;
}

// Marks midpoints that must fall back: in each fine triangle that folds, the one that strays farthest in the parametrization. Only
// faces with a side whose midpoint has moved are looked at.
std::vector<uint8_t> LevelPiercer::FoldedMidpoints(const std::vector<Site>& midpoints, const std::vector<uint8_t>& moved) const {
  std::vector<uint8_t> folded_corners(coarse_.num_faces(), 0);  // bit k: the midpoint opposite to corner k
  tbb::parallel_for(uint32_t{0}, coarse_.num_faces(), [&](uint32_t f) {
    const auto& sides = coarse_.face_edges[f];
    if (!moved[sides[0]] && !moved[sides[1]] && !moved[sides[2]]) return;
    const ChartedFaceSites s = ChartedSitesOf(f, midpoints);
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

std::vector<Site> LevelPiercer::Run(const StencilTable& stencils, const std::vector<Vec3f>& positions) {
  predicted_ = PredictMidpoints(coarse_, stencils, positions);
  const std::vector<Vec3f> normals = FrameNormals(coarse_, positions, predicted_);
  frames_.resize(coarse_.num_edges());
  for (uint32_t e = 0; e < coarse_.num_edges(); ++e) {
    if (coarse_.on_curve[e]) {
      frames_[e] = FrameWithNormal(coarse_, positions, e, normals[e]);
    } else {
      frames_[e].normal = normals[e];
    }
  }
  std::vector<Site> midpoints(coarse_.num_edges());
  constexpr uint32_t kRange = 64;  // edges
  tbb::parallel_for(uint32_t{0}, (coarse_.num_edges() + kRange - 1) / kRange,
                    [&](uint32_t i) { PierceRange(i * kRange, std::min((i + 1) * kRange, coarse_.num_edges()), &midpoints); });
  // Each round moves at least one midpoint one kind further, so this ends; a few rounds settle it in practice.
  std::vector<uint8_t> folded(coarse_.num_edges(), 1);
  for (;;) {
    folded = FoldedMidpoints(midpoints, folded);
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

}  // namespace lacerta
