// Speed and size of the stream: a bumpy star-shaped surface as a normal mesh of four levels over 162 base vertices,
// quantized in a closed loop at a coarse, a middle and a fine step. Items are coefficients, three per edge.
#include <benchmark/benchmark.h>

#include <cmath>
#include <map>
#include <vector>

#include "common/local_frame.h"
#include "decoder/synthesis.h"
#include "encoder/stream_writer.h"
#include "lacerta/decoder.h"
#include "shapes/shapes.h"

namespace lacerta {
namespace {

constexpr int kNumLevels = 4;

// Distance of the surface from the origin: bumps whose height falls with their width, as on a scan.
float RadiusToward(const Vec3f& p) {
  const Vec3f d = Normalized(p);
  float radius = 1.0f, height = 0.12f;
  for (float frequency = 2.0f; frequency < 80.0f; frequency *= 1.9f, height *= 0.42f) {
    radius += height * std::sin(frequency * d.x + 1.3f * frequency) * std::sin(frequency * 1.1f * d.y + 0.7f) *
              std::cos(frequency * 0.9f * d.z);
  }
  return radius;
}

// Signed length along `direction` from `from` to the surface, by the secant rule.
float Pierce(const Vec3f& from, const Vec3f& direction) {
  const auto miss = [&](float s) {
    const Vec3f p = from + direction * s;
    return Norm(p) - RadiusToward(p);
  };
  float a = 0.0f, b = 0.01f, miss_a = miss(a), miss_b = miss(b);
  for (int i = 0; i < 8 && std::fabs(miss_b - miss_a) > 1e-9f; ++i) {
    const float next = b - miss_b * (b - a) / (miss_b - miss_a);
    a = b;
    miss_a = miss_b;
    b = next;
    miss_b = miss(b);
  }
  return b;
}

struct Sample {
  BaseMesh base;
  std::vector<Topology> topologies;
  std::vector<LevelSteps> steps;
  std::vector<QuantizedLevel> levels;
  RefinementBytes refinement;
  int64_t num_coefficients = 0;
};

Sample MakeSample(float finest_step) {
  Sample s;
  const TriangleMesh sphere = shapes::Icosphere(2);
  s.base.step = 1.0f / 512;
  s.base.triangles = sphere.triangles;
  for (const Vec3f& p : sphere.positions) {
    const Vec3f q = p * (RadiusToward(p) / s.base.step);
    s.base.lattice.push_back({static_cast<int32_t>(std::lround(q.x)), static_cast<int32_t>(std::lround(q.y)),
                              static_cast<int32_t>(std::lround(q.z))});
  }
  s.topologies = BuildTopologies(s.base, kNumLevels).value();
  const StencilTable table(s.topologies[0]);
  std::vector<Vec3f> positions = s.base.ToMesh().positions;
  for (int i = 0; i < kNumLevels; ++i) {
    const Topology& t = s.topologies[static_cast<size_t>(i)];
    const float step = RoundStep(finest_step / std::pow(1.4f, static_cast<float>(kNumLevels - 1 - i)));
    const std::vector<Vec3f> midpoints = PredictMidpoints(t, table, positions);
    const std::vector<LocalFrame> frames = ComputeLocalFrames(t, positions, midpoints);
    QuantizedLevel q;
    for (uint32_t e = 0; e < t.num_edges(); ++e) {
      q.normal.push_back(static_cast<int32_t>(std::lround(Pierce(midpoints[e], frames[e].normal) / step)));
      q.tangential.insert(q.tangential.end(), {0, e % 50 == 0 ? 1 : 0});
    }
    s.steps.push_back({step, RoundStep(2 * step), 2, 2});
    SynthesizeLevel(t, table, s.steps.back(), q, &positions);
    s.levels.push_back(std::move(q));
    s.num_coefficients += int64_t{3} * t.num_edges();
  }
  s.refinement = WriteRefinement(s.base, s.topologies, s.steps, s.levels).value();
  return s;
}

// state.range(0): finest step in 1/10,000 of the radius.
const Sample& SampleOf(const benchmark::State& state) {
  static std::map<int64_t, Sample> samples;
  const int64_t key = state.range(0);
  const auto found = samples.find(key);
  if (found != samples.end()) return found->second;
  return samples.emplace(key, MakeSample(static_cast<float>(key) * 1e-4f)).first->second;
}

void Report(const Sample& sample, benchmark::State& state) {
  state.SetItemsProcessed(state.iterations() * sample.num_coefficients);
  state.counters["bytes"] = static_cast<double>(sample.refinement.bytes.size());
}

void BM_WriteRefinement(benchmark::State& state) {
  const Sample& s = SampleOf(state);
  for (auto _ : state) benchmark::DoNotOptimize(WriteRefinement(s.base, s.topologies, s.steps, s.levels).ok());
  Report(s, state);
}
BENCHMARK(BM_WriteRefinement)->Arg(40)->Arg(10)->Arg(2)->Unit(benchmark::kMillisecond);

// Entropy decoding, synthesis and connectivity of all levels.
void BM_DecodeRefinement(benchmark::State& state) {
  const Sample& s = SampleOf(state);
  for (auto _ : state) benchmark::DoNotOptimize(DecodeRefinement(s.base, s.refinement.bytes, {}).ok());
  Report(s, state);
}
BENCHMARK(BM_DecodeRefinement)->Arg(40)->Arg(10)->Arg(2)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace lacerta

BENCHMARK_MAIN();
