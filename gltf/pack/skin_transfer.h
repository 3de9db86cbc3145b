// Joints and weights for a simplified surface, from where its vertices lie on the original.
#ifndef LACERTA_PACK_SKIN_TRANSFER_H_
#define LACERTA_PACK_SKIN_TRANSFER_H_

#include <map>
#include <memory>
#include <vector>

#include "geometry/group_surface.h"
#include "lacerta/attributed_mesh.h"
#include "lacerta/status.h"
#include "pack/family_meter.h"
#include "pack/skin.h"

namespace lacerta {

class SkinTransfer {
 public:
  // The influences of a vertex by what SplitIntoSoups keeps of it: its position and its poses.
  using Key = std::vector<float>;
  using ByVertex = std::map<Key, Influences>;

  // Refers to the meter, which has a skin and is OK. Fails like ReadInfluences.
  static StatusOr<SkinTransfer> Create(const FamilyMeter& meter);

  // Gives every vertex of the mesh, a simplification of FamilyMeter::original, the weights of the point of the original
  // that is closest, interpolated over all joints, of which the four largest are kept with the sum 1; where skins meet
  // at a vertex, on the side whose poses are nearest. Sets its poses to what follows from them.
  ByVertex Transfer(AttributedMesh* mesh) const;

  // The key of a vertex; `poses`: of Skin::poses.
  static Key KeyOf(const Vec3f& position, const float* poses, size_t num_poses);

 private:
  explicit SkinTransfer(const FamilyMeter& meter);

  Influences At(uint32_t group, const Vec3f& position, const Vec3d& normal, const float* poses, uint32_t* hint) const;
  Influences Interpolate(const GroupSurface::Point& point) const;

  const FamilyMeter* meter_;
  const MeshAttribute* poses_;  // of the original
  std::unique_ptr<const GroupSurface> surface_;
  std::vector<VertexInfluences> influences_;  // of the primitives
  std::vector<uint32_t> face_in_group_;       // of every face of the original
};

}  // namespace lacerta

#endif  // LACERTA_PACK_SKIN_TRANSFER_H_
