// Midpoints that piercing left in bad places: loose ones are relaxed, reversed triangles turned back.
#include <tbb/parallel_for.h>

#include <algorithm>
#include <limits>
#include <optional>

#include "remesh/level_piercer.h"

namespace lacerta {

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

// Midpoints that are not on their normal line stand where their fallback put them, however uneven. Each moves to the point of the
// input closest to the mean of its neighbors, and back to its normal line where that has become sound.
void LevelPiercer::Relax(std::vector<Site>* midpoints) const {
  std::vector<uint32_t> loose;
  for (uint32_t e = 0; e < coarse_.num_edges(); ++e) {
    const PiercingKind kind = (*midpoints)[e].kind;
    if (kind == PiercingKind::kClosest || kind == PiercingKind::kParametric) loose.push_back(e);
  }
  std::vector<Site> pierced(loose.size());  // whatever the neighbors do
  tbb::parallel_for(size_t{0}, loose.size(), [&](size_t i) { pierced[i] = FindSite(loose[i], PiercingKind::kNormal); });
  for (int round = 0; round < options_.relaxation_rounds; ++round) {
    for (size_t i = 0; i < loose.size(); ++i) {
      const uint32_t e = loose[i];
      Site& site = (*midpoints)[e];
      if (site.kind == PiercingKind::kNormal) continue;
      const Site before = site;
      site = pierced[i];
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
    const ChartedFaceSites sites = ChartedSitesOf(face, midpoints);
    for (const auto& child : kChildren) {
      if (std::find(child, child + 3, midpoint) == child + 3) continue;
      if (FoldsInChart(sites, child)) return std::numeric_limits<double>::infinity();
      area += std::max(0.0, -double{FacingArea(sites, child)});
    }
  }
  return area;
}

// Those of fine triangles that are turned over, in faces with a side whose midpoint has moved.
std::vector<uint32_t> LevelPiercer::TurnedOverMidpoints(const std::vector<Site>& midpoints, const std::vector<uint8_t>& moved) const {
  std::vector<uint8_t> turned_corners(coarse_.num_faces(), 0);  // bit k: the midpoint opposite to corner k
  tbb::parallel_for(uint32_t{0}, coarse_.num_faces(), [&](uint32_t f) {
    const auto& sides = coarse_.face_edges[f];
    if (!moved[sides[0]] && !moved[sides[1]] && !moved[sides[2]]) return;
    const FaceSites sites = SitesOf(f, midpoints);
    for (const auto& child : kChildren) {
      if (FacingArea(sites, child) >= 0) continue;
      for (const int corner : child) turned_corners[f] |= static_cast<uint8_t>((1 << corner) >> 3);
    }
  });
  std::vector<uint32_t> turned;
  for (uint32_t f = 0; f < coarse_.num_faces(); ++f) {
    for (int k = 0; k < 3; ++k) {
      if ((turned_corners[f] >> k & 1) != 0) turned.push_back(coarse_.face_edges[f][k]);
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
  std::vector<uint8_t> moved(coarse_.num_edges(), 1);
  for (int round = 0; round < options_.turning_rounds; ++round, step *= 0.75) {
    const std::vector<uint32_t> turned = TurnedOverMidpoints(*midpoints, moved);
    if (turned.empty()) return;
    std::vector<std::vector<Site>> places(turned.size());  // whatever the neighbors do
    tbb::parallel_for(size_t{0}, turned.size(), [&](size_t i) { places[i] = PlacesNear(turned[i], (*midpoints)[turned[i]], step); });
    moved.assign(coarse_.num_edges(), 0);
    for (size_t i = 0; i < turned.size(); ++i) {
      const uint32_t e = turned[i];
      moved[e] = 1;
      Site& site = (*midpoints)[e];
      Site best = site;
      double least = TurnedOverAround(e, *midpoints);
      for (const Site& place : places[i]) {
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

}  // namespace lacerta
