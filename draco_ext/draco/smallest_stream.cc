#include "draco/smallest_stream.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

#include "draco/mesh_conversion.h"

namespace lacerta {
namespace {

// Above so many triangles valence coding won on every mesh tried, and the size of the entropy tables made no
// difference.
constexpr size_t kManyTriangles = 20000;

std::vector<StockSettings> SettingsToTry(size_t num_triangles) {
  using Connectivity = StockSettings::Connectivity;
  using Prediction = StockSettings::Prediction;
  const bool many = num_triangles > kManyTriangles;
  std::vector<StockSettings> result;
  for (const Prediction prediction : {Prediction::kParallelogram, Prediction::kConstrainedMultiParallelogram}) {
    for (const int speed : many ? std::vector<int>{0} : std::vector<int>{0, 1, 5}) {
      result.push_back({Connectivity::kEdgebreakerValence, prediction, speed});
      if (!many) result.push_back({Connectivity::kEdgebreaker, prediction, speed});
    }
  }
  return result;
}

Status Try(const TriangleMesh& mesh, int bits, StockAttempt attempt, StockAttempt* best) {
  LACERTA_ASSIGN_OR_RETURN(attempt.stream,
                           EncodeIntegerPositions(*ToDracoMesh(StartingAsIn(attempt, mesh)), bits, attempt.settings));
  if (best->stream.empty() || attempt.stream.size() < best->stream.size()) *best = std::move(attempt);
  return {};
}

}  // namespace

StatusOr<StockAttempt> SmallestEdgebreakerStream(const TriangleMesh& mesh, int bits) {
  const size_t num_triangles = mesh.triangles.size();
  StockAttempt best;
  for (const StockSettings& settings : SettingsToTry(num_triangles)) {
    LACERTA_RETURN_IF_ERROR(Try(mesh, bits, {settings, 0, 0, {}}, &best));
  }
  // Other starting triangles gain 0.5 %, up to 4 % on a part with flat faces: a larger mesh gets fewer of them, since
  // there the start matters less and time more.
  constexpr size_t kMaxStarts = 32;
  constexpr size_t kTriangleBudget = 1u << 16;
  const size_t num_starts = std::min(kMaxStarts, kTriangleBudget / num_triangles);
  const StockSettings settings = best.settings;
  for (size_t i = 1; i < num_starts; ++i) {
    const auto first = static_cast<uint32_t>(i * num_triangles / num_starts);
    LACERTA_RETURN_IF_ERROR(Try(mesh, bits, {settings, first, static_cast<uint32_t>(i % 3), {}}, &best));
  }
  return best;
}

TriangleMesh StartingAsIn(const StockAttempt& attempt, const TriangleMesh& mesh) {
  TriangleMesh result = mesh;
  std::rotate(result.triangles.begin(), result.triangles.begin() + attempt.first_triangle, result.triangles.end());
  Triangle& front = result.triangles.front();
  std::rotate(front.begin(), front.begin() + attempt.first_corner, front.end());
  return result;
}

}  // namespace lacerta
