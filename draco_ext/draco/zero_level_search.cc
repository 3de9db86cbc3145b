#include "draco/zero_level_search.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "draco/zero_level.h"
#include "remesh/base_domain.h"

namespace lacerta {
namespace {

// More bits than that and neighbouring points of the grid may be one and the same float.
constexpr int kFewestBits = 4, kMostBits = 20;

StatusOr<ZeroLevelStream> CodeWithBits(const TriangleMesh& mesh, int bits, const SurfaceDistanceMeter& meter,
                                       const ResolvedTarget& target) {
  LACERTA_ASSIGN_OR_RETURN(CodedZeroLevel coded, EncodeZeroLevel(mesh, bits));
  ZeroLevelStream result;
  result.stream = std::move(coded.stream);
  result.mesh = std::move(coded.mesh);
  // So coarse a grid may leave no area at all to measure: infinitely far then.
  const StatusOr<SurfaceDistance> distance = meter.Measure(result.mesh, SurfaceDistanceOptions::RmsOnly());
  result.distance = distance.ok() ? distance.value().Rms() : meter.diagonal();
  result.psnr = Psnr(result.distance, meter.diagonal());
  result.meets_target = target.is_rate ? static_cast<double>(result.stream.size()) <= target.bytes : result.psnr >= target.psnr;
  return result;
}

// Bits at which rounding alone takes about the distance that the target leaves: a step of 2^-bits of the longest side errs by
// step / sqrt(12) in each direction.
int FirstBits(double psnr) {
  const double distance = std::pow(10.0, -psnr / 20);
  return std::clamp(static_cast<int>(std::ceil(-std::log2(distance * std::sqrt(12.0)))), kFewestBits, kMostBits);
}

// Bits grow both quality and bytes: the fewest that reach a PSNR, or the most that keep to a number of bytes.
StatusOr<ZeroLevelStream> CodeMeshAtTarget(const TriangleMesh& mesh, const SurfaceDistanceMeter& meter, const ResolvedTarget& target) {
  constexpr double kUsualPsnr = 70;
  int bits = FirstBits(target.is_rate ? kUsualPsnr : target.psnr);
  LACERTA_ASSIGN_OR_RETURN(ZeroLevelStream best, CodeWithBits(mesh, bits, meter, target));
  const int direction = best.meets_target == target.is_rate ? 1 : -1;
  for (bits += direction; bits >= kFewestBits && bits <= kMostBits; bits += direction) {
    LACERTA_ASSIGN_OR_RETURN(ZeroLevelStream next, CodeWithBits(mesh, bits, meter, target));
    const bool had_met = best.meets_target, meets = next.meets_target;
    if (had_met && !meets) break;
    if (!meets && !target.is_rate && next.psnr <= best.psnr + 0.1) break;  // bits no longer help
    best = std::move(next);
    if (!had_met && meets) break;
  }
  return best;
}

TriangleMesh SimplifiedMesh(const TriangleMesh& mesh, const CollapseHistory& history, uint32_t num_vertices) {
  const auto num_input = static_cast<uint32_t>(mesh.positions.size());
  const BaseDomain domain(history, std::min(history.num_collapses(), num_input - num_vertices));
  TriangleMesh result;
  for (uint32_t v = 0; v < domain.num_vertices(); ++v) result.positions.push_back(mesh.positions[domain.input_vertex(v)]);
  result.triangles = domain.triangles();
  return result;
}

bool IsBetter(const ZeroLevelStream& a, bool b_meets, size_t b_bytes, double b_psnr, const ResolvedTarget& target) {
  if (a.meets_target != b_meets) return a.meets_target;
  if (target.is_rate == a.meets_target) return a.psnr > b_psnr;  // at a rate that is kept, or at a PSNR that is not reached
  return a.stream.size() < b_bytes;
}

}  // namespace

StatusOr<ZeroLevelStream> CodeZeroLevel(const TriangleMesh& mesh, const SurfaceDistanceMeter& meter, const ResolvedTarget& target) {
  return CodeMeshAtTarget(mesh, meter, target);
}

StatusOr<std::optional<ZeroLevelStream>> SimplerIfBetter(const TriangleMesh& mesh, const CollapseHistory& history,
                                                         const SurfaceDistanceMeter& meter, const ResolvedTarget& target,
                                                         const MeasuredStream& coded) {
  // Stock Draco spends at least this much on a vertex in all that we measured, so that larger meshes need no try.
  constexpr double kLeastBytesPerVertex = 0.8;
  constexpr double kSizeRatio = 1.6;
  std::optional<ZeroLevelStream> best;
  const double most_bytes = target.is_rate ? target.bytes : static_cast<double>(coded.stream.size());
  const double most_vertices = coded.meets_target ? most_bytes / kLeastBytesPerVertex : 1e18;
  for (auto vertices = static_cast<double>(mesh.positions.size()); vertices >= 4; vertices /= kSizeRatio) {
    if (vertices > most_vertices) continue;
    const TriangleMesh simplified = SimplifiedMesh(mesh, history, static_cast<uint32_t>(vertices));
    LACERTA_ASSIGN_OR_RETURN(const SurfaceDistance distance, meter.Measure(simplified, SurfaceDistanceOptions::RmsOnly()));
    const double psnr = Psnr(distance.Rms(), meter.diagonal());
    const double wanted = target.is_rate ? coded.psnr : target.psnr;
    if (psnr < wanted && coded.meets_target) break;  // smaller ones are farther off still
    LACERTA_ASSIGN_OR_RETURN(ZeroLevelStream zero, CodeMeshAtTarget(simplified, meter, target));
    const bool better = best ? IsBetter(zero, best->meets_target, best->stream.size(), best->psnr, target)
                             : IsBetter(zero, coded.meets_target, coded.stream.size(), coded.psnr, target);
    if (better) best = std::move(zero);
    if (!better && best) break;
  }
  return best;
}

}  // namespace lacerta
