// Speed and memory of decoding on one thread, beside stock Draco: decode_bench [--benchmark_...] [FILE...]
//
// A .drc file is a stream of ours: "whole" is DecodeMesh, "base" what comes before the first level is shown, "levels" ProgressiveDecoder
// on a base at hand, without triangles. A mesh file is coded by Draco at speed 0 with 12 bits first: "draco" decodes that. Without files,
// a bumpy torus is packed and decoded. Items are triangles of the result, "levels" aside: vertices. bytes_per_vertex: the most
// memory taken at a time, over the vertices of the result, which is part of it; over_result: over the bytes of positions and triangles.
#include <benchmark/benchmark.h>
#include <draco/compression/decode.h>
#include <draco/compression/encode.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "bench/heap_meter.h"
#include "draco/base_mesh_codec.h"
#include "draco/mesh_conversion.h"
#include "lacerta/codec.h"
#include "lacerta/file_io.h"
#include "lacerta/mesh_file.h"
#include "shapes/shapes.h"

namespace lacerta {
namespace {

constexpr int kDracoSpeed = 0, kDracoBits = 12;

template <typename T>
T Must(StatusOr<T> result, const std::string& what) {
  if (result.ok()) return std::move(result).value();
  std::fprintf(stderr, "%s: %s\n", what.c_str(), result.status().message().c_str());
  std::exit(1);
}

struct Size {
  size_t vertices = 0, triangles = 0;
};

// Runs `decode`, which returns the size of what it decoded.
template <typename Decode>
Size RunAndMeasureMemory(benchmark::State& state, const Decode& decode) {
  Size size;
  const size_t before = HeapInUse();
  ResetHeapPeak();
  for (auto _ : state) size = decode();
  const auto most = static_cast<double>(HeapPeak() - before), vertices = static_cast<double>(size.vertices);
  state.counters["vertices"] = vertices;
  state.counters["triangles"] = static_cast<double>(size.triangles);
  state.counters["bytes_per_vertex"] = most / vertices;
  state.counters["over_result"] = most / (sizeof(Vec3f) * vertices + sizeof(Triangle) * static_cast<double>(size.triangles));
  return size;
}

void DecodeWhole(benchmark::State& state, const std::string& name, const Bytes& stream, std::optional<int> max_level) {
  DecodeOptions options;
  options.max_level = max_level;
  const Size size = RunAndMeasureMemory(state, [&] {
    const DecodedMesh decoded = Must(DecodeMesh(stream, options), name);
    return Size{decoded.mesh.positions.size(), decoded.mesh.triangles.size()};
  });
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
  const BaseMesh base = Must(BaseMeshFromPositions(decoded.mesh, info.base_step != 0 ? info.base_step : decoded.step), name);
  const Size size = RunAndMeasureMemory(state, [&] {
    ProgressiveDecoder decoder = Must(ProgressiveDecoder::Create(base, {}), name);
    if (!decoder.Append(parts.refinement).ok()) std::exit(1);
    return Size{decoder.mesh().positions.size(), base.triangles.size() << 2 * decoder.level()};
  });
  state.SetItemsProcessed(state.iterations() * static_cast<int64_t>(size.vertices));
}

Bytes EncodeStock(const TriangleMesh& mesh, const std::string& name) {
  draco::Encoder encoder;
  encoder.SetSpeedOptions(kDracoSpeed, kDracoSpeed);
  encoder.SetAttributeQuantization(draco::GeometryAttribute::POSITION, kDracoBits);
  draco::EncoderBuffer buffer;
  const draco::Status status = encoder.EncodeMeshToBuffer(*ToDracoMesh(mesh), &buffer);
  if (!status.ok()) {
    std::fprintf(stderr, "%s: %s\n", name.c_str(), status.error_msg());
    std::exit(1);
  }
  return Bytes(buffer.data(), buffer.data() + buffer.size());
}

void DecodeStock(benchmark::State& state, const std::string& name, const Bytes& stream) {
  const Size size = RunAndMeasureMemory(state, [&] {
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(stream.data()), stream.size());
    draco::Decoder decoder;
    auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok()) {
      std::fprintf(stderr, "%s: %s\n", name.c_str(), decoded.status().error_msg());
      std::exit(1);
    }
    return Size{decoded.value()->num_points(), decoded.value()->num_faces()};
  });
  state.SetItemsProcessed(state.iterations() * static_cast<int64_t>(size.triangles));
}

void RegisterStream(const std::string& name, const Bytes& stream) {
  const auto add = [&](const char* what, auto&& run) {
    benchmark::RegisterBenchmark((what + ("/" + name)).c_str(), run)->Unit(benchmark::kMicrosecond);
  };
  add("whole", [=](benchmark::State& state) { DecodeWhole(state, name, stream, std::nullopt); });
  add("base", [=](benchmark::State& state) { DecodeWhole(state, name, stream, 0); });
  add("levels", [=](benchmark::State& state) { DecodeLevels(state, name, stream); });
}

void RegisterStock(const std::string& name, const TriangleMesh& mesh) {
  const Bytes stream = EncodeStock(mesh, name);
  benchmark::RegisterBenchmark(("draco/" + name).c_str(), [=](benchmark::State& state) { DecodeStock(state, name, stream); })
      ->Unit(benchmark::kMicrosecond);
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
  for (int i = 1; i < argc; ++i) lacerta::RegisterFile(argv[i]);
  if (argc == 1) lacerta::RegisterTorus();
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
