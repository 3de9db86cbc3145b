// Streams without refinement: a mesh as a stock Draco stream of its positions. For whatever cannot be remeshed.
#ifndef LACERTA_DRACO_ZERO_LEVEL_H_
#define LACERTA_DRACO_ZERO_LEVEL_H_

#include "draco/base_coding.h"
#include "draco/position_stream.h"
#include "lacerta/mesh.h"
#include "lacerta/status.h"
#include "remesh/lattice_fit.h"

namespace lacerta {

struct CodedZeroLevel {
  Bytes stream;             // bitstream version 2.2, or a compact base
  TriangleMesh mesh;        // what a decoder gets, in its order
  bool sequential = false;  // edgebreaker would have changed the surface
  BaseCoding coding = BaseCoding::kStock;
};

enum class CodingEffort {
  kQuick,  // one of Draco's settings, within a few percent of
  kFull,   // the smallest of them
};

// Codes any mesh, manifold or not: positions are rounded to 2^bits - 1 steps along the longest side of the bounding box
// (1 <= bits <= 24), so that each is off by at most half a step in every coordinate. The triangles are kept as a set
// with their orientations, one to one, with degenerate ones and duplicates; vertices may come back in another order,
// split where the mesh is not manifold, and without those of no triangle. The smallest of Draco's settings is taken;
// edgebreaker first, sequential only where that does not keep the triangles. Fails with kInvalidArgument on a bad
// number of bits, with kInvalidData on what CheckEncodable refuses and on a bounding box that does not fit a float.
StatusOr<CodedZeroLevel> EncodeZeroLevel(const TriangleMesh& mesh, int bits);

// The same for a mesh on a lattice of any step: the decoder's step is that one but for rounding. Fails with kInvalidData on a
// lattice that spans more than 22 bits too. coding: kCompact gives a compact base, cut where the mesh is no manifold, and a stock
// stream where triangles are degenerate or disagree with their neighbors or a vertex has none.
StatusOr<CodedZeroLevel> EncodeLatticeMesh(const LatticeMesh& mesh, CodingEffort effort, BaseCoding coding = BaseCoding::kStock);

// The order of the smallest stock stream found for this mesh. Fails where there is none that keeps its triangles but a sequential one.
StatusOr<PositionStream> SmallestOrder(const LatticeMesh& mesh);

// In that order. mesh: the one of SmallestOrder but for its points, origin and step.
StatusOr<CodedZeroLevel> EncodeInOrder(const PositionStream& order, const LatticeMesh& mesh);

}  // namespace lacerta

#endif  // LACERTA_DRACO_ZERO_LEVEL_H_
