#include "common/attribute_prediction.h"

#include "common/coefficient_sets.h"
#include "common/local_frame.h"

namespace lacerta {
namespace {

Vec3f VectorAt(const float* row) { return {row[0], row[1], row[2]}; }

void SetVector(const Vec3f& v, float* row) {
  for (int c = 0; c < 3; ++c) row[c] = v[c];
}

// Of unit length; the direction before where there is none.
Vec3f UnitOr(const Vec3f& v, const Vec3f& otherwise) {
  const Vec3f unit = Normalized(v);
  return unit == Vec3f{} ? otherwise : unit;
}

// Area vectors of the decoded triangles of the finer level that meet at the midpoint of a wedge edge, added up: those on its side of
// the attribute's seams alone.
Vec3f AreaAround(const AttributeWedges& wedges, const SurfaceLevel& surface, uint32_t edge) {
  const uint32_t num_coarse = surface.coarse.num_vertices;
  const Span<const Vec3f> positions(surface.positions), midpoints(positions.data() + num_coarse, positions.size() - num_coarse);
  Vec3f sum;
  for (const uint32_t f : wedges.topology.edge_faces[edge]) {
    if (f == kNone) continue;
    const SplitFace split(surface.coarse, positions, midpoints, wedges.SurfaceFace(f));
    const int k = EdgeCorner(wedges.topology, f, edge);
    sum += split.InMiddle();
    sum += split.AtCorner((k + 1) % 3);
    sum += split.AtCorner((k + 2) % 3);
  }
  return sum;
}

}  // namespace

void PredictAttribute(const AttributeHeader& header, const AttributeWedges& wedges, const SurfaceLevel& surface, std::vector<float>* values) {
  const Topology& t = wedges.topology;
  const uint32_t n = header.precision.components;
  values->resize((size_t{t.num_vertices} + t.num_edges()) * n);
  for (uint32_t e = 0; e < t.num_edges(); ++e) {
    float* const row = values->data() + (size_t{t.num_vertices} + e) * n;
    const float* const first = values->data() + size_t{t.edges[e][0]} * n;
    const auto add = [&](uint32_t v, float weight) {
      const float* const from = values->data() + size_t{v} * n;
      for (uint32_t c = 0; c < n; ++c) row[c] += from[c] * weight;
    };
    if (header.prediction == AttributePrediction::kGeometry) {
      SetVector(AreaAround(wedges, surface, e), row);
    } else if (header.prediction == AttributePrediction::kLinear) {
      for (const uint32_t v : t.edges[e]) add(v, 0.5f);
    } else {
      VisitStencil(t, wedges.stencils, e, add);
    }
    if (!IsDirection(header.precision.kind)) continue;
    SetVector(UnitOr(VectorAt(row), VectorAt(first)), row);
    if (n == 4) row[3] = first[3];
  }
}

std::array<Vec3f, 2> NormalAxes(const AttributeWedges& wedges, const SurfaceLevel& surface, uint32_t edge, const Vec3f& normal) {
  const uint32_t f = wedges.topology.edge_faces[edge][0];
  const int k = EdgeCorner(wedges.topology, f, edge);
  const Triangle& face = surface.coarse.triangles[wedges.SurfaceFace(f)];
  const Vec3f along = Normalized(surface.positions[face[(k + 2) % 3]] - surface.positions[face[(k + 1) % 3]]);
  const Vec3f across = along - normal * Dot(along, normal);
  const Vec3f tangent = SquaredNorm(across) > 1e-6f ? Normalized(across) : AnyOrthogonal(normal);
  return {tangent, Cross(normal, tangent)};
}

void AddResiduals(const AttributeHeader& header, const AttributeWedges& wedges, const SurfaceLevel& surface, float step,
                  const std::vector<int32_t>& residuals, std::vector<float>* values) {
  const Topology& t = wedges.topology;
  const uint32_t n = header.precision.components, coded = CodedComponents(header.precision);
  for (uint32_t e = 0; e < t.num_edges(); ++e) {
    const auto stored = [&](uint32_t c) { return residuals[size_t{c} * t.num_edges() + e]; };
    const auto residual = [&](uint32_t c) { return static_cast<float>(stored(c)) * step; };
    float* const row = values->data() + (size_t{t.num_vertices} + e) * n;
    bool moves = false;
    for (uint32_t c = 0; c < coded; ++c) moves = moves || stored(c) != 0;
    if (!moves) continue;
    if (header.precision.kind == AttributeKind::kNormal) {
      const Vec3f normal = VectorAt(row);
      const auto axes = NormalAxes(wedges, surface, e, normal);
      SetVector(UnitOr(normal + axes[0] * residual(0) + axes[1] * residual(1), normal), row);
      continue;
    }
    const Vec3f before = header.precision.kind == AttributeKind::kTangent ? VectorAt(row) : Vec3f{};
    int32_t whole = 0;
    for (uint32_t c = 0; c < coded; ++c) {
      whole = stored(c) + (IsChained(header, c) ? whole : 0);
      row[c] += static_cast<float>(whole) * step;
    }
    if (header.precision.kind == AttributeKind::kTangent) SetVector(UnitOr(VectorAt(row), before), row);
  }
}

}  // namespace lacerta
