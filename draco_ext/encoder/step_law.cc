#include "encoder/step_law.h"

#include <algorithm>
#include <cmath>

#include "common/curved_prediction.h"
#include "common/local_frame.h"
#include "common/step_forecast.h"

namespace lacerta {
namespace {

constexpr double kSlopeShare = 0.12;       // lambda / (step^2 / N) where detail ends
constexpr double kStepRatio = 1.2;         // between the steps of two levels below that, rounded as the header expects it (NextStepBits)
constexpr double kDetailedScale = 0.5;     // a level carries detail when its scale exceeds this share of its step
constexpr double kTangentialRatio = 2.0;   // of the tangential to the normal step
constexpr int kCurvedLevels = 3;           // docs/decisions/0021-curved-prediction.md
// The base lattice is as fine as the steps of a level of so many vertices: finer for small bases, each vertex of which moves much.
constexpr double kFinestBase = 7.5e3, kCoarsestBase = 2.5e4, kPerBaseVertex = 100;

bool IsCurved(int level) { return level <= kCurvedLevels; }

// The details of the edges of level - 1, before quantization: along the normal, or the whole where vertices are kept.
std::vector<double> DetailLengths(const SurfaceTarget& target, int level) {
  const Topology& coarse = target.topologies[level - 1];
  const std::vector<Vec3f> positions(target.points.begin(), target.points.begin() + coarse.num_vertices);
  const std::vector<Vec3f> predicted = target.midpoints[level - 1].Predict(positions);
  const std::vector<LocalFrame> frames = ComputeLocalFrames(coarse, positions, predicted);
  const std::vector<Vec3f> offsets = LevelOffsets(coarse, IsCurved(level), positions, predicted);
  std::vector<double> lengths;
  for (uint32_t e = 0; e < coarse.num_edges(); ++e) {
    if (coarse.is_copy(e)) continue;
    const Vec3f detail = target.points[coarse.num_vertices + e] - predicted[e] - offsets[e];
    lengths.push_back(target.keeps_vertices ? Norm(detail) : Dot(detail, frames[e].normal));
  }
  return lengths;
}

double BalancedStep(double lambda, double num_vertices) { return std::sqrt(lambda * num_vertices / kSlopeShare); }

}  // namespace

std::vector<double> DetailScales(const SurfaceTarget& target) {
  std::vector<double> scales;
  for (int level = 1; level <= target.num_levels(); ++level) {
    double sum = 0;
    for (const double length : DetailLengths(target, level)) sum += length * length;
    scales.push_back(std::sqrt(sum / target.topologies[level - 1].num_edges()));
  }
  return scales;
}

int LastDetailedLevel(const SurfaceTarget& target, const std::vector<double>& detail_scales, double lambda) {
  int last = 1;
  for (int level = 2; level <= target.num_levels(); ++level) {
    if (detail_scales[level - 1] > kDetailedScale * BalancedStep(lambda, target.topologies[level].num_vertices)) last = level;
  }
  return last;
}

std::vector<LevelSteps> StepsForSlope(const SurfaceTarget& target, int last_detailed, double lambda) {
  const int num_levels = target.num_levels();
  std::vector<LevelSteps> result(num_levels);
  for (int level = 1; level <= num_levels; ++level) {
    float& step = result[level - 1].normal_step;
    if (level > 1 && level <= last_detailed && result[level - 2].normal_step > 0) {
      step = StepFromBits(static_cast<uint16_t>(NextStepBits(StepToBits(result[level - 2].normal_step))));
    } else {
      const double balanced = BalancedStep(lambda, target.topologies[std::max(level, last_detailed)].num_vertices);
      step = RoundStep(static_cast<float>(balanced / std::pow(kStepRatio, std::max(0, last_detailed - level))));
    }
    result[level - 1].tangential_step = RoundStep(static_cast<float>(kTangentialRatio) * step);
    result[level - 1].is_curved = IsCurved(level);
  }
  return result;
}

std::vector<LevelSteps> StepsForSlope(const SurfaceTarget& target, const std::vector<double>& detail_scales, double lambda) {
  return StepsForSlope(target, LastDetailedLevel(target, detail_scales, lambda), lambda);
}

double BaseStepForSlope(double lambda, double num_base_vertices) {
  return BalancedStep(lambda, std::clamp(kPerBaseVertex * num_base_vertices, kFinestBase, kCoarsestBase));
}

}  // namespace lacerta
