#include "remesh/vertex_fans.h"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "common/subdivision.h"
#include "remesh/edge_pairing.h"

namespace lacerta {
namespace {

constexpr uint32_t kMaxFanFaces = 65534;  // an open fan has one edge more, and Topology counts edges in 16 bits

// Returns whether there was anything to cut.
bool Cut(uint32_t corner, std::vector<uint32_t>* mate) {
  const uint32_t other = (*mate)[corner];
  if (other == kNone) return false;
  (*mate)[corner] = (*mate)[other] = kNone;
  return true;
}

// Numbers the fans, in order of their first corners, and cuts those that are too large. Sets *cut then: numbers are
// stale.
VertexFans NumberFans(const TriangleMesh& mesh, std::vector<uint32_t>* mate, bool* cut) {
  VertexFans fans;
  fans.vertex.assign(mate->size(), kNone);
  fans.source.resize(mesh.positions.size());
  std::iota(fans.source.begin(), fans.source.end(), 0u);
  std::vector<bool> taken(mesh.positions.size(), false);
  for (uint32_t corner = 0; corner < mate->size(); ++corner) {
    if (fans.vertex[corner] != kNone) continue;
    const uint32_t old_vertex = VertexOf(mesh.triangles, corner);
    uint32_t number = old_vertex;
    if (taken[old_vertex]) {
      number = static_cast<uint32_t>(fans.source.size());
      fans.source.push_back(old_vertex);
    }
    taken[old_vertex] = true;
    fans.vertex[corner] = number;
    uint32_t num_faces = 1;
    for (const bool forward : {true, false}) {
      for (uint32_t at = corner;;) {
        const uint32_t side = forward ? NextCorner(at) : PreviousCorner(at);
        const uint32_t across = (*mate)[side];
        if (across == kNone) break;
        const uint32_t next = forward ? NextCorner(across) : PreviousCorner(across);
        if (fans.vertex[next] != kNone) break;  // all the way round
        if (num_faces == kMaxFanFaces) {
          *cut |= Cut(side, mate);
          break;
        }
        fans.vertex[next] = number;
        ++num_faces;
        at = next;
      }
    }
  }
  return fans;
}

struct Side {  // one edge of the new mesh
  uint32_t low, high;
  bool border;
  uint32_t corner;
  bool operator<(const Side& o) const {
    return std::tie(low, high, border, corner) < std::tie(o.low, o.high, o.border, o.corner);
  }
};

// Gives the face of `corner`, with its mate there, a vertex of its own at the start of the edge.
bool Detach(uint32_t corner, std::vector<uint32_t>* mate) {
  const uint32_t other = (*mate)[corner];
  bool cut = Cut(PreviousCorner(corner), mate);
  if (other != kNone) cut |= Cut(NextCorner(other), mate);
  return cut;
}

// Parts edges of one old edge that have the same new vertices. Returns whether anything was changed.
bool PartEdges(const TriangleMesh& mesh, const EdgeCorners& edges, const VertexFans& fans, bool may_rejoin,
               std::vector<uint32_t>* mate) {
  bool changed = false;
  const std::vector<uint8_t> none_flipped(may_rejoin ? mesh.triangles.size() : 0, 0);
  std::vector<Side> sides;
  for (uint32_t e = 0; e < edges.num_edges(); ++e) {
    const Span<const uint32_t> corners = edges.of(e);
    if (corners.size() == 1 || (corners.size() == 2 && (*mate)[corners[0]] != kNone)) continue;
    sides.clear();
    for (const uint32_t c : corners) {
      if ((*mate)[c] != kNone && (*mate)[c] < c) continue;
      const uint32_t a = fans.vertex[NextCorner(c)], b = fans.vertex[PreviousCorner(c)];
      sides.push_back({std::min(a, b), std::max(a, b), (*mate)[c] == kNone, c});
    }
    std::sort(sides.begin(), sides.end());
    for (size_t begin = 0, end; begin < sides.size(); begin = end) {
      for (end = begin + 1;
           end < sides.size() && sides[end].low == sides[begin].low && sides[end].high == sides[begin].high;)
        ++end;
      if (end - begin == 2 && sides[begin].border && may_rejoin) {
        const uint32_t c = sides[begin].corner, d = sides[begin + 1].corner;
        const std::vector<uint32_t> both = {c, d};
        if (StartOfEdge(mesh.triangles, c) != StartOfEdge(mesh.triangles, d) &&
            !PairAroundEdge(mesh, none_flipped, both).empty()) {
          (*mate)[c] = d;
          (*mate)[d] = c;
          changed = true;
          continue;
        }
      }
      for (size_t i = begin + 1; i < end; ++i) changed |= Detach(sides[i].corner, mate);
    }
  }
  return changed;
}

}  // namespace

VertexFans SplitVertices(const TriangleMesh& mesh, const EdgeCorners& edges, std::vector<uint32_t>* mate) {
  // Cutting alone never makes two edges alike, so this ends: the second round detaches whatever the first left, and
  // further ones only happen with fans that are too large.
  for (bool may_rejoin = true;; may_rejoin = false) {
    bool cut = false;
    VertexFans fans = NumberFans(mesh, mate, &cut);
    if (cut) continue;
    if (!PartEdges(mesh, edges, fans, may_rejoin, mate)) return fans;
  }
}

}  // namespace lacerta
