// Skinned primitives: which joints move their vertices, and where they are in poses (linear blend skinning).
#ifndef LACERTA_PACK_SKIN_H_
#define LACERTA_PACK_SKIN_H_

#include <cstdint>
#include <string>
#include <vector>

#include "document/primitive.h"
#include "document/scene.h"
#include "lacerta/mesh.h"
#include "lacerta/status.h"

namespace lacerta {

struct Influence {
  uint32_t joint = 0;
  float weight = 0.0f;
};
using Influences = std::vector<Influence>;  // by ascending joint, none twice, no weight 0

// Of all vertices, one after the other.
struct VertexInfluences {
  std::vector<uint32_t> first;  // #V + 1
  Influences all;

  Span<const Influence> Of(uint64_t vertex) const {
    return {all.data() + first[vertex], first[vertex + 1] - first[vertex]};
  }
};

// JOINTS_n or WEIGHTS_n.
bool IsSkinAttribute(const std::string& name);

// Equal joints added up. Fails with kUnsupported where sets are not in pairs or not of the types of glTF, a joint is
// not below num_joints, or a weight is below 0 or not finite.
StatusOr<VertexInfluences> ReadInfluences(const Primitive& primitive, size_t num_joints);

// The joints of a skin in poses: matrices that take a vertex of the mesh to where it is then, scaled back to mesh
// units, and up to the size of the mesh where the pose is smaller.
struct Skin {
  size_t num_joints = 0;
  std::vector<std::vector<Transform>> poses;  // at least one, each of #joints

  Vec3d Posed(size_t pose, const Vec3d& position, Span<const Influence> influences) const;
  // As an attribute (kPosesName).
  void AppendPoses(const Vec3d& position, Span<const Influence> influences, std::vector<float>* values) const;
};

// The surface of primitives together in a pose. Fails like ReadInfluences.
StatusOr<TriangleMesh> PosedSurface(const std::vector<const Primitive*>& primitives, const Skin& skin, size_t pose);

}  // namespace lacerta

#endif  // LACERTA_PACK_SKIN_H_
