// Stock streams of one connectivity, with any positions.
#ifndef LACERTA_DRACO_POSITION_STREAM_H_
#define LACERTA_DRACO_POSITION_STREAM_H_

#include <cstddef>
#include <cstdint>
#include <vector>

#include "common/lattice_point.h"
#include "draco/predictable_values.h"
#include "draco/smallest_stream.h"
#include "draco/stock_stream.h"
#include "lacerta/mesh.h"
#include "lacerta/status.h"

namespace lacerta {

class PositionStream {
 public:
  // Of these triangles over vertices 0 .. num_vertices - 1 as Draco codes them by edgebreaker: with the settings and from the start of `attempt`. Its order
  // does not depend on positions. Fails on no triangles, and where Draco refuses the mesh.
  static StatusOr<PositionStream> Create(const std::vector<Triangle>& triangles, size_t num_vertices, const StockAttempt& attempt);

  // Of each value that the stream has, in its order: the vertex whose position it is. Several of one vertex where Draco cuts the mesh there; none of a
  // vertex without triangles.
  const std::vector<uint32_t>& vertices() const { return vertices_; }
  // What predicts them; the values themselves are none.
  const PredictableValues& order() const { return order_; }

  // Of each vertex that a decoder makes, in its order: the vertex that it is.
  std::vector<uint32_t> DecodedVertices() const;
  // The same for vertices that are numbered as a decoder does.
  PositionStream Decoded() const;

  // Those of vertices at `points` (#V).
  PredictableValues ValuesAt(const std::vector<LatticePoint>& points) const;
  // bits: of a coordinate, for points 0 .. 2^bits - 1.
  Bytes Encode(const std::vector<LatticePoint>& points, const QuantizationGrid& grid, int bits) const;

 private:
  Bytes before_values_;
  std::vector<uint32_t> vertices_;
  PredictableValues order_;
  std::vector<uint32_t> value_of_decoded_;  // vertex
};

}  // namespace lacerta

#endif  // LACERTA_DRACO_POSITION_STREAM_H_
