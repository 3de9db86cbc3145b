#include "draco/position_stream.h"

#include <algorithm>
#include <optional>
#include <string>
#include <utility>

#include "draco/mesh_conversion.h"
#include "draco/parallelogram_choice.h"
#include "draco/recoded_stream.h"

namespace lacerta {
namespace {

// Numbers of vertices as points, so that a stream tells which vertex is which.
constexpr int kNumberBits = 10;  // of a coordinate
constexpr uint32_t kNumberMask = (1u << kNumberBits) - 1;

Vec3f PointOf(uint32_t vertex) {
  return {static_cast<float>(vertex & kNumberMask), static_cast<float>(vertex >> kNumberBits & kNumberMask), static_cast<float>(vertex >> (2 * kNumberBits) & kNumberMask)};
}

uint32_t VertexAt(const int32_t* point) {
  return static_cast<uint32_t>(point[0]) | static_cast<uint32_t>(point[1]) << kNumberBits | static_cast<uint32_t>(point[2]) << (2 * kNumberBits);
}

}  // namespace

StatusOr<PositionStream> PositionStream::Create(const std::vector<Triangle>& triangles, size_t num_vertices, const StockAttempt& attempt) {
  if (triangles.empty()) return InvalidData("mesh has no triangles");
  if (num_vertices > size_t{1} << (3 * kNumberBits)) return InvalidData(std::to_string(num_vertices) + " vertices; a stock stream takes up to 2^30");
  TriangleMesh numbered;
  numbered.triangles = triangles;
  for (uint32_t v = 0; v < num_vertices; ++v) numbered.positions.push_back(PointOf(v));
  LACERTA_ASSIGN_OR_RETURN(const Bytes stream, EncodeIntegerPositions(*ToDracoMesh(StartingAsIn(attempt, numbered)), kNumberBits, attempt.settings));
  std::optional<StreamOfValues> apart = TakeApart(stream);
  if (!apart.has_value()) return InternalError("Draco wrote another stream than one of positions by edgebreaker");
  PositionStream result;
  result.before_values_ = std::move(apart->before);
  result.order_ = std::move(apart->values);
  result.value_of_decoded_ = std::move(apart->value_of_point);
  for (size_t n = 0; n < result.order_.size(); ++n) result.vertices_.push_back(VertexAt(&result.order_.values[3 * n]));
  return result;
}

std::vector<uint32_t> PositionStream::DecodedVertices() const {
  std::vector<uint32_t> result;
  for (const uint32_t n : value_of_decoded_) result.push_back(vertices_[n]);
  return result;
}

PositionStream PositionStream::Decoded() const {
  PositionStream result = *this;
  for (uint32_t v = 0; v < value_of_decoded_.size(); ++v) result.vertices_[value_of_decoded_[v]] = v;
  return result;
}

PredictableValues PositionStream::ValuesAt(const std::vector<LatticePoint>& points) const {
  PredictableValues result = order_;
  for (size_t n = 0; n < vertices_.size(); ++n) {
    const LatticePoint& p = points[vertices_[n]];
    std::copy(p.begin(), p.end(), result.values.begin() + static_cast<ptrdiff_t>(3 * n));
  }
  return result;
}

Bytes PositionStream::Encode(const std::vector<LatticePoint>& points, const QuantizationGrid& grid, int bits) const {
  Bytes result = before_values_;
  const Bytes values = CodeByParallelograms(ValuesAt(points)).bytes;
  result.insert(result.end(), values.begin(), values.end());
  AppendQuantizationGrid(grid, bits, &result);
  return result;
}

}  // namespace lacerta
