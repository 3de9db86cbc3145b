#include "remesh/simplify_in_parts.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "geometry/bounding_box.h"
#include "lacerta/clean.h"
#include "remesh/attributed_simplify.h"
#include "remesh/simplify.h"

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
  BoundingBox box{SumOfCorners(surface, faces[0]), SumOfCorners(surface, faces[0])};
  for (const uint32_t f : faces) Extend(SumOfCorners(surface, f), &box);
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

// Some faces of a surface as one of its own; *held: its vertices that other parts have too.
TriangleMesh TakeSurface(const TriangleMesh& surface, const Faces& faces, const std::vector<uint8_t>& is_shared, std::vector<uint8_t>* held) {
  TriangleMesh part;
  Rows vertices = TakeRows(surface.triangles, faces);
  for (const uint32_t v : vertices.rows) {
    part.positions.push_back(surface.positions[v]);
    held->push_back(is_shared[v]);
  }
  part.triangles = std::move(vertices.triangles);
  return part;
}

TriangleMesh SimplifyPart(const TriangleMesh& mesh, uint32_t num_triangles, const Faces& faces, const std::vector<uint8_t>& is_shared) {
  SimplificationOptions options;
  const TriangleMesh part = TakeSurface(mesh, faces, is_shared, &options.held);
  return SimplificationSequence(part, options).MeshWith(num_triangles);
}

AttributedMesh SimplifyPart(const AttributedMesh& input, const std::vector<double>& weights, uint32_t num_triangles, const Faces& faces,
                            const std::vector<uint8_t>& is_shared) {
  AttributedMesh part;
  std::vector<uint8_t> held;
  part.surface = TakeSurface(input.surface, faces, is_shared, &held);
  for (const MeshAttribute& attribute : input.attributes) part.attributes.push_back(TakeAttribute(attribute, faces));
  if (!input.groups.empty()) {
    for (const uint32_t f : faces) part.groups.push_back(input.groups[f]);
  }
  return AttributedSimplification(std::move(part), weights, held).MeshWith(num_triangles);
}

// All parts of a surface, each simplified to the share of its triangles that leaves `num_triangles` of all.
//   simplify  (number of triangles, faces, what FindShared returned) -> Part
template <typename Part, typename Simplify>
std::vector<Part> SimplifyParts(const TriangleMesh& surface, uint32_t num_triangles, uint32_t part_triangles, const Simplify& simplify) {
  Faces all_faces(surface.triangles.size());
  std::iota(all_faces.begin(), all_faces.end(), 0u);
  std::vector<Faces> parts;
  CutIntoParts(surface, std::move(all_faces), std::max(part_triangles, 1u), &parts);
  const std::vector<uint8_t> is_shared = FindShared(surface, parts);
  const double share = static_cast<double>(num_triangles) / static_cast<double>(surface.triangles.size());
  std::vector<Part> simplified(parts.size());
  tbb::parallel_for(tbb::blocked_range<size_t>(0, parts.size(), 1), [&](const tbb::blocked_range<size_t>& range) {
    for (size_t p = range.begin(); p != range.end(); ++p) {
      const Faces faces = std::exchange(parts[p], {});
      simplified[p] = simplify(static_cast<uint32_t>(std::ceil(share * static_cast<double>(faces.size()))), faces, is_shared);
    }
  });
  return simplified;
}

// How many triangles are left after each round, `wanted` after the last. None takes away more than four fifths: what the cuts hold would be
// too much of the rest, and gone after the next one, whose cuts are fewer.
std::vector<uint32_t> SizesOfRounds(size_t all, uint32_t wanted) {
  constexpr double kSmallestShare = 0.2;
  const double share = static_cast<double>(std::max(wanted, 1u)) / static_cast<double>(std::max<size_t>(all, 1));
  const int rounds = std::max(1, static_cast<int>(std::ceil(std::log(share) / std::log(kSmallestShare) - 1e-9)));
  std::vector<uint32_t> sizes;
  for (int i = 1; i < rounds; ++i) sizes.push_back(static_cast<uint32_t>(static_cast<double>(all) * std::pow(share, static_cast<double>(i) / rounds)));
  sizes.push_back(wanted);
  return sizes;
}

void Append(const std::vector<Triangle>& triangles, uint32_t first_row, std::vector<Triangle>* all) {
  for (Triangle t : triangles) {
    for (uint32_t& row : t) row = row == kNone ? kNone : first_row + row;
    all->push_back(t);
  }
}

void Append(const TriangleMesh& part, TriangleMesh* all) {
  Append(part.triangles, static_cast<uint32_t>(all->positions.size()), &all->triangles);
  all->positions.insert(all->positions.end(), part.positions.begin(), part.positions.end());
}

void Append(const AttributedMesh& part, AttributedMesh* all) {
  Append(part.surface, &all->surface);
  all->groups.insert(all->groups.end(), part.groups.begin(), part.groups.end());
  for (size_t a = 0; a < part.attributes.size(); ++a) {
    Append(part.attributes[a].corners, all->attributes[a].num_values(), &all->attributes[a].corners);
    all->attributes[a].values.insert(all->attributes[a].values.end(), part.attributes[a].values.begin(), part.attributes[a].values.end());
  }
}

TriangleMesh OneRound(const TriangleMesh& mesh, uint32_t num_triangles, uint32_t part_triangles) {
  std::vector<TriangleMesh> parts = SimplifyParts<TriangleMesh>(
      mesh, num_triangles, part_triangles,
      [&](uint32_t number, const Faces& faces, const std::vector<uint8_t>& is_shared) { return SimplifyPart(mesh, number, faces, is_shared); });
  size_t num_vertices = 0, num_triangles_left = 0;
  for (const TriangleMesh& part : parts) {
    num_vertices += part.positions.size();
    num_triangles_left += part.triangles.size();
  }
  TriangleMesh joined;
  joined.positions.reserve(num_vertices);
  joined.triangles.reserve(num_triangles_left);
  for (TriangleMesh& part : parts) Append(std::exchange(part, {}), &joined);
  return CleanInPlace(&joined).ok() ? joined : TriangleMesh();
}

AttributedMesh OneRound(const AttributedMesh& input, const std::vector<double>& weights, uint32_t num_triangles, uint32_t part_triangles) {
  std::vector<AttributedMesh> parts = SimplifyParts<AttributedMesh>(
      input.surface, num_triangles, part_triangles,
      [&](uint32_t number, const Faces& faces, const std::vector<uint8_t>& is_shared) { return SimplifyPart(input, weights, number, faces, is_shared); });
  AttributedMesh joined;
  for (const MeshAttribute& attribute : input.attributes) joined.attributes.push_back({attribute.name, attribute.kind, attribute.components, {}, {}});
  for (AttributedMesh& part : parts) Append(std::exchange(part, {}), &joined);
  WeldExactly(&joined);
  return joined;
}

}  // namespace

TriangleMesh SimplifyInParts(const TriangleMesh& mesh, uint32_t num_triangles, uint32_t part_triangles) {
  TriangleMesh result;
  for (const uint32_t size : SizesOfRounds(mesh.triangles.size(), num_triangles)) {
    result = OneRound(result.triangles.empty() ? mesh : result, size, part_triangles);
  }
  return result;
}

AttributedMesh SimplifyInParts(const AttributedMesh& input, const std::vector<double>& weights, uint32_t num_triangles, uint32_t part_triangles) {
  AttributedMesh result;
  for (const uint32_t size : SizesOfRounds(input.surface.triangles.size(), num_triangles)) {
    result = OneRound(result.surface.triangles.empty() ? input : result, weights, size, part_triangles);
  }
  return result;
}

}  // namespace lacerta
