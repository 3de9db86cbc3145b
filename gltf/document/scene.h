// Where the meshes of the default scene stand in the world.
#ifndef LACERTA_DOCUMENT_SCENE_H_
#define LACERTA_DOCUMENT_SCENE_H_

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "document/gltf_document.h"
#include "lacerta/mesh.h"
#include "lacerta/status.h"

namespace lacerta {

// Column-major 3 x 4: a point goes to m[0..2] * x + m[3..5] * y + m[6..8] * z + m[9..11].
using Transform = std::array<double, 12>;
inline constexpr Transform kIdentity = {1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};

Vec3d Apply(const Transform& m, const Vec3d& p);
Transform Multiply(const Transform& a, const Transform& b);  // b first
double Determinant(const Transform& m);
// Of the images of the three axes the length of the longest: what errors grow by, but for shear.
double LargestStretch(const Transform& m);

// What a node says of where it stands under its parent, in the parts that animations set.
struct NodePlacement {
  std::array<double, 3> translation = {0, 0, 0};
  std::array<double, 4> rotation = {0, 0, 0, 1};  // unit quaternion x, y, z, w
  std::array<double, 3> scale = {1, 1, 1};
};
NodePlacement ReadPlacement(const Json& node);  // of one without matrix
Transform ToTransform(const NodePlacement& placement);
Transform LocalTransform(const Json& node);

struct Instance {
  uint64_t mesh = 0;
  Transform transform = kIdentity;  // of the node; what a skin moves stands elsewhere
  std::optional<uint64_t> skin = std::nullopt;
};

// The meshes that the default scene shows (the first scene where none is named; every mesh once where there is no
// scene). Fails with kInvalidData on nodes that do not exist or form a loop.
StatusOr<std::vector<Instance>> CollectInstances(const GltfDocument& document);

}  // namespace lacerta

#endif  // LACERTA_DOCUMENT_SCENE_H_
