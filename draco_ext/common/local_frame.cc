#include "common/local_frame.h"

#include <array>
#include <cmath>

namespace lacerta {
namespace {

// area: the area vectors around, added up.
Vec3f NormalOf(const Vec3f& area) {
  const Vec3f normal = Normalized(area);
  return normal == Vec3f{} ? Vec3f{0, 0, 1} : normal;
}

}  // namespace

Vec3f AnyOrthogonal(const Vec3f& n) {
  const float x = std::fabs(n.x), y = std::fabs(n.y), z = std::fabs(n.z);
  const Vec3f axis = x <= y && x <= z ? Vec3f{1, 0, 0} : y <= z ? Vec3f{0, 1, 0} : Vec3f{0, 0, 1};
  return Normalized(axis - n * Dot(axis, n));
}

LocalFrame FrameWithNormal(const Topology& coarse, Span<const Vec3f> positions, uint32_t edge, const Vec3f& normal) {
  LocalFrame frame;
  frame.normal = normal;
  const Vec3f along = Normalized(positions[coarse.edges[edge][1]] - positions[coarse.edges[edge][0]]);
  const Vec3f tangent = along - frame.normal * Dot(along, frame.normal);
  frame.tangent1 = SquaredNorm(tangent) > 1e-6f ? Normalized(tangent) : AnyOrthogonal(frame.normal);
  // Once more: the first pass leaves 1e-4 along the normal where the edge was nearly parallel to it.
  frame.tangent1 = Normalized(frame.tangent1 - frame.normal * Dot(frame.tangent1, frame.normal));
  frame.tangent2 = Cross(frame.normal, frame.tangent1);
  return frame;
}

std::vector<Vec3f> FrameNormals(const Topology& coarse, Span<const Vec3f> positions, Span<const Vec3f> midpoints) {
  std::vector<Vec3f> normals(coarse.num_edges());  // area vectors around, at first
  for (uint32_t f = 0; f < coarse.num_faces(); ++f) {
    const SplitFace split(coarse, positions, midpoints, f);
    const Vec3f middle = split.InMiddle();
    const std::array<Vec3f, 3> corners = {split.AtCorner(0), split.AtCorner(1), split.AtCorner(2)};
    for (size_t k = 0; k < 3; ++k) normals[coarse.face_edges[f][k]] += middle + corners[(k + 1) % 3] + corners[(k + 2) % 3];
  }
  for (Vec3f& n : normals) n = NormalOf(n);
  return normals;
}

Vec3f FrameNormalAt(const Topology& coarse, Span<const Vec3f> positions, Span<const Vec3f> midpoints, uint32_t edge) {
  Vec3f area;
  for (const uint32_t face : coarse.edge_faces[edge]) {
    if (face == kNone) continue;
    const SplitFace split(coarse, positions, midpoints, face);
    const int k = EdgeCorner(coarse, face, edge);
    area += split.InMiddle() + split.AtCorner((k + 1) % 3) + split.AtCorner((k + 2) % 3);
  }
  return NormalOf(area);
}

std::vector<LocalFrame> ComputeLocalFrames(const Topology& coarse, const std::vector<Vec3f>& positions,
                                           const std::vector<Vec3f>& midpoints) {
  const std::vector<Vec3f> normals = FrameNormals(coarse, positions, midpoints);
  std::vector<LocalFrame> frames;
  frames.reserve(coarse.num_edges());
  for (uint32_t e = 0; e < coarse.num_edges(); ++e) frames.push_back(FrameWithNormal(coarse, positions, e, normals[e]));
  return frames;
}

}  // namespace lacerta
