#include "remesh/simplify_in_parts.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "geometry/bounding_box.h"
#include "remesh/attributed_simplify.h"

namespace lacerta {
namespace {

constexpr uint32_t kNone = MeshAttribute::kNoValue;

using Faces = std::vector<uint32_t>;

// Three times the middle of a face.
Vec3f SumOfCorners(const TriangleMesh& surface, uint32_t face) {
  const Triangle& t = surface.triangles[face];
  return surface.positions[t[0]] + surface.positions[t[1]] + surface.positions[t[2]];
}

// Halves the faces across the longest side of their box until none of the parts has more than `most`; those are ascending.
void CutIntoParts(const TriangleMesh& surface, Faces faces, size_t most, std::vector<Faces>* parts) {
  if (faces.size() <= most) {
    std::sort(faces.begin(), faces.end());
    parts->push_back(std::move(faces));
    return;
  }
  std::vector<Vec3f> middles;
  middles.reserve(faces.size());
  for (const uint32_t f : faces) middles.push_back(SumOfCorners(surface, f));
  const BoundingBox box = BoundsOf(middles);
  middles = {};
  const Vec3f sides = box.high - box.low;
  const int axis = sides.x >= sides.y && sides.x >= sides.z ? 0 : sides.y >= sides.z ? 1 : 2;
  const auto middle = faces.begin() + static_cast<std::ptrdiff_t>(faces.size() / 2);
  std::nth_element(faces.begin(), middle, faces.end(), [&](uint32_t f, uint32_t g) {
    const float a = SumOfCorners(surface, f)[axis], b = SumOfCorners(surface, g)[axis];
    return a != b ? a < b : f < g;
  });
  Faces second(middle, faces.end());
  faces.resize(faces.size() / 2);
  faces.shrink_to_fit();
  CutIntoParts(surface, std::move(faces), most, parts);
  CutIntoParts(surface, std::move(second), most, parts);
}

// For each vertex 1 where faces of several parts meet.
std::vector<uint8_t> FindShared(const TriangleMesh& surface, const std::vector<Faces>& parts) {
  std::vector<uint32_t> part_of(surface.positions.size(), kNone);
  std::vector<uint8_t> is_shared(surface.positions.size(), 0);
  for (uint32_t p = 0; p < parts.size(); ++p) {
    for (const uint32_t f : parts[p]) {
      for (const uint32_t v : surface.triangles[f]) {
        is_shared[v] = is_shared[v] != 0 || (part_of[v] != kNone && part_of[v] != p);
        part_of[v] = p;
      }
    }
  }
  return is_shared;
}

// Rows that some faces refer to, ascending, with their triangles renumbered.
struct Rows {
  std::vector<uint32_t> rows;
  std::vector<Triangle> triangles;  // of the faces
};

Rows TakeRows(const std::vector<Triangle>& triangles, const Faces& faces) {
  Rows result;
  for (const uint32_t f : faces) {
    for (const uint32_t row : triangles[f]) {
      if (row != kNone) result.rows.push_back(row);
    }
  }
  std::sort(result.rows.begin(), result.rows.end());
  result.rows.erase(std::unique(result.rows.begin(), result.rows.end()), result.rows.end());
  for (const uint32_t f : faces) {
    Triangle t = triangles[f];
    for (uint32_t& row : t) {
      if (row != kNone) row = static_cast<uint32_t>(std::lower_bound(result.rows.begin(), result.rows.end(), row) - result.rows.begin());
    }
    result.triangles.push_back(t);
  }
  return result;
}

MeshAttribute TakeAttribute(const MeshAttribute& attribute, const Faces& faces) {
  Rows taken = TakeRows(attribute.corners, faces);
  MeshAttribute part{attribute.name, attribute.kind, attribute.components, {}, std::move(taken.triangles)};
  for (const uint32_t row : taken.rows) {
    const float* const values = &attribute.values[size_t{row} * attribute.components];
    part.values.insert(part.values.end(), values, values + attribute.components);
  }
  return part;
}

AttributedMesh SimplifyPart(const AttributedMesh& input, const std::vector<double>& weights, double share, const Faces& faces,
                            const std::vector<uint8_t>& is_shared) {
  AttributedMesh part;
  Rows vertices = TakeRows(input.surface.triangles, faces);
  std::vector<uint8_t> held;
  for (const uint32_t v : vertices.rows) {
    part.surface.positions.push_back(input.surface.positions[v]);
    held.push_back(is_shared[v]);
  }
  part.surface.triangles = std::move(vertices.triangles);
  for (const MeshAttribute& attribute : input.attributes) part.attributes.push_back(TakeAttribute(attribute, faces));
  if (!input.groups.empty()) {
    for (const uint32_t f : faces) part.groups.push_back(input.groups[f]);
  }
  const AttributedSimplification sequence(std::move(part), weights, held);
  return sequence.MeshWith(static_cast<uint32_t>(std::ceil(share * static_cast<double>(faces.size()))));
}

void Append(const std::vector<Triangle>& triangles, uint32_t first_row, std::vector<Triangle>* all) {
  for (Triangle t : triangles) {
    for (uint32_t& row : t) row = row == kNone ? kNone : first_row + row;
    all->push_back(t);
  }
}

void Append(const AttributedMesh& part, AttributedMesh* all) {
  Append(part.surface.triangles, static_cast<uint32_t>(all->surface.positions.size()), &all->surface.triangles);
  all->surface.positions.insert(all->surface.positions.end(), part.surface.positions.begin(), part.surface.positions.end());
  all->groups.insert(all->groups.end(), part.groups.begin(), part.groups.end());
  for (size_t a = 0; a < part.attributes.size(); ++a) {
    Append(part.attributes[a].corners, all->attributes[a].num_values(), &all->attributes[a].corners);
    all->attributes[a].values.insert(all->attributes[a].values.end(), part.attributes[a].values.begin(), part.attributes[a].values.end());
  }
}

}  // namespace

AttributedMesh SimplifyInParts(const AttributedMesh& input, const std::vector<double>& weights, double share, uint32_t part_triangles) {
  Faces all_faces(input.surface.triangles.size());
  for (uint32_t f = 0; f < all_faces.size(); ++f) all_faces[f] = f;
  std::vector<Faces> parts;
  CutIntoParts(input.surface, std::move(all_faces), std::max(part_triangles, 1u), &parts);
  const std::vector<uint8_t> is_shared = FindShared(input.surface, parts);
  std::vector<AttributedMesh> simplified(parts.size());
  tbb::parallel_for(tbb::blocked_range<size_t>(0, parts.size(), 1), [&](const tbb::blocked_range<size_t>& range) {
    for (size_t p = range.begin(); p != range.end(); ++p) simplified[p] = SimplifyPart(input, weights, share, parts[p], is_shared);
  });
  AttributedMesh result;
  for (const MeshAttribute& attribute : input.attributes) result.attributes.push_back({attribute.name, attribute.kind, attribute.components, {}, {}});
  for (AttributedMesh& part : simplified) Append(std::exchange(part, {}), &result);
  WeldExactly(&result);
  return result;
}

}  // namespace lacerta
