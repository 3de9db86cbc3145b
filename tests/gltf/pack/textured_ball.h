// A primitive with a texture for tests of rounding.
#ifndef LACERTA_TESTS_GLTF_PACK_TEXTURED_BALL_H_
#define LACERTA_TESTS_GLTF_PACK_TEXTURED_BALL_H_

#include <vector>

#include "decoder/smooth_normals.h"
#include "document/primitive.h"
#include "gltf/test_assets.h"

namespace lacerta::testing {

// A ball with a texture that goes `repeats` times around it, to and fro from one vertex to the next, so that no values make up for vertices that slide.
inline Primitive TexturedBall(float repeats) {
  const TriangleMesh mesh = WavySphere(48, 72);
  Primitive primitive;
  primitive.num_vertices = mesh.positions.size();
  primitive.triangles = mesh.triangles;
  std::vector<float> texture;
  for (size_t v = 0; v < mesh.positions.size(); ++v) {
    const Vec3f& p = mesh.positions[v];
    const float fro = v % 2 == 0 ? 0.1f : 0.0f;
    texture.insert(texture.end(), {repeats * (p.x + fro), repeats * (p.y - fro)});
  }
  primitive.attributes = {{"POSITION", MakeFloatAccessor(mesh.positions)},
                          {"NORMAL", MakeFloatAccessor(SmoothNormals(mesh.positions, mesh.triangles))},
                          {"TEXCOORD_0", MakeFloatAccessor(texture, 2)}};
  return primitive;
}

}  // namespace lacerta::testing

#endif  // LACERTA_TESTS_GLTF_PACK_TEXTURED_BALL_H_
