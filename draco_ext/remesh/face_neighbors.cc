#include "remesh/face_neighbors.h"

#include <algorithm>
#include <array>
#include <utility>

#include "common/subdivision.h"
#include "remesh/edge_pairing.h"
#include "remesh/parity_forest.h"

namespace lacerta {
namespace {

using CornerPair = std::pair<uint32_t, uint32_t>;

double Area(const TriangleMesh& mesh, uint32_t face) {
  Vec3d p[3];
  for (int k = 0; k < 3; ++k) p[k] = Vec3Cast<double>(mesh.positions[mesh.triangles[face][k]]);
  return 0.5 * Norm(Cross(p[1] - p[0], p[2] - p[0]));
}

// Makes the pairs neighbors that can agree in orientation with all made so far. Those that agree already, given who
// counts as flipped, go first: what cannot be joined in the end is then what disagreed.
void JoinPairs(const TriangleMesh& mesh, const std::vector<CornerPair>& pairs, const std::vector<uint8_t>& flipped,
               ParityForest* forest, std::vector<uint32_t>* mate) {
  for (const bool agreeing : {true, false}) {
    for (const auto& [c, d] : pairs) {
      const bool same_direction = StartOfEdge(mesh.triangles, c) == StartOfEdge(mesh.triangles, d);
      const bool one_flipped = flipped[c / 3] != flipped[d / 3];
      if ((same_direction == one_flipped) != agreeing || !forest->Join(c / 3, d / 3, same_direction ? 1 : 0)) continue;
      (*mate)[c] = d;
      (*mate)[d] = c;
    }
  }
}

// Of the two ways round in every set, the faces of the one with less area; less faces or without the first one in a
// tie.
std::vector<uint8_t> Minority(const TriangleMesh& mesh, ParityForest* forest) {
  const auto num_faces = static_cast<uint32_t>(mesh.triangles.size());
  std::vector<std::array<double, 2>> area(num_faces);
  std::vector<std::array<uint32_t, 2>> count(num_faces);
  std::vector<uint8_t> first(num_faces, 0), lesser(num_faces, 0);
  for (uint32_t f = 0; f < num_faces; ++f) {
    const auto [root, parity] = forest->Find(f);
    if (count[root][0] + count[root][1] == 0) first[root] = parity;
    area[root][parity] += Area(mesh, f);
    ++count[root][parity];
  }
  for (uint32_t r = 0; r < num_faces; ++r) {
    const uint8_t other = first[r] ^ 1;
    const bool less = area[r][first[r]] < area[r][other] ||
                      (area[r][first[r]] == area[r][other] && count[r][first[r]] < count[r][other]);
    lesser[r] = less ? first[r] : other;
  }
  std::vector<uint8_t> flipped(num_faces);
  for (uint32_t f = 0; f < num_faces; ++f) {
    const auto [root, parity] = forest->Find(f);
    flipped[f] = parity == lesser[root];
  }
  return flipped;
}

// Whether three large sheets or more meet at an edge and pairs leave one of them alone: those that went on in each other would move away from
// its border.
bool LeaveALargeSheet(Span<const uint32_t> corners, const std::vector<CornerPair>& pairs, ParityForest* sheets) {
  constexpr uint32_t kLarge = 500;  // faces; smaller ones are no surfaces to refine, but flaps on those that are
  const auto is_large = [&](uint32_t c) { return sheets->SizeOf(c / 3) >= kLarge; };
  const auto is_alone = [&](uint32_t c) {
    return std::none_of(pairs.begin(), pairs.end(), [&](const CornerPair& pair) { return pair.first == c || pair.second == c; });
  };
  return std::count_if(corners.begin(), corners.end(), is_large) > 2 &&
         std::any_of(corners.begin(), corners.end(), [&](uint32_t c) { return is_large(c) && is_alone(c); });
}

}  // namespace

FaceNeighbors FindNeighbors(const TriangleMesh& mesh, const EdgeCorners& edges) {
  FaceNeighbors result;
  result.mate.assign(mesh.triangles.size() * 3, kNone);
  ParityForest forest(mesh.triangles.size());
  std::vector<CornerPair> pairs;
  for (uint32_t e = 0; e < edges.num_edges(); ++e) {
    const Span<const uint32_t> corners = edges.of(e);
    if (corners.size() != 2 || SameVertices(mesh.triangles[corners[0] / 3], mesh.triangles[corners[1] / 3])) continue;
    pairs.emplace_back(corners[0], corners[1]);
  }
  JoinPairs(mesh, pairs, std::vector<uint8_t>(mesh.triangles.size(), 0), &forest, &result.mate);
  // Where more than two faces meet, their orientation says who belongs together: so strays within the sheets are turned
  // first.
  const std::vector<uint8_t> within_sheets = Minority(mesh, &forest);
  pairs.clear();
  for (uint32_t e = 0; e < edges.num_edges(); ++e) {
    if (edges.of(e).size() <= 2) continue;
    const std::vector<CornerPair> around = PairAroundEdge(mesh, within_sheets, edges.of(e));
    if (LeaveALargeSheet(edges.of(e), around, &forest)) continue;
    pairs.insert(pairs.end(), around.begin(), around.end());
  }
  JoinPairs(mesh, pairs, within_sheets, &forest, &result.mate);
  result.flipped = Minority(mesh, &forest);
  return result;
}

}  // namespace lacerta
