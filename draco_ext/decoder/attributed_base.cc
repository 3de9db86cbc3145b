#include "lacerta/attributed_base.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "common/attribute_wedges.h"
#include "common/attributed_level.h"
#include "common/base_tags.h"
#include "common/octahedral.h"
#include "common/stream_layout.h"

namespace lacerta {
namespace {

const VertexSoup::Attribute* Find(const VertexSoup& soup, const AttributeLattice& p) {
  for (const VertexSoup::Attribute& a : soup.attributes) {
    if (a.name == p.name && a.components == p.components) return &a;
  }
  return nullptr;
}

Status AppendIntegers(const AttributeLattice& p, const VertexSoup& soup, const VertexSoup::Attribute& from, std::vector<int32_t>* values) {
  if (from.values.size() != soup.positions.size() * p.components) return InvalidData("attribute " + p.name + " has not one value per vertex");
  for (size_t i = 0; i < from.values.size(); i += p.components) {
    const float* const row = &from.values[i];
    if (p.octahedral_bits > 0) {
      const auto point = OctahedralFromNormal({row[0], row[1], row[2]}, p.octahedral_bits);
      values->insert(values->end(), point.begin(), point.end());
      continue;
    }
    for (uint32_t c = 0; c < p.components; ++c) {
      const double exact = static_cast<double>(row[c]) / p.step, value = std::nearbyint(exact);
      if (!(std::fabs(value) <= kMaxLatticeValue) || std::fabs(exact - value) > 0.25) {
        return InvalidData("attribute " + p.name + " of vertex " + std::to_string(i / p.components) +
                           " is off its lattice: the base was edited, or it is not the one of this refinement");
      }
      values->push_back(static_cast<int32_t>(value));
    }
  }
  return Status();
}

// The corners of one attribute at a level, in the order of MeshAtLevel.
StatusOr<std::vector<Triangle>> CornersAtLevel(const LevelAttribute& a, const BaseTags& tags, int level) {
  if (level == 0) return a.base_corners;
  const std::vector<Triangle> split = WithoutStill(a.base_corners, tags.still);
  LACERTA_ASSIGN_OR_RETURN(AttributeWedges wedges, MakeAttributeWedges(split, a.num_base_values));
  for (int i = 0; i < level; ++i) RefineWedges(&wedges);
  std::vector<Triangle> corners(split.size() << 2 * level, {kNone, kNone, kNone});
  for (uint32_t f = 0; f < wedges.topology.num_faces(); ++f) corners[wedges.SurfaceFace(f)] = wedges.topology.triangles[f];
  if (a.num_values() < wedges.topology.num_vertices) return InvalidData("attribute " + a.name + " has not got the values of the level");
  return WithStillTriangles(std::move(corners), a.base_corners, tags);
}

StatusOr<AttributedMesh> MakeLevel(const SemiRegularMesh& surface, const std::vector<uint32_t>& base_groups,
                                   const std::vector<LevelAttribute>& attributes, int level) {
  AttributedMesh result;
  LACERTA_ASSIGN_OR_RETURN(result.surface, MeshAtLevel(surface, level));
  result.groups = GroupsAtLevel(base_groups, surface.tags, level);
  for (const LevelAttribute& a : attributes) {
    if (a.components == 0 || a.base_corners.size() != surface.base_triangles.size())
      return InvalidData("attribute " + a.name + " has not got the triangles of the base");
    LACERTA_ASSIGN_OR_RETURN(std::vector<Triangle> corners, CornersAtLevel(a, surface.tags, level));
    result.attributes.push_back({a.name, a.kind, a.components, a.values, std::move(corners)});
  }
  return result;
}

}  // namespace

StatusOr<AttributedBase> AttributedBaseFromSoups(const std::vector<VertexSoup>& groups, float step,
                                                 const std::vector<AttributeLattice>& precision) {
  TriangleMesh mesh;
  AttributedBase base;
  for (const AttributeLattice& p : precision) base.attributes.push_back({p, {}, {}});
  for (const VertexSoup& soup : groups) {
    const auto first = static_cast<uint32_t>(mesh.positions.size());
    mesh.positions.insert(mesh.positions.end(), soup.positions.begin(), soup.positions.end());
    for (const Triangle& t : soup.triangles) mesh.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    base.group_sizes.push_back(static_cast<uint32_t>(soup.triangles.size()));
    for (BaseAttribute& a : base.attributes) {
      const VertexSoup::Attribute* const from = Find(soup, a.precision);
      a.in_group.push_back(from != nullptr);
      if (from != nullptr) LACERTA_RETURN_IF_ERROR(AppendIntegers(a.precision, soup, *from, &a.values));
      a.values.resize(mesh.positions.size() * a.numbers_per_value());
    }
  }
  LACERTA_ASSIGN_OR_RETURN(base.mesh, BaseMeshFromPositions(mesh, step));
  return base;
}

StatusOr<AttributedMesh> AttributedMeshAtLevel(const AttributedSemiRegularMesh& mesh, int level) {
  return MakeLevel(mesh.surface, mesh.base_groups, mesh.attributes, level);
}

StatusOr<AttributedMesh> AttributedMeshAtLevel(const ProgressiveDecoder& decoder, int level) {
  if (level != decoder.level()) return MakeLevel(decoder.mesh(), decoder.base_groups(), decoder.attributes(), level);
  AttributedMesh result;
  result.surface = {decoder.mesh().positions, decoder.Triangles()};
  result.groups = decoder.Groups();
  for (size_t i = 0; i < decoder.attributes().size(); ++i) {
    const LevelAttribute& a = decoder.attributes()[i];
    result.attributes.push_back({a.name, a.kind, a.components, a.values, decoder.Corners(i)});
  }
  return result;
}

}  // namespace lacerta
