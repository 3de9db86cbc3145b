// Time of the model-based allocation of paper mode, on the normal mesh of a mesh file: allocation_bench [--benchmark_...] FILE...
//
// "allocation" is what the paper counts: from the statistics of the sets to their steps, tables included, for a target rate. "statistics"
// is the look at all coefficients before that.
#include <benchmark/benchmark.h>

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "baselines/remeshes.h"
#include "bench/must.h"
#include "encoder/allocation/bit_allocation.h"
#include "encoder/allocation/set_statistics.h"
#include "encoder/allocation/subband_weights.h"
#include "encoder/analysis.h"
#include "lacerta/clean.h"
#include "lacerta/mesh_file.h"

namespace lacerta {
namespace {

constexpr uint32_t kBaseVertices = 200;
constexpr int kLevels = 5;
constexpr double kBitsPerSample = 0.5;

void Register(const std::string& path) {
  const CleanedMesh input = Must(Clean(Must(ReadMeshFile(path), path)), path);
  const SemiRegularMesh mesh = Must(baselines::MakeRemeshes(input.mesh, kBaseVertices, kLevels), path).normal.mesh;
  const std::vector<LevelCoefficients> levels = Must(Analyze(mesh), path);
  const auto describe = [mesh, levels] {
    return Describe(mesh.positions, mesh.num_base_vertices, levels, RegularEnergies(kLevels), DescribeOptions{0.0});
  };
  const std::string name = std::filesystem::path(path).stem().string();
  benchmark::RegisterBenchmark(("statistics/" + name).c_str(), [=](benchmark::State& state) {
    for (auto _ : state) benchmark::DoNotOptimize(describe());
  })->Unit(benchmark::kMillisecond);
  benchmark::RegisterBenchmark(("allocation/" + name).c_str(), [sets = describe(), path](benchmark::State& state) {
    for (auto _ : state) benchmark::DoNotOptimize(Must(AllocateBits(sets, kBitsPerSample), path));
    state.counters["sets"] = static_cast<double>(sets.size());
  })->Unit(benchmark::kMillisecond);
}

}  // namespace
}  // namespace lacerta

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  for (int i = 1; i < argc; ++i) lacerta::Register(argv[i]);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
