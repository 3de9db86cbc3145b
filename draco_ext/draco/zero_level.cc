#include "draco/zero_level.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "lacerta/decoder.h"
#include "draco/base_mesh_codec.h"
#include "draco/mesh_conversion.h"
#include "draco/recoded_stream.h"
#include "draco/smallest_stream.h"
#include "draco/stock_stream.h"
#include "encoder/compact_base_encoder.h"
#include "geometry/bounding_box.h"
#include "remesh/manifold.h"

namespace lacerta {
namespace {

struct GridMesh {
  TriangleMesh mesh;  // integers as floats
  QuantizationGrid grid;
  int bits = 1;
};

StatusOr<GridMesh> Quantize(const TriangleMesh& mesh, int bits) {
  const auto [low, high] = BoundsOf(mesh.positions);
  GridMesh result;
  result.grid.origin = low;
  const Vec3f size = high - low;
  const float range = std::max({size.x, size.y, size.z});
  if (!std::isfinite(range)) return InvalidData("bounding box of the mesh does not fit a float; scale the mesh down");
  result.grid.range = std::isnormal(range) ? range : 1.0f;
  result.bits = bits;
  const double divisor = (1 << bits) - 1;
  const double scale = divisor / static_cast<double>(result.grid.range);
  result.mesh.triangles = mesh.triangles;
  result.mesh.positions.reserve(mesh.positions.size());
  for (const Vec3f& p : mesh.positions) {
    const Vec3d exact = (Vec3Cast<double>(p) - Vec3Cast<double>(low)) * scale;
    Vec3f integer;
    for (int c = 0; c < 3; ++c) integer[c] = static_cast<float>(std::clamp(std::round(exact[c]), 0.0, divisor));
    result.mesh.positions.push_back(integer);
  }
  return result;
}

constexpr StockSettings kUsualSettings = {StockSettings::Connectivity::kEdgebreakerValence, StockSettings::Prediction::kParallelogram, 0};

using Corners = std::array<std::array<float, 3>, 3>;

// The triangles as corner positions, each from its smallest corner on, sorted: equal for equal surfaces.
std::vector<Corners> SortedTriangles(const TriangleMesh& mesh) {
  std::vector<Corners> result;
  result.reserve(mesh.triangles.size());
  for (const Triangle& t : mesh.triangles) {
    Corners corners;
    for (size_t k = 0; k < 3; ++k) {
      const Vec3f& p = mesh.positions[t[k]];
      corners[k] = {p.x, p.y, p.z};
    }
    const Corners start = corners;
    for (size_t k = 1; k < 3; ++k) {
      corners = std::min(corners, Corners{start[k], start[(k + 1) % 3], start[(k + 2) % 3]});
    }
    result.push_back(corners);
  }
  std::sort(result.begin(), result.end());
  return result;
}

bool HoldsTriangles(const Bytes& stream, const std::vector<Corners>& triangles) {
  const StatusOr<DecodedBase> decoded = DecodeBaseMesh(stream, kNoDecodeLimits);
  return decoded.ok() && SortedTriangles(decoded.value().mesh) == triangles;
}

// Edgebreaker, or an error where Draco refuses the mesh or does not keep its triangles.
StatusOr<Bytes> EdgebreakerStream(const GridMesh& quantized, const std::vector<Corners>& triangles, CodingEffort effort) {
  Bytes stream;
  if (effort == CodingEffort::kQuick) {
    LACERTA_ASSIGN_OR_RETURN(Bytes written, EncodeIntegerPositions(*ToDracoMesh(quantized.mesh), quantized.bits, kUsualSettings));
    stream = RecodeStream(std::move(written));
  } else {
    LACERTA_ASSIGN_OR_RETURN(StockAttempt attempt, SmallestEdgebreakerStream(quantized.mesh, quantized.bits));
    stream = std::move(attempt.stream);
  }
  if (!HoldsTriangles(stream, triangles)) return Unsupported("edgebreaker does not keep the triangles of the mesh");
  return stream;
}

// Puts the integers of result->stream in their place.
Status Place(const QuantizationGrid& grid, CodedZeroLevel* result) {
  LACERTA_RETURN_IF_ERROR(SetQuantizationGrid(grid, &result->stream));
  LACERTA_ASSIGN_OR_RETURN(DecodedBase decoded, DecodeBaseMesh(result->stream, kNoDecodeLimits));
  result->mesh = std::move(decoded.mesh);
  return {};
}

StatusOr<CodedZeroLevel> Encode(const GridMesh& quantized, CodingEffort effort) {
  const std::vector<Corners> triangles = SortedTriangles(quantized.mesh);
  CodedZeroLevel result;
  StatusOr<Bytes> edgebreaker = EdgebreakerStream(quantized, triangles, effort);
  if (edgebreaker.ok()) {
    result.stream = std::move(edgebreaker).value();
  } else {
    result.sequential = true;
    const StockSettings settings = {StockSettings::Connectivity::kSequential, StockSettings::Prediction::kDifference,
                                    0};
    LACERTA_ASSIGN_OR_RETURN(result.stream, EncodeIntegerPositions(*ToDracoMesh(quantized.mesh), quantized.bits, settings));
    if (!HoldsTriangles(result.stream, triangles)) return InternalError("Draco did not keep the triangles of the mesh");
  }
  LACERTA_RETURN_IF_ERROR(Place(quantized.grid, &result));
  return result;
}

StatusOr<GridMesh> OnGrid(const LatticeMesh& mesh) {
  GridMesh result;
  int32_t extent = 1;
  for (const LatticePoint& p : mesh.lattice) {
    extent = std::max({extent, p[0], p[1], p[2]});
    result.mesh.positions.push_back({static_cast<float>(p[0]), static_cast<float>(p[1]), static_cast<float>(p[2])});
  }
  while (extent >> result.bits != 0) ++result.bits;
  constexpr int kMostBits = 22;  // Draco adds a half in floats before it rounds
  if (result.bits > kMostBits) return InvalidData("lattice spans more than 22 bits; choose a larger step");
  result.mesh.triangles = mesh.triangles;
  result.grid = {mesh.origin, mesh.step * static_cast<float>((1 << result.bits) - 1)};
  LACERTA_RETURN_IF_ERROR(CheckEncodable(result.mesh));
  return result;
}

// Cut where the mesh is no oriented manifold, with the copies of vertices that this takes.
StatusOr<BaseMesh> CutToManifold(const LatticeMesh& mesh) {
  for (size_t f = 0; f < mesh.triangles.size(); ++f) {
    const Triangle& t = mesh.triangles[f];
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) return InvalidData("triangle " + std::to_string(f) + " repeats a vertex");
  }
  ManifoldMesh cut = MakeManifold(mesh.ToMesh(), Orientation::kKept);
  BaseMesh result = {mesh.step, mesh.lattice, std::move(cut.mesh.triangles)};
  for (size_t v = mesh.lattice.size(); v < cut.source_vertex.size(); ++v) result.lattice.push_back(mesh.lattice[cut.source_vertex[v]]);
  return result;
}

StatusOr<CodedZeroLevel> EncodeCompactLattice(const LatticeMesh& mesh, CodingEffort effort) {
  LACERTA_ASSIGN_OR_RETURN(const BaseMesh base, CutToManifold(mesh));
  LACERTA_ASSIGN_OR_RETURN(CompactBaseBytes coded, effort == CodingEffort::kQuick ? EncodeCompactBase(base, mesh.origin)
                                                                                 : EncodeCompactBaseSmallest(base, mesh.origin));
  CodedZeroLevel result;
  result.stream = std::move(coded.bytes);
  result.mesh = CompactBase{std::move(coded.mesh), mesh.origin}.ToMesh();
  result.coding = BaseCoding::kCompact;
  return result;
}

}  // namespace

StatusOr<CodedZeroLevel> EncodeZeroLevel(const TriangleMesh& mesh, int bits) {
  if (bits < 1 || bits > 24) {
    return InvalidArgument(std::to_string(bits) + " bits per coordinate; 1 to 24 are possible");
  }
  LACERTA_RETURN_IF_ERROR(CheckEncodable(mesh));
  LACERTA_ASSIGN_OR_RETURN(const GridMesh quantized, Quantize(mesh, bits));
  return Encode(quantized, CodingEffort::kFull);
}

StatusOr<CodedZeroLevel> EncodeLatticeMesh(const LatticeMesh& mesh, CodingEffort effort, BaseCoding coding) {
  if (coding == BaseCoding::kCompact) {
    StatusOr<CodedZeroLevel> compact = EncodeCompactLattice(mesh, effort);
    if (compact.ok()) return compact;
  }
  LACERTA_ASSIGN_OR_RETURN(const GridMesh quantized, OnGrid(mesh));
  return Encode(quantized, effort);
}

StatusOr<PositionStream> SmallestOrder(const LatticeMesh& mesh) {
  LACERTA_ASSIGN_OR_RETURN(const GridMesh quantized, OnGrid(mesh));
  LACERTA_ASSIGN_OR_RETURN(const StockAttempt attempt, SmallestEdgebreakerStream(quantized.mesh, quantized.bits));
  if (!HoldsTriangles(attempt.stream, SortedTriangles(quantized.mesh))) return Unsupported("edgebreaker does not keep the triangles of the mesh");
  return PositionStream::Create(mesh.triangles, mesh.lattice.size(), attempt);
}

StatusOr<CodedZeroLevel> EncodeInOrder(const PositionStream& order, const LatticeMesh& mesh) {
  LACERTA_ASSIGN_OR_RETURN(const GridMesh quantized, OnGrid(mesh));
  CodedZeroLevel result;
  result.stream = order.Encode(mesh.lattice, QuantizationGrid{{}, static_cast<float>((1 << quantized.bits) - 1)}, quantized.bits);
  if (!HoldsTriangles(result.stream, SortedTriangles(quantized.mesh))) return InternalError("Draco did not keep the triangles of the mesh");
  LACERTA_RETURN_IF_ERROR(Place(quantized.grid, &result));
  return result;
}

}  // namespace lacerta
