#include "lacerta/clean.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "common/subdivision.h"
#include "geometry/close_cracks.h"
#include "geometry/position_table.h"
#include "geometry/vertex_ranges.h"

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
  PositionTable table(positions.size());
  std::vector<uint32_t> first(positions.size());
  for (uint32_t v = 0; v < first.size(); ++v) first[v] = table.FindOrEnter(positions, positions[v], v);
  return first;
}

// True for triangles that repeat an earlier one, whichever corner they start at.
std::vector<bool> RepeatedTriangles(const TriangleMesh& mesh) {
  constexpr uint64_t kTrianglesAtATime = 2'000'000;
  const std::vector<Triangle>& triangles = mesh.triangles;
  const auto lowest = [&](size_t f) { return *std::min_element(triangles[f].begin(), triangles[f].end()); };
  const auto rotated = [&](uint32_t f) {
    Triangle t = triangles[f];
    std::rotate(t.begin(), std::min_element(t.begin(), t.end()), t.end());
    return t;
  };
  const auto for_each_triangle = [&](const auto& visit) {
    for (size_t f = 0; f < triangles.size(); ++f) visit(lowest(f));
  };
  std::vector<bool> repeated(triangles.size(), false);
  for (const VertexRange& range : CutVertices(static_cast<uint32_t>(mesh.positions.size()), kTrianglesAtATime, for_each_triangle)) {
    std::vector<std::pair<Triangle, uint32_t>> keyed;
    for (uint32_t f = 0; f < triangles.size(); ++f) {
      if (range.Has(lowest(f))) keyed.emplace_back(rotated(f), f);
    }
    std::sort(keyed.begin(), keyed.end());
    for (size_t i = 1; i < keyed.size(); ++i) repeated[keyed[i].second] = keyed[i].first == keyed[i - 1].first;
  }
  return repeated;
}

// Replaces vertices, and takes off the triangles that have one twice then.
void ReplaceVertices(const std::vector<uint32_t>& replaced, std::vector<Triangle>* triangles) {
  size_t kept = 0;
  for (const Triangle& t : *triangles) {
    const Triangle r = {replaced[t[0]], replaced[t[1]], replaced[t[2]]};
    if (r[0] != r[1] && r[1] != r[2] && r[2] != r[0]) (*triangles)[kept++] = r;
  }
  triangles->resize(kept);
}

std::vector<bool> UsedVertices(const TriangleMesh& mesh) {
  std::vector<bool> used(mesh.positions.size(), false);
  for (const Triangle& t : mesh.triangles) {
    for (const uint32_t v : t) used[v] = true;
  }
  return used;
}

// Welds vertices: for each what replaces it, triangles in the same terms.
std::vector<uint32_t> Weld(TriangleMesh* mesh) {
  std::vector<uint32_t> first = FirstAtPosition(mesh->positions);
  ReplaceVertices(first, &mesh->triangles);
  const std::vector<uint32_t> closed = VerticesWithoutCracks(*mesh);
  for (uint32_t& v : first) v = closed[v];
  ReplaceVertices(closed, &mesh->triangles);
  return first;
}

uint64_t RemoveRepeated(TriangleMesh* mesh) {
  const std::vector<bool> repeated = RepeatedTriangles(*mesh);
  size_t kept = 0;
  for (size_t f = 0; f < mesh->triangles.size(); ++f) {
    if (!repeated[f]) mesh->triangles[kept++] = mesh->triangles[f];
  }
  const uint64_t removed = mesh->triangles.size() - kept;
  mesh->triangles.resize(kept);
  return removed;
}

}  // namespace

StatusOr<CleanReport> CleanInPlace(TriangleMesh* mesh) {
  LACERTA_RETURN_IF_ERROR(CheckInput(*mesh));
  CleanReport report;
  const std::vector<bool> referenced = UsedVertices(*mesh);
  const size_t num_triangles = mesh->triangles.size();
  std::vector<uint32_t> new_index = Weld(mesh);  // what replaces a vertex, at first
  report.degenerate_triangles = num_triangles - mesh->triangles.size();
  report.duplicate_triangles = RemoveRepeated(mesh);
  if (mesh->triangles.empty()) return InvalidData("the mesh has no triangle left after cleaning");

  const std::vector<bool> used = UsedVertices(*mesh);
  uint32_t num_kept = 0;
  for (uint32_t v = 0; v < mesh->positions.size(); ++v) {
    const bool is_first = new_index[v] == v;
    if (!is_first && referenced[v]) ++report.welded_vertices;
    if (used[v]) {
      mesh->positions[num_kept] = mesh->positions[v];
      new_index[v] = num_kept++;
    } else if (is_first || !referenced[v]) {
      ++report.isolated_vertices;
    }
  }
  mesh->positions.resize(num_kept);
  for (Triangle& t : mesh->triangles) t = {new_index[t[0]], new_index[t[1]], new_index[t[2]]};
  return report;
}

StatusOr<CleanedMesh> Clean(const TriangleMesh& mesh) {
  CleanedMesh result{mesh, {}};
  LACERTA_ASSIGN_OR_RETURN(result.report, CleanInPlace(&result.mesh));
  return result;
}

}  // namespace lacerta
