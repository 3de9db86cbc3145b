#include "lacerta/attributed_mesh.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/equal_rows.h"

namespace lacerta {
namespace {

constexpr uint32_t kNone = MeshAttribute::kNoValue;
constexpr size_t kMaxVertices = kNone - 1;
constexpr size_t kMaxGroups = 1 << 24;

// Welded rows of a table, as far as `uses` names them: indices of rows become indices of `rows`.
struct WeldedRows {
  std::vector<float> rows;
  std::vector<uint32_t> number;  // of each row of the table; kNone where nothing uses it
};

WeldedRows Weld(const std::vector<float>& table, size_t columns, const std::vector<bool>& is_used) {
  const std::vector<uint32_t> first = FirstEqualRow(Span<const float>(table), columns);
  WeldedRows result;
  result.number.assign(first.size(), kNone);
  std::vector<uint32_t> number_of_first(first.size(), kNone);
  for (size_t row = 0; row < first.size(); ++row) {
    if (!is_used[row]) continue;
    uint32_t& number = number_of_first[first[row]];
    if (number == kNone) {
      number = static_cast<uint32_t>(result.rows.size() / columns);
      const auto begin = table.begin() + static_cast<std::ptrdiff_t>(row * columns);
      result.rows.insert(result.rows.end(), begin, begin + static_cast<std::ptrdiff_t>(columns));
    }
    result.number[row] = number;
  }
  return result;
}

bool AreAllFinite(const std::vector<float>& values, size_t* at) {
  const auto found = std::find_if(values.begin(), values.end(), [](float x) { return !std::isfinite(x); });
  *at = static_cast<size_t>(found - values.begin());
  return found == values.end();
}

Status CheckSoup(const VertexSoup& soup) {
  for (size_t v = 0; v < soup.positions.size(); ++v) {
    const Vec3f& p = soup.positions[v];
    if (std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)) continue;
    return InvalidData("position of vertex " + std::to_string(v) + " is not finite; repair or remove it");
  }
  for (size_t f = 0; f < soup.triangles.size(); ++f) {
    for (const uint32_t v : soup.triangles[f]) {
      if (v < soup.positions.size()) continue;
      return InvalidData("triangle " + std::to_string(f) + " refers to vertex " + std::to_string(v) + " of " +
                         std::to_string(soup.positions.size()));
    }
  }
  for (const VertexSoup::Attribute& attribute : soup.attributes) {
    if (attribute.components == 0 || attribute.values.size() != soup.positions.size() * attribute.components) {
      return InvalidData(attribute.name + ": has " + std::to_string(attribute.values.size()) + " numbers for " +
                         std::to_string(soup.positions.size()) + " vertices of " + std::to_string(attribute.components) + " components");
    }
    size_t at = 0;
    if (AreAllFinite(attribute.values, &at)) continue;
    return InvalidData(attribute.name + ": value of vertex " + std::to_string(at / attribute.components) + " is not finite; repair it");
  }
  return Status();
}

// The soups one behind the other.
struct Joined {
  std::vector<float> positions;      // 3 per vertex
  std::vector<Triangle> triangles;
  std::vector<bool> is_used;         // per vertex
  std::vector<size_t> first_vertex;  // of each soup, and the end
  std::vector<uint32_t> groups;
};

StatusOr<Joined> Join(const std::vector<VertexSoup>& soups) {
  Joined joined;
  size_t num_vertices = 0;
  for (size_t s = 0; s < soups.size(); ++s) {
    const VertexSoup& soup = soups[s];
    LACERTA_RETURN_IF_ERROR(CheckSoup(soup).WithContext("group " + std::to_string(s)));
    joined.first_vertex.push_back(num_vertices);
    const auto first = static_cast<uint32_t>(num_vertices);
    num_vertices += soup.positions.size();
    if (num_vertices > kMaxVertices) return Unsupported("more than 4,294,967,294 vertices: cut the mesh into parts");
    for (const Vec3f& p : soup.positions) joined.positions.insert(joined.positions.end(), {p.x, p.y, p.z});
    joined.is_used.resize(num_vertices, false);
    for (const Triangle& t : soup.triangles) {
      joined.triangles.push_back({first + t[0], first + t[1], first + t[2]});
      joined.groups.push_back(static_cast<uint32_t>(s));
      for (const uint32_t v : joined.triangles.back()) joined.is_used[v] = true;
    }
  }
  joined.first_vertex.push_back(num_vertices);
  return joined;
}

bool IsSame(const VertexSoup::Attribute& a, const MeshAttribute& b) {
  return a.name == b.name && a.kind == b.kind && a.components == b.components;
}

// Values and corners of an attribute that some of the soups have.
void Gather(const std::vector<VertexSoup>& soups, const Joined& joined, MeshAttribute* attribute) {
  std::vector<float> table;
  std::vector<bool> is_used;
  std::vector<uint32_t> row(joined.is_used.size(), kNone);  // of each vertex
  for (size_t s = 0; s < soups.size(); ++s) {
    const auto found = std::find_if(soups[s].attributes.begin(), soups[s].attributes.end(),
                                    [&](const VertexSoup::Attribute& a) { return IsSame(a, *attribute); });
    if (found == soups[s].attributes.end()) continue;
    table.insert(table.end(), found->values.begin(), found->values.end());
    for (size_t v = joined.first_vertex[s]; v < joined.first_vertex[s + 1]; ++v) {
      row[v] = static_cast<uint32_t>(is_used.size());
      is_used.push_back(joined.is_used[v]);
    }
  }
  WeldedRows welded = Weld(table, attribute->components, is_used);
  attribute->values = std::move(welded.rows);
  const auto value_of = [&](uint32_t v) { return row[v] == kNone ? kNone : welded.number[row[v]]; };
  attribute->corners.reserve(joined.triangles.size());
  for (const Triangle& t : joined.triangles) attribute->corners.push_back({value_of(t[0]), value_of(t[1]), value_of(t[2])});
}

}  // namespace

StatusOr<AttributedMesh> WeldSoups(const std::vector<VertexSoup>& soups) {
  LACERTA_ASSIGN_OR_RETURN(const Joined joined, Join(soups));
  AttributedMesh mesh;
  mesh.groups = joined.groups;
  const WeldedRows welded = Weld(joined.positions, 3, joined.is_used);
  for (size_t i = 0; i < welded.rows.size(); i += 3) {
    mesh.surface.positions.push_back({welded.rows[i], welded.rows[i + 1], welded.rows[i + 2]});
  }
  mesh.surface.triangles = joined.triangles;
  for (Triangle& t : mesh.surface.triangles) t = {welded.number[t[0]], welded.number[t[1]], welded.number[t[2]]};
  for (const VertexSoup& soup : soups) {
    for (const VertexSoup::Attribute& a : soup.attributes) {
      const auto is_known = [&](const MeshAttribute& b) { return IsSame(a, b); };
      if (std::any_of(mesh.attributes.begin(), mesh.attributes.end(), is_known)) continue;
      mesh.attributes.push_back({a.name, a.kind, a.components, {}, {}});
      Gather(soups, joined, &mesh.attributes.back());
    }
  }
  return mesh;
}

std::vector<VertexSoup> SplitIntoSoups(const AttributedMesh& mesh, uint32_t num_groups) {
  std::vector<std::vector<uint32_t>> faces(num_groups);
  for (uint32_t f = 0; f < mesh.surface.triangles.size(); ++f) faces[mesh.GroupOf(f)].push_back(f);
  std::vector<VertexSoup> soups(num_groups);
  for (uint32_t g = 0; g < num_groups; ++g) {
    VertexSoup& soup = soups[g];
    if (faces[g].empty()) continue;
    std::vector<const MeshAttribute*> present;
    for (const MeshAttribute& attribute : mesh.attributes) {
      if (attribute.corners[faces[g].front()][0] == kNone) continue;
      present.push_back(&attribute);
      soup.attributes.push_back({attribute.name, attribute.kind, attribute.components, {}});
    }
    std::vector<uint32_t> tuples;  // per corner: its vertex and the rows of its values
    const size_t columns = 1 + present.size();
    tuples.reserve(3 * faces[g].size() * columns);
    for (const uint32_t f : faces[g]) {
      for (size_t k = 0; k < 3; ++k) {
        tuples.push_back(mesh.surface.triangles[f][k]);
        for (const MeshAttribute* attribute : present) tuples.push_back(attribute->corners[f][k]);
      }
    }
    std::vector<uint32_t> number = FirstEqualRow(Span<const uint32_t>(tuples), columns);
    for (uint32_t corner = 0; corner < number.size(); ++corner) {
      if (number[corner] != corner) {
        number[corner] = number[number[corner]];
        continue;
      }
      const uint32_t* tuple = tuples.data() + corner * columns;
      number[corner] = static_cast<uint32_t>(soup.positions.size());
      soup.positions.push_back(mesh.surface.positions[tuple[0]]);
      for (size_t a = 0; a < present.size(); ++a) {
        const auto row = present[a]->values.begin() + static_cast<std::ptrdiff_t>(size_t{tuple[1 + a]} * present[a]->components);
        soup.attributes[a].values.insert(soup.attributes[a].values.end(), row, row + present[a]->components);
      }
    }
    for (size_t i = 0; i < number.size(); i += 3) soup.triangles.push_back({number[i], number[i + 1], number[i + 2]});
  }
  return soups;
}

Status CheckAttributedMesh(const AttributedMesh& mesh) {
  const size_t num_faces = mesh.surface.triangles.size(), num_vertices = mesh.surface.positions.size();
  for (size_t f = 0; f < num_faces; ++f) {
    for (const uint32_t v : mesh.surface.triangles[f]) {
      if (v >= num_vertices) return InvalidData("triangle " + std::to_string(f) + " refers to vertex " + std::to_string(v) + " of " + std::to_string(num_vertices));
    }
  }
  if (!mesh.groups.empty() && mesh.groups.size() != num_faces) return InvalidData("there are not as many groups as triangles");
  for (const Vec3f& p : mesh.surface.positions) {
    if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) return InvalidData("a position is not finite");
  }
  for (const MeshAttribute& attribute : mesh.attributes) {
    if (attribute.components == 0 || attribute.values.size() % attribute.components != 0) {
      return InvalidData(attribute.name + ": its numbers do not fill rows of " + std::to_string(attribute.components) + " components");
    }
    if (attribute.corners.size() != num_faces) return InvalidData(attribute.name + ": there are not as many corners as triangles");
    size_t at = 0;
    if (!AreAllFinite(attribute.values, &at)) return InvalidData(attribute.name + ": value " + std::to_string(at / attribute.components) + " is not finite");
    std::vector<uint8_t> presence;  // per group: 0 unknown, 1 has none, 2 has it
    for (size_t f = 0; f < num_faces; ++f) {
      const Triangle& t = attribute.corners[f];
      const bool has_none = t[0] == kNone && t[1] == kNone && t[2] == kNone;
      const std::string place = attribute.name + ": triangle " + std::to_string(f);
      if (!has_none && std::max({t[0], t[1], t[2]}) >= attribute.num_values()) return InvalidData(place + " refers to a value that is not there");
      const size_t group = mesh.GroupOf(f);
      if (group >= kMaxGroups) return InvalidData("triangle " + std::to_string(f) + " is of group " + std::to_string(group) + ": number the groups from 0");
      if (presence.size() <= group) presence.resize(group + 1, 0);
      const uint8_t state = has_none ? 1 : 2;
      if (presence[group] != 0 && presence[group] != state) return InvalidData(place + " is not like the others of its group, of which some have a value");
      presence[group] = state;
    }
  }
  return Status();
}

}  // namespace lacerta
