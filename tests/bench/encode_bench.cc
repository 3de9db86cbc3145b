// Time of every stage of encoding by itself, in the order in which they come: encode_bench [--benchmark_...] [FILE...]
//
// Each stage works on what the ones before made of a mesh file or, without files, of a bumpy sphere of 82 thousand triangles and, for those
// of attributes, of a textured torus of 16 thousand. Time is that of all cores together and of the clock; items are triangles of the
// input or, of "descend", "write" and "base_...", coefficients and triangles of the base. Entropy coding of other steps, closest points and
// piercing lines, and paper mode's allocation have benches of their own. "encode" is the whole at 70 dB, which tries many bases and slopes.
#include <benchmark/benchmark.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "bench/must.h"
#include "draco/base_mesh_codec.h"
#include "draco/pierced_base.h"
#include "draco/zero_level.h"
#include "encoder/coefficient_descent.h"
#include "encoder/quantizer.h"
#include "encoder/step_law.h"
#include "encoder/stream_writer.h"
#include "encoder/surface_target.h"
#include "geometry/group_surface.h"
#include "lacerta/clean.h"
#include "lacerta/codec.h"
#include "lacerta/decoder.h"
#include "lacerta/mesh_file.h"
#include "lacerta/surface_distance.h"
#include "remesh/attributed_remesh.h"
#include "remesh/attributed_simplify.h"
#include "remesh/decimate.h"
#include "remesh/input_surface.h"
#include "remesh/simplify.h"
#include "remesh/surface_fit.h"
#include "remesh/surface_parts.h"
#include "shapes/attributed_shapes.h"
#include "shapes/shapes.h"

namespace lacerta {
namespace {

constexpr double kPsnr = 70;      // of the stream that the stages of one stream code
constexpr int kNumLevels = 4;
constexpr uint32_t kInputOverBase = 128;  // vertices: four levels above it have twice as many as the input

// Runs `stage`, which returns what it makes, over and over. num_bytes: of that, or 0.
template <typename Stage>
void Register(const std::string& what, const std::string& name, size_t num_items, const Stage& stage, size_t num_bytes = 0) {
  benchmark::RegisterBenchmark((what + "/" + name).c_str(), [=](benchmark::State& state) {
    for (auto _ : state) benchmark::DoNotOptimize(stage());
    state.SetItemsProcessed(state.iterations() * static_cast<int64_t>(num_items));
    if (num_bytes > 0) state.counters["bytes"] = static_cast<double>(num_bytes);
  })->Unit(benchmark::kMillisecond)->MeasureProcessCPUTime()->UseRealTime();
}

// What the stages have made of one input, each of what stands above it.
struct Stages {
  explicit Stages(TriangleMesh mesh, const std::string& name)
      : input(std::move(mesh)),
        cleaned(Must(Clean(input), name).mesh),
        parts(SplitSurface(cleaned)),
        surface(parts.refined, parts.topology),
        history(Decimate(parts.refined, parts.topology, DecimateOptions())),
        pierced(Must(PierceUnreversed({surface, history, no_still}, NumBaseVertices(), kNumLevels), name)),
        fitted(Fitted()),
        target(MakeSurfaceTarget(fitted)),
        first(FirstRounding()),
        coded(Descended()) {}

  uint32_t NumBaseVertices() const { return static_cast<uint32_t>(cleaned.positions.size()) / kInputOverBase; }
  NormalMesh Fitted() const {
    NormalMesh mesh = pierced->Remesh();
    FitToInput(surface, SurfaceFitOptions(), &mesh);
    return mesh;
  }
  // Of a stream of about kPsnr: where rate is dear, every fourth vertex has a coefficient that counts, and each of these halves its error by a bit.
  double Lambda() const {
    const double distance = DistanceOfPsnr(kPsnr, BoundingBoxDiagonal(input));
    return 1.4 * distance * distance / (0.25 * static_cast<double>(target.points.size()));
  }
  CodedSurface FirstRounding() const {
    const uint32_t num_base = fitted.mesh.num_base_vertices;
    const std::vector<Vec3f> base(target.points.begin(), target.points.begin() + num_base);
    const BaseMesh lattice = RoundToLattice({base, fitted.mesh.base_triangles}, static_cast<float>(BaseStepForSlope(Lambda(), num_base)));
    return QuantizeClosedLoop(target, lattice, StepsForSlope(target, DetailScales(target), Lambda()));
  }
  CodedSurface Descended() const {
    DescentOptions options;
    options.lambda = Lambda();
    return Descend(target, first, options);
  }
  RefinementBytes Written() const {
    return WriteRefinement(coded.base, Span<const Topology>(target.topologies.data(), coded.levels.size()), coded.steps, coded.levels, fitted.mesh.tags).value();
  }

  const TriangleMesh input, cleaned, no_still;
  const SurfaceParts parts;
  const InputSurface surface;
  const CollapseHistory history;
  const std::unique_ptr<PiercedBase> pierced;
  const NormalMesh fitted;
  const SurfaceTarget target;
  const CodedSurface first, coded;
};

void RegisterPositions(const std::string& name, TriangleMesh mesh) {
  const auto s = std::make_shared<const Stages>(std::move(mesh), name);
  const size_t num_triangles = s->input.triangles.size(), num_coefficients = 3 * (s->target.points.size() - s->fitted.mesh.num_base_vertices),
               num_base_triangles = s->coded.base.triangles.size();
  Register("clean", name, num_triangles, [=] { return Clean(s->input); });
  Register("split_surface", name, num_triangles, [=] { return SplitSurface(s->cleaned); });
  Register("input_surface", name, num_triangles, [=] { return InputSurface(s->parts.refined, s->parts.topology).tree().faces_in_tree_order().size(); });
  Register("decimate", name, num_triangles, [=] { return Decimate(s->parts.refined, s->parts.topology, DecimateOptions()); });
  Register("remesh", name, num_triangles, [=] { return PierceUnreversed({s->surface, s->history, s->no_still}, s->NumBaseVertices(), kNumLevels); });
  Register("fit", name, num_triangles, [=] { return s->Fitted(); });
  Register("surface_target", name, num_triangles, [=] { return MakeSurfaceTarget(s->fitted); });
  Register("closed_loop", name, num_coefficients, [=] { return s->FirstRounding(); });
  Register("descend", name, num_coefficients, [=] { return s->Descended(); });
  Register("write", name, num_coefficients, [=] { return s->Written(); }, s->Written().bytes.size());
  for (const auto& [coding, kind] : {std::pair{BaseCoding::kStock, "base_draco"}, {BaseCoding::kCompact, "base_compact"}}) {
    const auto encode = [s, coding = coding] { return EncodeBaseMesh(s->coded.base, coding); };
    Register(kind, name, num_base_triangles, encode, Must(encode(), name).stream.size());
  }
  Register("base_recoded", name, num_base_triangles, [=] { return RecodeBaseMesh(s->pierced->base(), s->coded.base); });
  Register("measure", name, num_triangles, [=] {
    const TriangleMesh finest = MeshAtLevel(s->fitted.mesh, kNumLevels).value();
    return SurfaceDistanceMeter::Create(s->input).value().Measure(finest, SurfaceDistanceOptions::RmsOnly());
  });
  Register("simplify", name, num_triangles, [=] { return SimplificationSequence(s->cleaned); });
  constexpr int kBits = 12;
  Register("no_levels", name, num_triangles, [=] { return EncodeZeroLevel(s->cleaned, kBits); });
  Register("encode", name, num_triangles, [=] { return EncodeMesh(s->input, EncodeOptions()); });
}

// The same of a surface with attributes.
struct AttributedStages {
  explicit AttributedStages(AttributedMesh mesh, const std::string& name)
      : input(std::move(mesh)),
        parts(Must(SplitAttributedSurface(input), name)),
        history(Must(DecimateAttributed(parts), name)),
        surface(parts.refined.surface, parts.topology),
        remeshed(Must(Remeshed(), name).Semiregular()) {}

  StatusOr<AttributedNormalMesh> Remeshed() const { return RemeshAttributed(parts, surface, history, AttributedRemeshOptions()); }

  const AttributedMesh input;
  const AttributedParts parts;
  const CollapseHistory history;
  const InputSurface surface;
  const AttributedSemiRegularMesh remeshed;
};

void RegisterAttributed(const std::string& name, AttributedMesh mesh) {
  const auto s = std::make_shared<const AttributedStages>(std::move(mesh), name);
  const size_t num_triangles = s->input.surface.triangles.size();
  Register("attributed_split", name, num_triangles, [=] { return SplitAttributedSurface(s->input); });
  Register("attributed_decimate", name, num_triangles, [=] { return DecimateAttributed(s->parts); });
  Register("attributed_remesh", name, num_triangles, [=] { return s->Remeshed(); });
  Register("attributed_fit", name, num_triangles, [=] {
    AttributedSemiRegularMesh fitted = s->remeshed;
    FitLevelAttributes(GroupSurface(s->input), &fitted);
    return fitted;
  });
  Register("attributed_simplify", name, num_triangles, [=] {
    return AttributedSimplification(s->input, std::vector<double>(s->input.attributes.size(), 1e-3)).fewest_triangles();
  });
}

}  // namespace
}  // namespace lacerta

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  for (int i = 1; i < argc; ++i) {
    const std::string name = std::filesystem::path(argv[i]).stem().string();
    lacerta::RegisterPositions(name, lacerta::Must(lacerta::ReadMeshFile(argv[i]), argv[i]));
  }
  if (argc == 1) {
    lacerta::RegisterPositions("sphere", lacerta::shapes::BumpySphere(6, 0.1f, 0.004f));
    lacerta::RegisterAttributed("torus", lacerta::Must(lacerta::WeldSoups(lacerta::shapes::HalvedTorus(128, 64)), "torus"));
  }
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
