#include "remesh/bends.h"

#include <cmath>

namespace lacerta {
namespace {

constexpr double kReach = 1.5;    // in heights of the first face
constexpr int kMaxCrossings = 8;  // bounds the walk among slivers

Vec3d At(const TriangleMesh& mesh, uint32_t v) { return Vec3Cast<double>(mesh.positions[v]); }

}  // namespace

std::vector<double> EdgeBends(const TriangleMesh& mesh, const Topology& topology) {
  std::vector<Vec3d> normals(topology.num_faces());
  for (uint32_t f = 0; f < topology.num_faces(); ++f) {
    const Triangle& t = topology.triangles[f];
    normals[f] = Normalized(Cross(At(mesh, t[1]) - At(mesh, t[0]), At(mesh, t[2]) - At(mesh, t[0])));
  }
  std::vector<double> bends(topology.num_edges(), 0.0);
  for (uint32_t e = 0; e < topology.num_edges(); ++e) {
    if (topology.is_border(e)) continue;
    const Vec3d &a = normals[topology.edge_faces[e][0]], &b = normals[topology.edge_faces[e][1]];
    bends[e] = std::atan2(Norm(Cross(a, b)), Dot(a, b));  // 0 where one is zero
  }
  return bends;
}

double BendBeside(const TriangleMesh& mesh, const Topology& topology, const std::vector<double>& bends, uint32_t edge) {
  const Vec3d start = At(mesh, topology.edges[edge][0]), end = At(mesh, topology.edges[edge][1]);
  const Vec3d along = Normalized(end - start), middle = (start + end) * 0.5;
  const auto height = [&](uint32_t v) { return Dot(At(mesh, v) - middle, along); };  // above the plane of the walk
  double sum = 0;
  for (const uint32_t first_face : topology.edge_faces[edge]) {
    uint32_t face = first_face, crossed = edge, below = topology.edges[edge][0], above = topology.edges[edge][1];
    Vec3d at = middle;
    double left = 0;
    for (int i = 0; i < kMaxCrossings && face != kNone; ++i) {
      const uint32_t opposite = OppositeVertex(topology, face, crossed);
      if (i == 0) left = kReach * Norm(Cross(At(mesh, opposite) - start, along));
      const bool replaces_above = height(opposite) >= 0;
      const uint32_t behind = replaces_above ? above : below;  // the vertex that the next edge does not have
      (replaces_above ? above : below) = opposite;
      const Triangle& t = topology.triangles[face];
      const uint32_t next = topology.face_edges[face][t[0] == behind ? 0 : t[1] == behind ? 1 : 2];
      const Vec3d p = At(mesh, below), q = At(mesh, above);
      const double hp = height(below), hq = height(above);
      const Vec3d crossing = hq > hp ? p + (q - p) * (-hp / (hq - hp)) : p;
      left -= Norm(crossing - at);
      if (left < 0) break;
      sum += bends[next] * std::abs(Dot(Normalized(q - p), along));
      face = FaceAcross(topology, face, next);
      crossed = next;
      at = crossing;
    }
  }
  return sum;
}

}  // namespace lacerta
