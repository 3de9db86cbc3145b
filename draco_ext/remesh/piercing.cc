#include "remesh/piercing.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

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

// Squared length of a difference of barycentric coordinates in an equilateral triangle of edge length 1.
double SquaredChartLength(const ChartPoint& d) { return -(d.x * d.y + d.y * d.z + d.z * d.x); }

// Twice the signed area in units of the base face; positive for counterclockwise triangles.
double ChartArea(const ChartPoint& a, const ChartPoint& b, const ChartPoint& c) { return Dot(a, Cross(b, c)); }

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
  bool Confirms(uint32_t edge, const ChartPoint& middle, double edge_length, Site* site) const;
  std::vector<uint8_t> FoldedMidpoints(const std::vector<Site>& midpoints) const;

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
  site->parameter_distance = std::sqrt(std::max(0.0, SquaredChartLength(*q - middle))) / edge_length;
  return site->parameter_distance <= options_.max_parameter_distance;
}

Site LevelPiercer::FindSite(uint32_t edge, PiercingKind first_kind) const {
  const auto& [a, b] = coarse_.edges[edge];
  const uint32_t center = BaseFace(coarse_.edge_faces[edge][0]);
  const ChartPoint qa = *domain_.ToChart(center, sites_[a].parameter), qb = *domain_.ToChart(center, sites_[b].parameter);
  const ChartPoint middle = (qa + qb) * 0.5;
  const double chart_length = std::sqrt(std::max(1e-30, SquaredChartLength(qb - qa)));
  const Vec3f& origin = predicted_[edge];
  const Vec3f& normal = frames_[edge].normal;
  const float edge_length = Norm(sites_[b].position - sites_[a].position);
  const float reach = static_cast<float>(options_.max_distance) * edge_length;

  const auto site_at = [&](const SurfacePoint& point, PiercingKind kind) {
    const Vec3d w{point.barycentric[0], point.barycentric[1], point.barycentric[2]};
    return Site{point.position, surface_.NormalAt(point.face, w), domain_.FromInput({point.face, w}), kind, 0};
  };
  const auto faces_same_way = [&](const Site& site) { return Dot(site.normal, normal) >= options_.min_normal_cosine; };

  if (first_kind == PiercingKind::kNormal) {
    std::vector<LineHit> hits;
    surface_.tree().IntersectLine(origin, normal, -reach, reach, &hits);
    std::sort(hits.begin(), hits.end(), [](const LineHit& x, const LineHit& y) { return std::fabs(x.t) < std::fabs(y.t); });
    for (const LineHit& hit : hits) {
      Site site = site_at(hit.point, PiercingKind::kNormal);
      site.position = origin + normal * hit.t;
      if (faces_same_way(site) && Confirms(edge, middle, chart_length, &site)) return site;
    }
  }
  if (first_kind != PiercingKind::kParametric) {
    const ClosestPointResult closest = surface_.tree().ClosestPoint(origin, reach * reach);
    if (closest.point.face != kNone) {
      Site site = site_at(closest.point, PiercingKind::kClosest);
      if (faces_same_way(site) && Confirms(edge, middle, chart_length, &site)) return site;
    }
  }
  const std::optional<DomainPoint> parameter = domain_.FromChart(center, middle);
  const DomainPoint on_input = domain_.ToInput(*parameter);
  return {surface_.PositionAt(on_input.face, on_input.barycentric), surface_.NormalAt(on_input.face, on_input.barycentric),
          *parameter, PiercingKind::kParametric, 0};
}

// Marks midpoints that must fall back: in each fine triangle that folds, the one that strays farthest in the parametrization.
std::vector<uint8_t> LevelPiercer::FoldedMidpoints(const std::vector<Site>& midpoints) const {
  std::vector<uint8_t> marked(coarse_.num_edges(), 0);
  for (uint32_t f = 0; f < coarse_.num_faces(); ++f) {
    const Triangle& t = coarse_.triangles[f];
    const auto& fe = coarse_.face_edges[f];
    const uint32_t center = BaseFace(f);
    const Site* site[6];  // corners, then midpoints
    ChartPoint q[6];
    for (int k = 0; k < 3; ++k) {
      site[k] = &sites_[t[k]];
      site[3 + k] = &midpoints[fe[k]];
    }
    for (int k = 0; k < 6; ++k) q[k] = *domain_.ToChart(center, site[k]->parameter);
    const double parent_area = ChartArea(q[0], q[1], q[2]);
    static constexpr int kChildren[4][3] = {{0, 5, 4}, {1, 3, 5}, {2, 4, 3}, {3, 4, 5}};
    for (const auto& child : kChildren) {
      const Site &a = *site[child[0]], &b = *site[child[1]], &c = *site[child[2]];
      const bool folds_in_chart =
          ChartArea(q[child[0]], q[child[1]], q[child[2]]) < options_.min_child_area * parent_area;
      const Vec3f area = Cross(b.position - a.position, c.position - a.position);
      const bool turned_over = Dot(area, a.normal + b.normal + c.normal) <= 0;
      if (!folds_in_chart && !turned_over) continue;
      int worst = -1;
      for (const int corner : child) {
        if (corner < 3 || site[corner]->kind == PiercingKind::kParametric) continue;
        if (worst < 0 || site[corner]->parameter_distance > site[worst]->parameter_distance) worst = corner;
      }
      if (worst >= 0) marked[fe[worst - 3]] = 1;
    }
  }
  return marked;
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
    if (std::find(folded.begin(), folded.end(), 1) == folded.end()) return midpoints;
    tbb::parallel_for(uint32_t{0}, coarse_.num_edges(), [&](uint32_t e) {
      if (!folded[e]) return;
      const bool was_normal = midpoints[e].kind == PiercingKind::kNormal;
      midpoints[e] = FindSite(e, was_normal ? PiercingKind::kClosest : PiercingKind::kParametric);
    });
  }
}

}  // namespace

NormalMesh Pierce(const InputSurface& surface, const BaseDomain& domain, const std::vector<Vec3f>& base_positions,
                  const PiercingOptions& options) {
  NormalMesh result;
  result.mesh.base_triangles = domain.triangles();
  result.mesh.num_base_vertices = domain.num_vertices();
  result.mesh.num_levels = options.num_levels;
  for (uint32_t v = 0; v < domain.num_vertices(); ++v) {
    result.base_points.push_back(surface.mesh().positions[domain.input_vertex(v)]);
  }
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
  if (mesh.piercing.empty()) return 1.0;
  const auto normal = std::count(mesh.piercing.begin(), mesh.piercing.end(), PiercingKind::kNormal);
  return static_cast<double>(normal) / static_cast<double>(mesh.piercing.size());
}

}  // namespace lacerta
