// Whole codecs at one surface error, in one process: compare_bench [--benchmark_...] PSNR FILE...
//
// For each mesh file: ours in both forms and without levels (simplified, then Draco), and stock Draco and meshoptimizer on the original mesh with the
// fewest bits that reach the PSNR (dB, of the two-sided surface distance to the file's mesh, measured alike for all). "encode" is once,
// with the search of ours for its target and without theirs for the bits; "decode" over and over on one thread, to positions and
// triangles. Counters of encoding: bytes, and PSNR and triangles of what is decoded.
#include <benchmark/benchmark.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <utility>

#include "bench/must.h"
#include "bench/other_codecs.h"
#include "draco/base_mesh_codec.h"
#include "lacerta/codec.h"
#include "lacerta/mesh_file.h"
#include "lacerta/surface_distance.h"

namespace lacerta {
namespace {

struct Input {
  explicit Input(const std::string& path)
      : name(std::filesystem::path(path).stem().string()), mesh(Must(ReadMeshFile(path), path)), meter(Must(SurfaceDistanceMeter::Create(mesh), path)) {}

  double PsnrOf(const TriangleMesh& other) const {
    return Psnr(Must(meter.Measure(other, SurfaceDistanceOptions::RmsOnly()), name).Rms(), meter.diagonal());
  }

  const std::string name;
  const TriangleMesh mesh;
  const SurfaceDistanceMeter meter;
};

// A codec with all that it is told: what it makes of a mesh, and that again.
template <typename Coded>
struct Codec {
  std::string name;
  std::function<Coded(const TriangleMesh& mesh)> encode;
  std::function<TriangleMesh(const Coded& coded)> to_mesh;
  std::function<size_t(const Coded& coded)> decode;  // as its users do; returns the number of triangles
};

template <typename Coded>
void Register(const std::shared_ptr<const Input>& input, const Codec<Coded>& codec) {
  const auto coded = std::make_shared<Coded>();
  const auto encode = [=](benchmark::State& state) {
    for (auto _ : state) *coded = codec.encode(input->mesh);
    const TriangleMesh mesh = codec.to_mesh(*coded);
    state.counters["bytes"] = static_cast<double>(coded->size());
    state.counters["psnr"] = input->PsnrOf(mesh);
    state.counters["triangles"] = static_cast<double>(mesh.triangles.size());
    state.counters["input_triangles"] = static_cast<double>(input->mesh.triangles.size());
  };
  const auto decode = [=](benchmark::State& state) {
    if (coded->size() == 0) *coded = codec.encode(input->mesh);  // where a filter left encoding out
    size_t num_triangles = 0;
    for (auto _ : state) num_triangles = codec.decode(*coded);
    state.SetItemsProcessed(state.iterations() * static_cast<int64_t>(num_triangles));
  };
  const auto name_of = [&](const char* what) { return what + ("/" + codec.name + "/") + input->name; };
  benchmark::RegisterBenchmark(name_of("encode").c_str(), encode)->Iterations(1)->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
  benchmark::RegisterBenchmark(name_of("decode").c_str(), decode)->Unit(benchmark::kMillisecond);
}

void RegisterOurs(const std::shared_ptr<const Input>& input, const std::string& name, const EncodeOptions& options) {
  const auto decode = [=](const Bytes& stream) { return Must(DecodeMesh(stream, {}), input->name).mesh; };
  Register<Bytes>(input, {name, [=](const TriangleMesh& mesh) { return Must(EncodeMesh(mesh, options), input->name).stream; }, decode,
                          [=](const Bytes& stream) { return decode(stream).triangles.size(); }});
}

// The fewest bits, of at most `most`, with which a codec reaches the PSNR.
int FewestBits(const Input& input, double psnr, int most, const std::function<TriangleMesh(int bits)>& coded) {
  constexpr int kFewest = 4;
  int bits = kFewest;
  while (bits < most && input.PsnrOf(coded(bits)) < psnr) ++bits;
  return bits;
}

void RegisterDraco(const std::shared_ptr<const Input>& input, double psnr) {
  constexpr int kMostBits = 24;
  const auto to_mesh = [=](const Bytes& stream) { return Must(DecodeBaseMesh(stream, {}), input->name).mesh; };
  const int bits = FewestBits(*input, psnr, kMostBits, [&](int b) { return to_mesh(Must(EncodeByDraco(input->mesh, b), input->name)); });
  Register<Bytes>(input, {"draco", [=](const TriangleMesh& mesh) { return Must(EncodeByDraco(mesh, bits), input->name); }, to_mesh,
                          [=](const Bytes& stream) { return size_t{Must(DecodeByDraco(stream), input->name)->num_faces()}; }});
}

#ifdef LACERTA_HAVE_MESHOPTIMIZER
void RegisterMeshopt(const std::shared_ptr<const Input>& input, double psnr) {
  constexpr int kMostBits = 16;
  const auto to_mesh = [=](const MeshoptStreams& coded) { return Must(DecodeByMeshopt(coded), input->name); };
  const int bits = FewestBits(*input, psnr, kMostBits, [&](int b) { return to_mesh(EncodeByMeshopt(input->mesh, b)); });
  Register<MeshoptStreams>(input, {"meshopt", [=](const TriangleMesh& mesh) { return EncodeByMeshopt(mesh, bits); }, to_mesh,
                                   [=](const MeshoptStreams& coded) { return to_mesh(coded).triangles.size(); }});
}
#endif

void RegisterFile(const std::string& path, double psnr) {
  const auto input = std::make_shared<const Input>(path);
  EncodeOptions options;
  options.target = {EncodeTarget::Kind::kPsnr, psnr};
  RegisterOurs(input, "lacerta", options);
  options.form = StreamForm::kCustom;
  RegisterOurs(input, "lacerta_custom", options);
  options.form = StreamForm::kDraco;
  options.levels = LevelChoice::kNever;
  RegisterOurs(input, "lacerta_no_levels", options);
  RegisterDraco(input, psnr);
#ifdef LACERTA_HAVE_MESHOPTIMIZER
  RegisterMeshopt(input, psnr);
#endif
}

}  // namespace
}  // namespace lacerta

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  const double psnr = argc > 1 ? std::strtod(argv[1], nullptr) : 0;
  if (argc < 3 || !(psnr > 0)) return std::fprintf(stderr, "usage: compare_bench [--benchmark_...] PSNR FILE...\n"), 2;
  for (int i = 2; i < argc; ++i) lacerta::RegisterFile(argv[i], psnr);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
