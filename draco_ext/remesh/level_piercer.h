// One level of piercing: the sites of the midpoints of all edges (remesh/piercing.h).
#ifndef LACERTA_REMESH_LEVEL_PIERCER_H_
#define LACERTA_REMESH_LEVEL_PIERCER_H_

#include <cstdint>
#include <vector>

#include "common/butterfly.h"
#include "common/local_frame.h"
#include "common/subdivision.h"
#include "lacerta/remesh.h"
#include "remesh/base_domain.h"
#include "remesh/input_surface.h"
#include "remesh/piercing.h"

namespace lacerta {

// Where a fine vertex stands.
struct Site {
  Vec3f position;
  Vec3f normal;          // of the input, unit
  DomainPoint parameter;  // in the base domain
  PiercingKind kind = PiercingKind::kNormal;
  double parameter_distance = 0;  // from the middle of its edge, in lengths of the edge
};

// Whether there is nothing left to fall back to.
inline bool IsLastResort(const Site& site) {
  return site.kind == PiercingKind::kParametric || (site.kind == PiercingKind::kCurve && site.parameter_distance == 0);
}

// Squared length of a difference of barycentric coordinates in an equilateral triangle of edge length 1.
inline double SquaredChartLength(const ChartPoint& d) { return -(d.x * d.y + d.y * d.z + d.z * d.x); }

// Twice the signed area in units of the base face; positive for counterclockwise triangles.
inline double ChartArea(const ChartPoint& a, const ChartPoint& b, const ChartPoint& c) { return Dot(a, Cross(b, c)); }

// A coarse face with the midpoints of its sides: corners, then midpoints, as kChildren numbers them.
struct FaceSites {
  const Site* site[6];
};

// The same in the chart of the base face.
struct ChartedFaceSites : FaceSites {
  ChartPoint q[6];
  double area;      // of the face in the chart
};

// The four children of a coarse face: corners, then midpoints (0, 1, 2: corners; 3 + k: midpoint of the edge opposite to k).
inline constexpr int kChildren[4][3] = {{0, 5, 4}, {1, 3, 5}, {2, 4, 3}, {3, 4, 5}};

// Twice the area of a fine triangle seen along the normals of the input at its corners; below zero where it is turned over.
inline float FacingArea(const FaceSites& s, const int (&child)[3]) {
  const Site &a = *s.site[child[0]], &b = *s.site[child[1]], &c = *s.site[child[2]];
  return Dot(Cross(b.position - a.position, c.position - a.position), Normalized(a.normal + b.normal + c.normal));
}

// What an edge expects of a site for its midpoint.
struct Expectation {
  uint32_t center;       // base face in whose chart it is looked at
  ChartPoint middle;     // of the edge
  double chart_length;   // of the edge
  float reach;           // model units
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
  Site FindSite(uint32_t edge, PiercingKind first_kind) const;
  std::vector<LineHit> HitsOf(uint32_t edge, float reach) const;
  Site PiercedSite(uint32_t edge) const;
  void PierceRange(uint32_t first_edge, uint32_t end_edge, std::vector<Site>* midpoints) const;
  Site ClosestSite(uint32_t edge, const Vec3f& position) const;
  Site ParametricSite(const Expectation& expected) const;
  Site SiteOf(const DomainPoint& parameter, PiercingKind kind) const;
  Site CurveSite(uint32_t edge, double share) const;
  Site FindCurveSite(uint32_t edge, PiercingKind first_kind) const;
  bool Confirms(uint32_t edge, const ChartPoint& middle, double edge_length, Site* site) const;
  Expectation Expect(uint32_t edge) const;
  Site SiteAt(const SurfacePoint& point, PiercingKind kind, const DomainPoint& parameter) const;
  Site SiteOn(const LineHit& hit, uint32_t edge, const DomainPoint& parameter) const;
  bool IsSound(uint32_t edge, const Expectation& expected, Site* site) const;
  FaceSites SitesOf(uint32_t face, const std::vector<Site>& midpoints) const;
  ChartedFaceSites ChartedSitesOf(uint32_t face, const std::vector<Site>& midpoints) const;
  bool FoldsInChart(const ChartedFaceSites& sites, const int (&child)[3]) const;
  bool Folds(const ChartedFaceSites& sites, const int (&child)[3]) const;
  bool FoldsAround(uint32_t edge, const std::vector<Site>& midpoints) const;
  std::vector<uint8_t> FoldedMidpoints(const std::vector<Site>& midpoints, const std::vector<uint8_t>& moved) const;
  Vec3f NeighborMean(uint32_t edge, const std::vector<Site>& midpoints) const;
  void Relax(std::vector<Site>* midpoints) const;
  double TurnedOverAround(uint32_t edge, const std::vector<Site>& midpoints) const;
  std::vector<uint32_t> TurnedOverMidpoints(const std::vector<Site>& midpoints, const std::vector<uint8_t>& moved) const;
  std::vector<Site> PlacesNear(uint32_t edge, const Site& site, double step) const;
  void TurnBack(std::vector<Site>* midpoints) const;

  const InputSurface& surface_;
  const BaseDomain& domain_;
  const PiercingOptions& options_;
  const int level_;
  const Topology& coarse_;
  const std::vector<Site>& sites_;   // of the coarse vertices
  std::vector<Vec3f> predicted_;
  std::vector<LocalFrame> frames_;  // with tangents on curves alone
};

}  // namespace lacerta

#endif  // LACERTA_REMESH_LEVEL_PIERCER_H_
