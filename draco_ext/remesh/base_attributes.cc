#include "remesh/base_attributes.h"

#include <algorithm>
#include <map>
#include <utility>

#include "common/subdivision.h"

namespace lacerta {
namespace {

constexpr uint32_t kNoValue = MeshAttribute::kNoValue;
const Vec3d kMiddle{1.0 / 3, 1.0 / 3, 1.0 / 3};

int CornerOf(const Triangle& t, uint32_t v) { return t[0] == v ? 0 : t[1] == v ? 1 : 2; }

// What of the input lies under the faces of a base.
class BaseSampler {
 public:
  BaseSampler(const AttributedParts& parts, const BaseDomain& domain) : parts_(parts), domain_(domain) {}

  uint32_t GroupOf(uint32_t face) const {
    // By majority: rounding may put a point across a border.
    std::vector<uint32_t> found;
    for (const Vec3d& w : {kMiddle, Vec3d{0.6, 0.2, 0.2}, Vec3d{0.2, 0.6, 0.2}, Vec3d{0.2, 0.2, 0.6}, kMiddle}) {
      found.push_back(parts_.refined.GroupOf(domain_.ToInput({face, w}).face));
    }
    std::sort(found.begin(), found.end());
    return found[found.size() / 2];
  }

  // The edge of the input's curve that lies in the middle of a base edge on a curve.
  uint32_t InputEdgeUnder(uint32_t edge) const {
    const uint32_t face = domain_.topology().edge_faces[edge][0];
    const int corner = EdgeCorner(domain_.topology(), face, edge);
    uint32_t nearest = kNone;
    double least = 2;
    for (const double share : {0.5, 0.37, 0.61, 0.23, 0.83}) {
      DomainPoint point{face, {}};
      point.barycentric[(corner + 1) % 3] = share;
      point.barycentric[(corner + 2) % 3] = 1 - share;
      const DomainPoint on_input = domain_.ToInput(point);
      for (int k = 0; k < 3; ++k) {
        const uint32_t e = parts_.topology.face_edges[on_input.face][k];
        // How far from the edge, and how near to one of its ends, where others may be meant.
        const double end = std::max(on_input.barycentric[(k + 1) % 3], on_input.barycentric[(k + 2) % 3]);
        const double distance = on_input.barycentric[k] + (end > 0.999 ? 1 : 0);
        if (!parts_.topology.on_curve[e] || distance >= least) continue;
        least = distance;
        nearest = e;
      }
    }
    return nearest;
  }

  // The face of the input at a corner of a base face, on that face's side of all curves.
  uint32_t InputFaceAt(uint32_t face, int corner) const {
    const uint32_t v = domain_.input_vertex(domain_.triangles()[face][corner]);
    uint32_t first = kNone;
    for (const double share : {1e-2, 1e-3, 1e-4, 1e-6, 1e-8}) {
      DomainPoint point{face, kMiddle * share};
      point.barycentric[corner] += 1 - share;
      const uint32_t found = domain_.ToInput(point).face;
      if (first == kNone) first = found;
      const Triangle& t = parts_.refined.surface.triangles[found];
      if (std::find(t.begin(), t.end(), v) != t.end()) return found;
    }
    return first;
  }

 private:
  const AttributedParts& parts_;
  const BaseDomain& domain_;
};

// Numbers the wedges of the base faces in order of appearance; row: of each, its first corner.
std::vector<Triangle> NumberWedges(const std::vector<uint32_t>& wedge, const std::vector<uint8_t>& has_value, std::vector<uint32_t>* first_corner) {
  std::vector<uint32_t> number(wedge.size(), kNone);
  std::vector<Triangle> corners(wedge.size() / 3, {kNoValue, kNoValue, kNoValue});
  for (uint32_t c = 0; c < wedge.size(); ++c) {
    if (!has_value[c / 3]) continue;
    if (number[wedge[c]] == kNone) {
      number[wedge[c]] = static_cast<uint32_t>(first_corner->size());
      first_corner->push_back(c);
    }
    corners[c / 3][c % 3] = number[wedge[c]];
  }
  return corners;
}

void AppendRow(const MeshAttribute& attribute, uint32_t row, std::vector<float>* values) {
  const auto first = attribute.values.begin() + static_cast<std::ptrdiff_t>(size_t{row} * attribute.components);
  values->insert(values->end(), first, first + attribute.components);
}

// At a point of a face with values.
void AppendValueAt(const MeshAttribute& attribute, const DomainPoint& point, std::vector<float>* values) {
  const Triangle& rows = attribute.corners[point.face];
  for (size_t c = 0; c < attribute.components; ++c) {
    double sum = 0;
    for (int k = 0; k < 3; ++k) sum += point.barycentric[k] * static_cast<double>(attribute.values[size_t{rows[k]} * attribute.components + c]);
    values->push_back(static_cast<float>(sum));
  }
}

// Appends the attribute of the still triangles: `still_face`, #F0, their numbers in the still part, or kNone.
void AddStill(const MeshAttribute& attribute, const std::vector<uint32_t>& still_face, const std::vector<Triangle>& base_triangles,
              const std::vector<Triangle>& still_triangles, const std::vector<uint32_t>& still_vertex, LevelAttribute* level) {
  std::map<std::pair<uint32_t, uint32_t>, uint32_t> rows;  // by vertex and row of the input
  for (size_t f = 0; f < still_face.size(); ++f) {
    if (still_face[f] == kNone) continue;
    const Triangle& from = attribute.corners[still_face[f]];
    if (from[0] == kNoValue) continue;
    for (size_t k = 0; k < 3; ++k) {
      const uint32_t v = still_vertex[base_triangles[f][k]];
      const uint32_t row = from[static_cast<size_t>(CornerOf(still_triangles[still_face[f]], v))];
      const auto [at, is_new] = rows.emplace(std::pair(v, row), level->num_base_values);
      if (is_new) {
        ++level->num_base_values;
        AppendRow(attribute, row, &level->values);
      }
      level->base_corners[f][k] = at->second;
    }
  }
}

Triangle Rotated(Triangle t) {
  std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
  return t;
}

// #F0, the triangles of the still part, or kNone.
std::vector<uint32_t> StillFaces(const AttributedMesh& still, const std::vector<Triangle>& base_triangles,
                                 const std::vector<uint32_t>& still_vertex) {
  std::map<Triangle, uint32_t> by_vertices;
  for (uint32_t f = 0; f < still.surface.triangles.size(); ++f) by_vertices.emplace(Rotated(still.surface.triangles[f]), f);
  std::vector<uint32_t> faces;
  for (const Triangle& t : base_triangles) {
    const bool is_still = still_vertex[t[0]] != kNone;
    faces.push_back(is_still ? by_vertices.at(Rotated({still_vertex[t[0]], still_vertex[t[1]], still_vertex[t[2]]})) : kNone);
  }
  return faces;
}

}  // namespace

BaseAttributes SampleBase(const AttributedParts& parts, const BaseDomain& domain, const std::vector<Triangle>& base_triangles,
                          const std::vector<uint32_t>& still_vertex) {
  const BaseSampler sampler(parts, domain);
  const Topology& topology = domain.topology();
  const std::vector<uint32_t> still_face = StillFaces(parts.still, base_triangles, still_vertex);
  BaseAttributes result;
  std::vector<uint32_t> split_number;  // #F0, of the domain's faces
  uint32_t num_split = 0;
  for (size_t f = 0; f < base_triangles.size(); ++f) {
    const bool is_still = still_face[f] != kNone;
    result.groups.push_back(is_still ? parts.still.GroupOf(still_face[f]) : sampler.GroupOf(num_split));
    split_number.push_back(is_still ? kNone : num_split++);
  }
  std::vector<uint32_t> input_edge(topology.num_edges(), kNone);
  for (uint32_t e = 0; e < topology.num_edges(); ++e) {
    if (topology.on_curve[e] && !topology.is_border(e)) input_edge[e] = sampler.InputEdgeUnder(e);
  }
  for (size_t a = 0; a < parts.refined.attributes.size(); ++a) {
    const MeshAttribute& attribute = parts.refined.attributes[a];
    LevelAttribute& level = result.attributes.emplace_back();
    level.name = attribute.name;
    level.kind = attribute.kind;
    level.components = attribute.components;
    std::vector<uint8_t> is_seam(topology.num_edges(), 0), has_value(topology.num_faces(), 0);
    for (uint32_t e = 0; e < topology.num_edges(); ++e) {
      is_seam[e] = topology.is_border(e) || (input_edge[e] != kNone && parts.seams[a][input_edge[e]] != 0);
    }
    for (uint32_t f = 0; f < topology.num_faces(); ++f) {
      has_value[f] = attribute.corners[domain.ToInput({f, kMiddle}).face][0] != kNoValue;
    }
    std::vector<uint32_t> first_corner;
    const std::vector<Triangle> corners = NumberWedges(FindWedges(topology, is_seam), has_value, &first_corner);
    level.num_base_values = static_cast<uint32_t>(first_corner.size());
    for (const uint32_t c : first_corner) {
      const int k = static_cast<int>(c % 3);
      const uint32_t vertex = topology.triangles[c / 3][static_cast<size_t>(k)];
      if (const DomainPoint& place = domain.slid_to(vertex); place.face != kNone && attribute.corners[place.face][0] != kNoValue) {
        AppendValueAt(attribute, place, &level.values);
        continue;
      }
      const uint32_t face = sampler.InputFaceAt(c / 3, k);
      const Triangle& rows = attribute.corners[face][0] != kNoValue ? attribute.corners[face]
                                                                    : attribute.corners[domain.ToInput({c / 3, kMiddle}).face];
      const uint32_t v = domain.input_vertex(vertex);
      AppendRow(attribute, rows[static_cast<size_t>(CornerOf(parts.refined.surface.triangles[face], v))], &level.values);
    }
    for (const uint32_t f : split_number) level.base_corners.push_back(f == kNone ? Triangle{kNoValue, kNoValue, kNoValue} : corners[f]);
    if (!parts.still.surface.triangles.empty()) {
      AddStill(parts.still.attributes[a], still_face, base_triangles, parts.still.surface.triangles, still_vertex, &level);
    }
  }
  return result;
}

}  // namespace lacerta
