#include "remesh/level_attributes.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <array>
#include <optional>

#include "common/subdivision.h"
#include "geometry/triangle_points.h"
#include "remesh/level_wedges.h"

namespace lacerta {
namespace {

constexpr uint32_t kNoValue = MeshAttribute::kNoValue;
constexpr std::array<double, 5> kInward = {1e-3, 1e-2, 0.1, 0.5, 1.0};  // steps towards the middle of a base face, as shares of the way
const Vec3d kMiddle{1.0 / 3, 1.0 / 3, 1.0 / 3};

// Where a vertex of the finest level stands on the input, seen from a base face.
class LevelSampler {
 public:
  LevelSampler(const AttributedParts& parts, const BaseDomain& domain) : parts_(parts), domain_(domain) {}

  // Whose values are those of `attribute` on the side of base face `face`; position: of the vertex.
  DomainPoint OnInput(const MeshAttribute& attribute, uint32_t face, const DomainPoint& parameter, const Vec3f& position) const {
    const std::optional<ChartPoint> q = domain_.ToChart(face, parameter);
    if (!q || !IsOnCurve(face, *q)) {
      const DomainPoint found = domain_.ToInput(parameter);
      if (attribute.corners[found.face][0] != kNoValue) return found;
    }
    const Vec3d inside = ClampWeights(q ? *q : kMiddle);
    DomainPoint found;
    for (const double share : kInward) {
      found = domain_.ToInput({face, inside * (1 - share) + kMiddle * share});
      if (attribute.corners[found.face][0] != kNoValue) break;
    }
    const Triangle& t = parts_.refined.surface.triangles[found.face];
    std::array<Vec3d, 3> corners;
    for (size_t k = 0; k < 3; ++k) corners[k] = Vec3Cast<double>(parts_.refined.surface.positions[t[k]]);
    found.barycentric = NearestWeights(corners, Vec3Cast<double>(position), found.barycentric);
    return found;
  }

 private:
  bool IsOnCurve(uint32_t face, const ChartPoint& q) const {
    constexpr double kNear = 1e-6;
    for (int k = 0; k < 3; ++k) {
      if (q[k] < kNear && domain_.topology().on_curve[domain_.topology().face_edges[face][k]]) return true;
    }
    // A curve may end at a corner of the face and leave it on the other side.
    return q.x > 1 - kNear || q.y > 1 - kNear || q.z > 1 - kNear;
  }

  // Of the point of the plane of a triangle that is nearest to p, held inside of the triangle; `otherwise` for one without area.
  static Vec3d NearestWeights(const std::array<Vec3d, 3>& corners, const Vec3d& p, const Vec3d& otherwise) {
    const Vec3d normal = Cross(corners[1] - corners[0], corners[2] - corners[0]);
    const double area = SquaredNorm(normal);
    if (!(area > 0)) return otherwise;
    const double w1 = Dot(Cross(p - corners[0], corners[2] - corners[0]), normal) / area;
    const double w2 = Dot(Cross(corners[1] - corners[0], p - corners[0]), normal) / area;
    return ClampWeights({1 - w1 - w2, w1, w2});
  }

  const AttributedParts& parts_;
  const BaseDomain& domain_;
};

}  // namespace

void SampleLevels(const AttributedParts& parts, const BaseDomain& domain, const SemiRegularMesh& remesh,
                  const std::vector<DomainPoint>& parameters, std::vector<LevelAttribute>* attributes) {
  const LevelSampler sampler(parts, domain);
  Topology topology = domain.topology();
  for (int i = 0; i < remesh.num_levels; ++i) topology = Refine(topology);
  for (size_t a = 0; a < attributes->size(); ++a) {
    LevelAttribute& level = (*attributes)[a];
    const MeshAttribute& attribute = parts.refined.attributes[a];
    const SplitWedges split = SplitOf(remesh.tags, level);
    if (split.triangles.empty()) continue;
    const std::vector<Triangle> wedges = RefinedWedges(split, level.num_base_values, remesh.num_levels);
    uint32_t num_values = level.num_base_values;
    for (const Triangle& t : wedges) num_values = std::max({num_values, t[0] + 1, t[1] + 1, t[2] + 1});
    const uint32_t base_values = level.num_base_values, per_base = 1u << (2 * remesh.num_levels);
    // The first corner at which each value stands, as a corner of the surface.
    std::vector<uint32_t> corner_of(num_values, kNone);
    for (uint32_t f = 0; f < split.number.size(); ++f) {
      if (split.number[f] == kNone) continue;
      for (uint32_t i = 0; i < per_base; ++i) {
        const Triangle& t = wedges[split.number[f] * per_base + i];
        for (uint32_t k = 0; k < 3; ++k) {
          if (corner_of[t[k]] == kNone) corner_of[t[k]] = 3 * (f * per_base + i) + k;
        }
      }
    }
    const size_t columns = attribute.components;
    level.values.resize(num_values * columns);
    tbb::parallel_for(base_values, num_values, [&](uint32_t row) {
      const uint32_t face = corner_of[row] / 3, v = topology.triangles[face][corner_of[row] % 3];
      const DomainPoint point = sampler.OnInput(attribute, face / per_base, parameters[v], remesh.positions[v]);
      const Triangle& rows = attribute.corners[point.face];
      for (size_t c = 0; c < columns; ++c) {
        double sum = 0;
        for (size_t k = 0; k < 3 && rows[0] != kNoValue; ++k) {
          sum += point.barycentric[static_cast<int>(k)] * static_cast<double>(attribute.values[rows[k] * columns + c]);
        }
        level.values[row * columns + c] = static_cast<float>(sum);
      }
    });
  }
}

}  // namespace lacerta
