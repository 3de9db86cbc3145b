// Speed of the triangle tree on a scan-like mesh of 81 920 triangles. Items are queries, or triangles where the tree is
// built.
#include <benchmark/benchmark.h>

#include <vector>

#include "geometry/triangle_tree.h"
#include "lacerta/surface_distance.h"
#include "shapes/shapes.h"

namespace lacerta {
namespace {

const TriangleMesh& Scan() {
  static const TriangleMesh mesh = shapes::BumpySphere(6, 0.1f, 0.0005f);
  return mesh;
}

// The scan moved outwards by `offset`, which is not quite its distance.
TriangleMesh Inflated(float offset) {
  TriangleMesh mesh = Scan();
  for (Vec3f& p : mesh.positions) p += Normalized(p) * offset;
  return mesh;
}

// Centers of the faces of the inflated scan, in tree order or scattered over it.
std::vector<Vec3f> Queries(float offset, bool coherent) {
  const TriangleMesh mesh = Inflated(offset);
  const std::vector<uint32_t> order = TriangleTree(mesh).faces_in_tree_order();
  std::vector<Vec3f> queries;
  queries.reserve(order.size());
  for (size_t k = 0; k < order.size(); ++k) {
    const Triangle& t = mesh.triangles[order[coherent ? k : k * 7919 % order.size()]];
    queries.push_back((mesh.positions[t[0]] + mesh.positions[t[1]] + mesh.positions[t[2]]) * (1.0f / 3.0f));
  }
  return queries;
}

void BM_Build(benchmark::State& state) {
  for (auto _ : state) {
    const TriangleTree tree(Scan());
    benchmark::DoNotOptimize(tree.faces_in_tree_order().data());
  }
  state.SetItemsProcessed(state.iterations() * static_cast<int64_t>(Scan().triangles.size()));
}
BENCHMARK(BM_Build)->Unit(benchmark::kMillisecond)->UseRealTime();

// Argument: distance to the mesh in millionths of its radius.
void BM_ClosestPointCoherent(benchmark::State& state) {
  const TriangleTree tree(Scan());
  const std::vector<Vec3f> queries = Queries(1e-6f * static_cast<float>(state.range(0)), true);
  for (auto _ : state) {
    uint32_t hint = SurfacePoint::kNone;
    for (const Vec3f& p : queries) hint = tree.ClosestPointNear(p, hint).point.face;
    benchmark::DoNotOptimize(hint);
  }
  state.SetItemsProcessed(state.iterations() * static_cast<int64_t>(queries.size()));
}
BENCHMARK(BM_ClosestPointCoherent)->Arg(10)->Arg(1000)->Arg(100'000)->Unit(benchmark::kMillisecond);

void BM_ClosestPointScattered(benchmark::State& state) {
  const TriangleTree tree(Scan());
  const std::vector<Vec3f> queries = Queries(1e-6f * static_cast<float>(state.range(0)), false);
  for (auto _ : state) {
    float sum = 0.0f;
    for (const Vec3f& p : queries) sum += tree.ClosestPoint(p).squared_distance;
    benchmark::DoNotOptimize(sum);
  }
  state.SetItemsProcessed(state.iterations() * static_cast<int64_t>(queries.size()));
}
BENCHMARK(BM_ClosestPointScattered)->Arg(10)->Arg(1000)->Arg(100'000)->Unit(benchmark::kMillisecond);

// Short pieces of line across the surface, as when piercing.
void BM_IntersectLine(benchmark::State& state) {
  const TriangleTree tree(Scan());
  const std::vector<Vec3f> queries = Queries(0.001f, true);
  std::vector<LineHit> hits;
  for (auto _ : state) {
    for (const Vec3f& p : queries) {
      hits.clear();
      tree.IntersectLine(p, p, -0.01f, 0.01f, &hits);
      benchmark::DoNotOptimize(hits.data());
    }
  }
  state.SetItemsProcessed(state.iterations() * static_cast<int64_t>(queries.size()));
}
BENCHMARK(BM_IntersectLine)->Unit(benchmark::kMillisecond);

// The whole two-sided measurement on all cores. Arguments: samples per side, vertices too; items are samples on both
// sides.
void BM_SurfaceDistance(benchmark::State& state) {
  const StatusOr<SurfaceDistanceMeter> meter = SurfaceDistanceMeter::Create(Scan());
  const TriangleMesh other = Inflated(0.001f);
  SurfaceDistanceOptions options;
  options.num_samples = static_cast<uint64_t>(state.range(0));
  options.max_at_vertices = state.range(1) != 0;
  for (auto _ : state) {
    const StatusOr<SurfaceDistance> distance = meter.value().Measure(other, options);
    benchmark::DoNotOptimize(distance.value().Rms());
  }
  state.SetItemsProcessed(state.iterations() * 2 * state.range(0));
}
BENCHMARK(BM_SurfaceDistance)
    ->Args({20'000, 0})
    ->Args({200'000, 0})
    ->Args({200'000, 1})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

}  // namespace
}  // namespace lacerta

BENCHMARK_MAIN();
