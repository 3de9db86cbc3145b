// The search for the fewest bytes among the ways in which stock Draco can code one mesh by edgebreaker.
#ifndef LACERTA_DRACO_SMALLEST_STREAM_H_
#define LACERTA_DRACO_SMALLEST_STREAM_H_

#include <cstdint>

#include "draco/stock_stream.h"
#include "lacerta/mesh.h"
#include "lacerta/status.h"

namespace lacerta {

// One way to code a mesh, and what came out of it.
struct StockAttempt {
  StockSettings settings;
  uint32_t first_triangle = 0;  // where edgebreaker starts: corner `first_corner` of this triangle
  uint32_t first_corner = 0;
  Bytes stream;
};

// Tries Draco's settings, then, on a small mesh, other starting triangles; deterministic.
//   mesh  positions are integers 0 .. 2^bits - 1 held as floats (EncodeIntegerPositions); must pass CheckEncodable
// Fails where Draco refuses the mesh.
StatusOr<StockAttempt> SmallestEdgebreakerStream(const TriangleMesh& mesh, int bits);

// `mesh` with the triangles in the order in which `attempt` gives them to Draco.
TriangleMesh StartingAsIn(const StockAttempt& attempt, const TriangleMesh& mesh);

}  // namespace lacerta

#endif  // LACERTA_DRACO_SMALLEST_STREAM_H_
