// Speed and memory of decoding on one thread, beside stock Draco: decode_bench [--benchmark_...] [FILE...]
//
// A .drc file is a stream of ours: "whole" is DecodeMesh, "base" what comes before the first level is shown, "levels"
// ProgressiveDecoder on a base at hand, without triangles. A mesh file is coded by Draco at speed 0 with 12 bits first,
// and by meshoptimizer with as many, in an order that its coders like: "draco" and "meshopt" decode that, to floats.
// Without files, a bumpy torus is packed and decoded. Items are triangles of the result, "levels" aside: vertices.
// bytes_per_vertex: the most memory taken at a time, over the vertices of the result, which is part of it; over_result:
// over the bytes of positions and triangles. acmr: vertices that a GPU transforms per triangle, drawing the result
// through a cache of the 16 last ones. Memory that was given back stays with the process: malloc would return large
// blocks to the system, and taking them anew, page by page, costs more than a whole decoding does. "whole_anew" and
// "draco_anew" map every block of more than 128 kB anew, as a first decoding does.
#include <benchmark/benchmark.h>
#include <malloc.h>
#ifdef LACERTA_HAVE_MESHOPTIMIZER
#include <meshoptimizer.h>
#endif

#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "bench/heap_meter.h"
#include "bench/must.h"
#include "bench/other_codecs.h"
#include "draco/base_mesh_codec.h"
#include "lacerta/codec.h"
#include "lacerta/file_io.h"
#include "lacerta/mesh_file.h"
#include "shapes/shapes.h"

namespace lacerta {
namespace {

constexpr int kBits = 12;  // of the coders beside ours

struct Size {
  size_t vertices = 0, triangles = 0;
};

enum class Memory { kAtHand, kAnew };

// Blocks of more than glibc's 128 kB are mapped for themselves where they are to be anew, as the first ones of a process are; else none.
void SetMemory(Memory memory) {
  constexpr int kUsualMaps = 65536, kUsualThreshold = 128 * 1024;
  mallopt(M_MMAP_THRESHOLD, kUsualThreshold);  // and stays: glibc would raise it
  mallopt(M_MMAP_MAX, memory == Memory::kAnew ? kUsualMaps : 0);
  mallopt(M_TRIM_THRESHOLD, -1);
}

// Runs `decode`, which returns the size of what it decoded.
template <typename Decode>
Size RunAndMeasureMemory(benchmark::State& state, Memory memory, const Decode& decode) {
  Size size;
  const size_t before = HeapInUse();
  ResetHeapPeak();
  SetMemory(memory);
  if (memory == Memory::kAtHand) decode();  // so that it is
  for (auto _ : state) {
    if (memory == Memory::kAnew) {
      state.PauseTiming();
      malloc_trim(0);
      state.ResumeTiming();
    }
    size = decode();
  }
  SetMemory(Memory::kAtHand);
  const auto most = static_cast<double>(HeapPeak() - before), vertices = static_cast<double>(size.vertices);
  state.counters["vertices"] = vertices;
  state.counters["triangles"] = static_cast<double>(size.triangles);
  state.counters["bytes_per_vertex"] = most / vertices;
  state.counters["over_result"] =
      most / (sizeof(Vec3f) * vertices + sizeof(Triangle) * static_cast<double>(size.triangles));
  return size;
}

void CountCacheMisses(benchmark::State& state, const TriangleMesh& mesh) {
#ifdef LACERTA_HAVE_MESHOPTIMIZER
  constexpr unsigned kCacheSize = 16;
  state.counters["acmr"] = meshopt_analyzeVertexCache(mesh.triangles[0].data(), 3 * mesh.triangles.size(),
                                                      mesh.positions.size(), kCacheSize, 0, 0)
                               .acmr;
#else
  (void)state, (void)mesh;
#endif
}

void DecodeWhole(benchmark::State& state, const std::string& name, const Bytes& stream, std::optional<int> max_level,
                 Memory memory) {
  DecodeOptions options;
  options.max_level = max_level;
  const Size size = RunAndMeasureMemory(state, memory, [&] {
    const DecodedMesh decoded = Must(DecodeMesh(stream, options), name);
    return Size{decoded.mesh.positions.size(), decoded.mesh.triangles.size()};
  });
  CountCacheMisses(state, Must(DecodeMesh(stream, options), name).mesh);
  state.SetItemsProcessed(state.iterations() * static_cast<int64_t>(size.triangles));
}

void DecodeLevels(benchmark::State& state, const std::string& name, const Bytes& stream) {
  StreamParts parts;
  DecodedBase decoded;
  if (IsCustomForm(stream)) {
    parts = Must(SplitCustomForm(stream), name);
    decoded = Must(DecodeBaseOf(parts, {}), name);
  } else {
    decoded = Must(DecodeBaseMesh(stream, {}), name);
    parts.refinement = Span<const uint8_t>(stream).Subspan(decoded.bytes_used);
  }
  const RefinementInfo info = Must(ReadRefinementInfo(parts.refinement), name);
  const BaseMesh base =
      Must(BaseMeshFromPositions(decoded.mesh, info.base_step != 0 ? info.base_step : decoded.step), name);
  const Size size = RunAndMeasureMemory(state, Memory::kAtHand, [&] {
    ProgressiveDecoder decoder = Must(ProgressiveDecoder::Create(base, {}), name);
    if (!decoder.Append(parts.refinement).ok()) std::exit(1);
    return Size{decoder.mesh().positions.size(), base.triangles.size() << 2 * decoder.level()};
  });
  state.SetItemsProcessed(state.iterations() * static_cast<int64_t>(size.vertices));
}

void DecodeStock(benchmark::State& state, const std::string& name, const Bytes& stream, Memory memory) {
  const Size size = RunAndMeasureMemory(state, memory, [&] {
    const std::unique_ptr<draco::Mesh> decoded = Must(DecodeByDraco(stream), name);
    return Size{decoded->num_points(), static_cast<size_t>(decoded->num_faces())};
  });
  state.counters["bytes"] = static_cast<double>(stream.size());
  state.SetItemsProcessed(state.iterations() * static_cast<int64_t>(size.triangles));
}

#ifdef LACERTA_HAVE_MESHOPTIMIZER
void DecodeMeshopt(benchmark::State& state, const std::string& name, const MeshoptStreams& coded, Memory memory) {
  const Size size = RunAndMeasureMemory(state, memory, [&] {
    const TriangleMesh mesh = Must(DecodeByMeshopt(coded), name);
    return Size{mesh.positions.size(), mesh.triangles.size()};
  });
  state.counters["bytes"] = static_cast<double>(coded.size());
  state.SetItemsProcessed(state.iterations() * static_cast<int64_t>(size.triangles));
}
#endif

template <typename Run>
void Register(const std::string& what, const std::string& name, const Run& run) {
  benchmark::RegisterBenchmark((what + "/" + name).c_str(), run)->Unit(benchmark::kMicrosecond);
}

void RegisterStream(const std::string& name, const Bytes& stream) {
  Register("whole", name,
           [=](benchmark::State& state) { DecodeWhole(state, name, stream, std::nullopt, Memory::kAtHand); });
  Register("whole_anew", name,
           [=](benchmark::State& state) { DecodeWhole(state, name, stream, std::nullopt, Memory::kAnew); });
  Register("base", name, [=](benchmark::State& state) { DecodeWhole(state, name, stream, 0, Memory::kAtHand); });
  Register("levels", name, [=](benchmark::State& state) { DecodeLevels(state, name, stream); });
}

void RegisterStock(const std::string& name, const TriangleMesh& mesh) {
  const Bytes stream = Must(EncodeByDraco(mesh, kBits), name);
  Register("draco", name, [=](benchmark::State& state) { DecodeStock(state, name, stream, Memory::kAtHand); });
  Register("draco_anew", name, [=](benchmark::State& state) { DecodeStock(state, name, stream, Memory::kAnew); });
#ifdef LACERTA_HAVE_MESHOPTIMIZER
  const MeshoptStreams coded = EncodeByMeshopt(mesh, kBits);
  Register("meshopt", name, [=](benchmark::State& state) { DecodeMeshopt(state, name, coded, Memory::kAtHand); });
  Register("meshopt_anew", name, [=](benchmark::State& state) { DecodeMeshopt(state, name, coded, Memory::kAnew); });
#endif
}

void RegisterFile(const std::string& path) {
  const std::filesystem::path file(path);
  if (file.extension() == ".drc") {
    RegisterStream(file.stem().string(), Must(ReadFile(path), path));
  } else {
    RegisterStock(file.stem().string(), Must(ReadMeshFile(path), path));
  }
}

void RegisterTorus() {
  TriangleMesh torus = shapes::Torus(61, 41);  // odd, so that it is not taken for a subdivided one
  for (Vec3f& p : torus.positions) p *= 1 + 0.05f * std::sin(9 * p.x) * std::cos(7 * p.y);
  EncodeOptions options;
  options.form = StreamForm::kCustom;
  options.levels = LevelChoice::kAlways;
  RegisterStream("torus", Must(EncodeMesh(torus, options), "torus").stream);
  RegisterStock("torus", torus);
}

}  // namespace
}  // namespace lacerta

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  lacerta::SetMemory(lacerta::Memory::kAtHand);
  for (int i = 1; i < argc; ++i) lacerta::RegisterFile(argv[i]);
  if (argc == 1) lacerta::RegisterTorus();
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
