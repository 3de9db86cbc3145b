#include "baselines/single_rate.h"

#include <algorithm>
#include <cmath>

#include "common/bit_model.h"
#include "common/coefficient_models.h"
#include "decoder/range_decoder.h"
#include "encoder/compact_base_encoder.h"
#include "encoder/quantizer.h"
#include "encoder/range_encoder.h"

namespace lacerta::baselines {
namespace {

// A face of each vertex whose other two corners are earlier, one with an earlier vertex beyond them where there is any.
std::vector<uint32_t> FacesOfExpectation(const Topology& t) {
  std::vector<uint32_t> faces(t.num_vertices, kNone);
  std::vector<uint8_t> has_parallelogram(t.num_vertices, 0);
  for (uint32_t f = 0; f < t.num_faces(); ++f) {
    const Triangle& tri = t.triangles[f];
    const int k = static_cast<int>(std::max_element(tri.begin(), tri.end()) - tri.begin());
    const uint32_t v = tri[k], edge = t.face_edges[f][k], across = FaceAcross(t, f, edge);
    const bool parallelogram = across != kNone && OppositeVertex(t, across, edge) < v;
    if (faces[v] != kNone && (has_parallelogram[v] || !parallelogram)) continue;
    faces[v] = f;
    has_parallelogram[v] = parallelogram;
  }
  return faces;
}

Point Expect(const Topology& t, uint32_t v, uint32_t f, const std::vector<Point>& points) {
  if (f == kNone) return {};
  const Triangle& tri = t.triangles[f];
  const int k = tri[0] == v ? 0 : tri[1] == v ? 1 : 2;
  const Point &a = points[tri[(k + 1) % 3]], &b = points[tri[(k + 2) % 3]];
  const uint32_t edge = t.face_edges[f][k], across = FaceAcross(t, f, edge);
  if (across == kNone) return a;
  const uint32_t beyond = OppositeVertex(t, across, edge);
  if (beyond >= v) return a;
  const Point& c = points[beyond];
  return {a[0] + b[0] - c[0], a[1] + b[1] - c[1], a[2] + b[2] - c[2]};
}

template <typename Coder>
std::vector<Point> CodePoints(const Topology& t, const std::vector<Point>* truth, Coder* coder) {
  SetModels models;
  const std::vector<uint32_t> faces = FacesOfExpectation(t);
  std::vector<Point> points(t.num_vertices);
  for (uint32_t v = 0; v < t.num_vertices; ++v) {
    const Point expected = Expect(t, v, faces[v], points);
    for (size_t c = 0; c < 3; ++c) {
      const int32_t difference = truth ? (*truth)[v][c] - expected[c] : 0;
      points[v][c] = expected[c] + CodeCoefficient(*coder, models, CoefficientContext(), difference);
    }
  }
  return points;
}

}  // namespace

Bytes EncodeByParallelograms(const Topology& topology, const std::vector<Point>& points) {
  RangeEncoder encoder;
  CodePoints(topology, &points, &encoder);
  return encoder.Finish();
}

std::vector<Point> DecodeByParallelograms(const Topology& topology, Span<const uint8_t> stream) {
  RangeDecoder decoder(stream);
  return CodePoints(topology, nullptr, &decoder);
}

StatusOr<SingleRateMesh> CodeSingleRate(const TriangleMesh& mesh, int bits) {
  if (bits < 1 || bits > 20) return InvalidArgument("positions have 1 to 20 bits");
  Vec3f low = mesh.positions.at(0), high = low;
  for (const Vec3f& p : mesh.positions) {
    for (int c = 0; c < 3; ++c) {
      low[c] = std::min(low[c], p[c]);
      high[c] = std::max(high[c], p[c]);
    }
  }
  const Vec3f size = high - low;
  // About the middle, so that coordinates have that many bits wherever the mesh lies.
  const Vec3f middle = (low + high) * 0.5f;
  TriangleMesh centered = mesh;
  for (Vec3f& p : centered.positions) p -= middle;
  const BaseMesh lattice = RoundToLattice(centered, std::ldexp(std::max({size.x, size.y, size.z}), -bits));
  LACERTA_ASSIGN_OR_RETURN(const CompactBaseBytes grown, EncodeCompactBase(lattice));
  LACERTA_ASSIGN_OR_RETURN(const Topology topology,
                           BuildTopology(static_cast<uint32_t>(grown.mesh.lattice.size()), grown.mesh.triangles));
  const Bytes stream = EncodeByParallelograms(topology, grown.mesh.lattice);
  BaseMesh decoded = grown.mesh;
  decoded.lattice = DecodeByParallelograms(topology, stream);
  SingleRateMesh result = {grown.connectivity_bytes + stream.size(), decoded.ToMesh()};
  for (Vec3f& p : result.mesh.positions) p += middle;
  return result;
}

}  // namespace lacerta::baselines
