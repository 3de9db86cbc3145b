// The components of a surface that are not remeshed, as they stand in the base mesh of a stream.
#ifndef LACERTA_DRACO_STILL_PART_H_
#define LACERTA_DRACO_STILL_PART_H_

#include <cstdint>

#include "lacerta/mesh.h"

namespace lacerta {

struct StillPart {
  TriangleMesh mesh;                // an oriented manifold; may be empty
  uint64_t hidden_components = 0;   // left out: they lie on the refined surface, nearer than can be told at that distance
};

// still: components apart from each other; refined: the surface beside them. distance: d_S that the stream is to have, model
// units. Components are simplified until their own distance to `still` is about that; what lies within half of it of the refined
// surface would not be seen and is left out.
StillPart PrepareStillPart(const TriangleMesh& still, const TriangleMesh& refined, double distance);

}  // namespace lacerta

#endif  // LACERTA_DRACO_STILL_PART_H_
