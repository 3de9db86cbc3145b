#include "lacerta/clean.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "common/subdivision.h"
#include "geometry/close_cracks.h"
#include "geometry/equal_rows.h"

namespace lacerta {
namespace {

Status CheckInput(const TriangleMesh& mesh) {
  if (mesh.positions.size() >= kNone) return Unsupported("more than 4,294,967,294 vertices: cut the mesh into parts");
  if (mesh.triangles.size() > (1u << 30))
    return Unsupported("more than 1,073,741,824 triangles: cut the mesh into parts");
  for (size_t v = 0; v < mesh.positions.size(); ++v) {
    const Vec3f& p = mesh.positions[v];
    if (std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z)) continue;
    return InvalidData("position of vertex " + std::to_string(v) + " is not finite: repair the mesh first");
  }
  for (size_t f = 0; f < mesh.triangles.size(); ++f) {
    for (const uint32_t v : mesh.triangles[f]) {
      if (v < mesh.positions.size()) continue;
      return InvalidData("triangle " + std::to_string(f) + " refers to vertex " + std::to_string(v) + " of " +
                         std::to_string(mesh.positions.size()));
    }
  }
  return Status();
}

// For each vertex the first one at the same position.
std::vector<uint32_t> FirstAtPosition(const std::vector<Vec3f>& positions) {
  std::vector<float> table;
  table.reserve(3 * positions.size());
  for (const Vec3f& p : positions) table.insert(table.end(), {p.x, p.y, p.z});
  return FirstEqualRow(Span<const float>(table), 3);
}

// True for triangles that repeat an earlier one, whichever corner they start at.
std::vector<bool> RepeatedTriangles(const std::vector<Triangle>& triangles) {
  const auto rotated = [&](uint32_t f) {
    Triangle t = triangles[f];
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    return t;
  };
  std::vector<std::pair<Triangle, uint32_t>> keyed(triangles.size());
  for (uint32_t f = 0; f < triangles.size(); ++f) keyed[f] = {rotated(f), f};
  std::sort(keyed.begin(), keyed.end());
  std::vector<bool> repeated(triangles.size(), false);
  for (size_t i = 1; i < keyed.size(); ++i) repeated[keyed[i].second] = keyed[i].first == keyed[i - 1].first;
  return repeated;
}

// The triangles with vertices replaced, but for those that have one twice then.
std::vector<Triangle> WithVertices(const std::vector<uint32_t>& replaced, const std::vector<Triangle>& triangles) {
  std::vector<Triangle> result;
  result.reserve(triangles.size());
  for (const Triangle& t : triangles) {
    const Triangle r = {replaced[t[0]], replaced[t[1]], replaced[t[2]]};
    if (r[0] != r[1] && r[1] != r[2] && r[2] != r[0]) result.push_back(r);
  }
  return result;
}

}  // namespace

StatusOr<CleanedMesh> Clean(const TriangleMesh& mesh) {
  LACERTA_RETURN_IF_ERROR(CheckInput(mesh));
  CleanedMesh result;
  std::vector<uint32_t> first = FirstAtPosition(mesh.positions);
  std::vector<Triangle> triangles = WithVertices(first, mesh.triangles);
  const std::vector<uint32_t> closed = VerticesWithoutCracks({mesh.positions, triangles});
  for (uint32_t& v : first) v = closed[v];
  triangles = WithVertices(closed, triangles);
  result.report.degenerate_triangles = mesh.triangles.size() - triangles.size();
  const std::vector<bool> repeated = RepeatedTriangles(triangles);
  std::vector<bool> used(mesh.positions.size(), false), referenced(mesh.positions.size(), false);
  for (const Triangle& t : mesh.triangles) {
    for (const uint32_t v : t) referenced[v] = true;
  }
  for (size_t f = 0; f < triangles.size(); ++f) {
    if (repeated[f]) {
      ++result.report.duplicate_triangles;
      continue;
    }
    result.mesh.triangles.push_back(triangles[f]);
    for (const uint32_t v : triangles[f]) used[v] = true;
  }
  if (result.mesh.triangles.empty()) return InvalidData("the mesh has no triangle left after cleaning");

  std::vector<uint32_t> new_index(mesh.positions.size(), kNone);
  for (uint32_t v = 0; v < mesh.positions.size(); ++v) {
    if (first[v] != v && referenced[v]) ++result.report.welded_vertices;
    if (used[v]) {
      new_index[v] = static_cast<uint32_t>(result.mesh.positions.size());
      result.mesh.positions.push_back(mesh.positions[v]);
    } else if (first[v] == v || !referenced[v]) {
      ++result.report.isolated_vertices;
    }
  }
  for (Triangle& t : result.mesh.triangles) t = {new_index[t[0]], new_index[t[1]], new_index[t[2]]};
  return result;
}

}  // namespace lacerta
