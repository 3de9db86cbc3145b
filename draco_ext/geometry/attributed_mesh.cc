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

// Welds the equal rows of a table, drops those that no corner names, and names the others anew.
void WeldRows(size_t columns, std::vector<float>* table, std::vector<Triangle>* corners) {
  const std::vector<uint32_t> first = FirstEqualRow(Span<const float>(*table), columns);
  std::vector<uint32_t> number(first.size(), kNone);
  for (const Triangle& t : *corners) {
    for (const uint32_t row : t) {
      if (row != kNone) number[first[row]] = 0;
    }
  }
  size_t count = 0;
  for (size_t row = 0; row < first.size(); ++row) {
    if (number[row] == kNone) continue;
    std::copy_n(table->begin() + static_cast<std::ptrdiff_t>(row * columns), columns,
                table->begin() + static_cast<std::ptrdiff_t>(count * columns));
    number[row] = static_cast<uint32_t>(count++);
  }
  table->resize(count * columns);
  for (Triangle& t : *corners) {
    for (uint32_t& row : t) {
      if (row != kNone) row = number[first[row]];
    }
  }
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
    const auto is_namesake = [&](const VertexSoup::Attribute& other) { return other.name == attribute.name; };
    if (std::count_if(soup.attributes.begin(), soup.attributes.end(), is_namesake) > 1) return InvalidData(attribute.name + " is there twice");
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

bool IsSame(const VertexSoup::Attribute& a, const MeshAttribute& b) {
  return a.name == b.name && a.kind == b.kind && a.components == b.components;
}

// The attribute of that kind in `soup`, added to *mesh where it is new.
MeshAttribute& AttributeLike(const VertexSoup::Attribute& attribute, AttributedMesh* mesh) {
  for (MeshAttribute& known : mesh->attributes) {
    if (IsSame(attribute, known)) return known;
  }
  mesh->attributes.push_back({attribute.name, attribute.kind, attribute.components, {}, {}});
  return mesh->attributes.back();
}

}  // namespace

StatusOr<AttributedMesh> WeldSoups(const std::vector<VertexSoup>& soups) {
  AttributedMesh mesh;
  for (size_t s = 0; s < soups.size(); ++s) {
    const VertexSoup& soup = soups[s];
    LACERTA_RETURN_IF_ERROR(CheckSoup(soup).WithContext("group " + std::to_string(s)));
    if (mesh.surface.positions.size() + soup.positions.size() > kMaxVertices) {
      return Unsupported("more than 4,294,967,294 vertices: cut the mesh into parts");
    }
    const auto first_vertex = static_cast<uint32_t>(mesh.surface.positions.size());
    const size_t first_face = mesh.surface.triangles.size();
    mesh.surface.positions.insert(mesh.surface.positions.end(), soup.positions.begin(), soup.positions.end());
    for (const Triangle& t : soup.triangles) {
      mesh.surface.triangles.push_back({first_vertex + t[0], first_vertex + t[1], first_vertex + t[2]});
      mesh.groups.push_back(static_cast<uint32_t>(s));
    }
    for (const VertexSoup::Attribute& own : soup.attributes) {
      MeshAttribute& attribute = AttributeLike(own, &mesh);
      const uint32_t first_row = attribute.num_values();
      attribute.values.insert(attribute.values.end(), own.values.begin(), own.values.end());
      attribute.corners.resize(first_face, {kNone, kNone, kNone});
      for (const Triangle& t : soup.triangles) attribute.corners.push_back({first_row + t[0], first_row + t[1], first_row + t[2]});
    }
  }
  for (MeshAttribute& attribute : mesh.attributes) attribute.corners.resize(mesh.surface.triangles.size(), {kNone, kNone, kNone});
  WeldExactly(&mesh);
  return mesh;
}

void WeldExactly(AttributedMesh* mesh) {
  std::vector<float> table;
  table.reserve(3 * mesh->surface.positions.size());
  for (const Vec3f& p : mesh->surface.positions) table.insert(table.end(), {p.x, p.y, p.z});
  WeldRows(3, &table, &mesh->surface.triangles);
  mesh->surface.positions.clear();
  for (size_t i = 0; i < table.size(); i += 3) mesh->surface.positions.push_back({table[i], table[i + 1], table[i + 2]});
  for (MeshAttribute& attribute : mesh->attributes) WeldRows(attribute.components, &attribute.values, &attribute.corners);
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
      const auto place = [&] { return attribute.name + ": triangle " + std::to_string(f); };
      if (!has_none && std::max({t[0], t[1], t[2]}) >= attribute.num_values()) return InvalidData(place() + " refers to a value that is not there");
      const size_t group = mesh.GroupOf(f);
      if (group >= kMaxGroups) return InvalidData("triangle " + std::to_string(f) + " is of group " + std::to_string(group) + ": number the groups from 0");
      if (presence.size() <= group) presence.resize(group + 1, 0);
      const uint8_t state = has_none ? 1 : 2;
      if (presence[group] != 0 && presence[group] != state) return InvalidData(place() + " is not like the others of its group, of which some have a value");
      presence[group] = state;
    }
  }
  return Status();
}

}  // namespace lacerta
