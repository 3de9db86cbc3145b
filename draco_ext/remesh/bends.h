// How much a surface bends at its edges and beside them.
#ifndef LACERTA_REMESH_BENDS_H_
#define LACERTA_REMESH_BENDS_H_

#include <cstdint>
#include <vector>

#include "common/subdivision.h"
#include "lacerta/mesh.h"

namespace lacerta {

// #E, angle in radians between the unit normals of the two faces of each edge, in [0, pi]; 0 on the border and at faces
// without area.
std::vector<double> EdgeBends(const TriangleMesh& mesh, const Topology& topology);

// What the surface bends beside an edge: the bends of the edges that a walk away from its middle crosses, at right
// angles to it, on both sides; each counts as far as it runs along with the edge. The walk goes one and a half times as
// far as the face beside the edge is high, so that the next row of a rounded edge counts, and crosses 8 edges at most.
double BendBeside(const TriangleMesh& mesh, const Topology& topology, const std::vector<double>& bends, uint32_t edge);

}  // namespace lacerta

#endif  // LACERTA_REMESH_BENDS_H_
