// Remeshing of an irregular surface to a normal mesh [Guskov et al. 2000].
#ifndef LACERTA_REMESH_H_
#define LACERTA_REMESH_H_

#include <cstdint>
#include <vector>

#include "lacerta/mesh.h"

namespace lacerta {

// How the position of a fine vertex was found.
enum class PiercingKind : uint8_t {
  kNormal,      // where the normal line through the predicted position pierces the surface
  kClosest,     // the surface point closest to the predicted position: piercing was not sound
  kParametric,  // the surface point at the middle of its edge in the parametrization: nothing else was sound
  kCurve,       // on a border or crease: where the plane across the edge at the predicted position meets the curve
};

// A remeshed surface: the semi-regular mesh with what the encoder wants to know about the input at its vertices.
struct NormalMesh {
  SemiRegularMesh mesh;
  std::vector<Vec3f> surface_normals;   // #V, unit normal of the input at each vertex
  std::vector<PiercingKind> piercing;   // #V - #V0, of the vertices above the base, in order
  // The vertices are the input's own and have to come back where they are, not just somewhere on the surface.
  bool keeps_vertices = false;
};

// Share of the vertices above the base, those on curves aside, that lie on their normal line; 1 where there are none.
double NormalShare(const NormalMesh& mesh);

}  // namespace lacerta

#endif  // LACERTA_REMESH_H_
