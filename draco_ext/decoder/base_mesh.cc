#include <cmath>
#include <string>

#include "common/stream_layout.h"
#include "lacerta/decoder.h"

namespace lacerta {

TriangleMesh BaseMesh::ToMesh() const {
  TriangleMesh mesh;
  mesh.positions.reserve(lattice.size());
  for (const auto& [x, y, z] : lattice) {
    mesh.positions.push_back(Vec3f{static_cast<float>(x), static_cast<float>(y), static_cast<float>(z)} * step);
  }
  mesh.triangles = triangles;
  return mesh;
}

StatusOr<BaseMesh> BaseMeshFromPositions(const TriangleMesh& mesh, float step) {
  if (!(step > 0) || !std::isnormal(step)) return InvalidArgument("the step of a base mesh must be a positive number");
  BaseMesh base;
  base.step = step;
  base.triangles = mesh.triangles;
  base.lattice.reserve(mesh.positions.size());
  for (size_t v = 0; v < mesh.positions.size(); ++v) {
    std::array<int32_t, 3> point;
    for (int axis = 0; axis < 3; ++axis) {
      const double exact = static_cast<double>(mesh.positions[v][axis]) / step;
      const double value = std::nearbyint(exact);
      if (!(std::fabs(value) <= kMaxLatticeValue) || std::fabs(exact - value) > 0.25) {
        // Without the step: printing a float would be a seventh of the decoder in WebAssembly.
        return InvalidData("vertex " + std::to_string(v) +
                           " of the base mesh is off its lattice: the base was edited, or it is not the one of this refinement");
      }
      point[axis] = static_cast<int32_t>(value);
    }
    base.lattice.push_back(point);
  }
  return base;
}

}  // namespace lacerta
