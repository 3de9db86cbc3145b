// Assets in two halves that touch, packed as progressive streams, for tests of what skins and morph targets do to them.
#ifndef LACERTA_TESTS_GLTF_HALVED_STREAM_H_
#define LACERTA_TESTS_GLTF_HALVED_STREAM_H_

#include <algorithm>
#include <optional>
#include <set>
#include <tuple>
#include <vector>

#include "document/gltf_document.h"
#include "lacerta/gltf.h"
#include "lacerta/parsed_gltf.h"
#include "shapes/attributed_shapes.h"

namespace lacerta::testing {

inline PackResult PackFast(const Bytes& asset, LevelChoice levels) {
  PackOptions options;
  options.encode.levels = levels;
  options.encode.effort = Effort::kFast;
  return PackGltf(asset, options).value();
}

inline uint64_t BytesOfHalves(const PackResult& packed) {
  return packed.report.primitives[0].bytes_after + packed.report.primitives[1].bytes_after;
}

inline Bytes UnpackedAt(const Bytes& glb, std::optional<int> level) {
  UnpackOptions options;
  options.level = level;
  return UnpackGltf(glb, options).value().glb;
}

inline std::vector<RefinedGeometry> RefinedBy(const Bytes& glb) {
  const GltfDocument document = ParseGltf(glb, "").value();
  std::vector<Span<const uint8_t>> buffers;
  for (const Bytes& buffer : document.buffers) buffers.emplace_back(buffer);
  return RefineParsedGltf(document.json.dump(), buffers, {}).value();
}

inline TriangleMesh Both(TriangleMesh first, const TriangleMesh& second) {
  const auto offset = static_cast<uint32_t>(first.positions.size());
  first.positions.insert(first.positions.end(), second.positions.begin(), second.positions.end());
  for (const Triangle& t : second.triangles) first.triangles.push_back({t[0] + offset, t[1] + offset, t[2] + offset});
  return first;
}

// Points that are vertices of both, bit by bit.
inline size_t NumSharedPoints(const TriangleMesh& first, const TriangleMesh& second) {
  const auto points_of = [](const TriangleMesh& mesh) {
    std::set<std::tuple<float, float, float>> points;
    for (const Vec3f& p : mesh.positions) points.insert({p.x, p.y, p.z});
    return points;
  };
  const auto of_first = points_of(first), of_second = points_of(second);
  return static_cast<size_t>(
      std::count_if(of_first.begin(), of_first.end(), [&](const auto& p) { return of_second.count(p) > 0; }));
}

inline void DropNormals(VertexSoup* soup) {
  std::vector<VertexSoup::Attribute>& attributes = soup->attributes;
  attributes.erase(std::remove_if(attributes.begin(), attributes.end(),
                                  [](const VertexSoup::Attribute& a) { return a.name == "NORMAL"; }),
                   attributes.end());
}

}  // namespace lacerta::testing

#endif  // LACERTA_TESTS_GLTF_HALVED_STREAM_H_
