#include "draco/crowded_input.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

#include "draco/zero_level.h"
#include "remesh/mesh_fit.h"

namespace lacerta {

uint64_t SamplesInCrowd(double crowding, uint64_t most) {
  constexpr double kFewest = 2'000, kWithMost = 20;
  return static_cast<uint64_t>(std::clamp(static_cast<double>(most) * kWithMost / crowding, kFewest, static_cast<double>(most)));
}

StatusOr<ZeroLevelStream> CodeCrowdedInput(const TriangleMesh& mesh, double crowding, const SurfaceDistanceMeter& meter, const ResolvedTarget& target) {
  constexpr int kMostTries = 6;
  constexpr uint64_t kMostSamples = 200'000;
  constexpr double kDecibels = 0.2;  // near enough to a PSNR
  const double finest = meter.diagonal() / (1 << 21), coarsest = meter.diagonal() / 4;
  const SurfaceDistanceOptions samples = SurfaceDistanceOptions::RmsOnly(SamplesInCrowd(crowding, kMostSamples));
  // Rounding moves a corner by step / sqrt(12) along the normal, a point of the face by 1 / sqrt(2) of that. Halving the step gains 6 dB, and
  // takes a bit for each coordinate of vertices that Draco may have to repeat. Both are seen better from two tries.
  const double wanted = target.is_rate ? 0.97 * target.bytes : target.psnr + kDecibels / 2;
  double gain = target.is_rate ? 3 * static_cast<double>(mesh.positions.size()) / 8 : 6;
  const double least_gain = gain / 3, most_gain = gain * (target.is_rate ? 8 : 1.5);
  double step = target.is_rate ? meter.diagonal() * std::exp2(-wanted / (2 * gain)) : std::sqrt(24) * DistanceOfPsnr(target.psnr, meter.diagonal());
  double step_before = 0, reached_before = 0;
  std::optional<ZeroLevelStream> best;
  for (int i = 0; i < kMostTries; ++i) {
    step = std::clamp(step, finest, coarsest);
    LACERTA_ASSIGN_OR_RETURN(CodedZeroLevel coded, EncodeLatticeMesh(NearestOnLattice(mesh, step), CodingEffort::kQuick, target.base_coding));
    ZeroLevelStream stream = MeasuredZeroLevel(std::move(coded), meter, target, samples);
    stream.measurements = i + 1;
    const auto bytes = static_cast<double>(stream.stream.size());
    const double reached = target.is_rate ? bytes : stream.psnr;
    if (i > 0) gain = std::clamp((reached - reached_before) / std::log2(step_before / step), least_gain, most_gain);
    reached_before = reached;
    step_before = step;
    const bool is_near = stream.meets_target && (target.is_rate ? bytes > 0.94 * target.bytes : stream.psnr < target.psnr + kDecibels);
    const double next = std::clamp(step * std::exp2(std::clamp((reached - wanted) / gain, -6.0, 6.0)), finest, coarsest);
    if (!best || IsBetter(OutcomeOf(stream), OutcomeOf(*best), target)) best = std::move(stream);
    if (is_near || next == step) break;
    step = next;
  }
  return std::move(*best);
}

}  // namespace lacerta
