// exploratory
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <string>

#include "bench/gltf_surfaces.h"
#include "lacerta/attribute_distance.h"
#include "lacerta/surface_distance.h"
#include "remesh/attributed_simplify.h"

using namespace lacerta;

static size_t NumWedges(const AttributedMesh& m) {
  uint32_t g = 0;
  for (uint32_t x : m.groups) g = std::max(g, x + 1);
  size_t n = 0;
  for (auto& s : SplitIntoSoups(m, std::max(g, 1u))) n += s.positions.size();
  return n;
}
static double Now() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

int main(int argc, char** argv) {
  double uvw = 1, nw = 1;
  if (getenv("UVW")) uvw = atof(getenv("UVW"));
  if (getenv("NW")) nw = atof(getenv("NW"));
  const double eps = 3.16e-4;
  std::vector<double> shares = {1, 0.5, 0.25, 0.12, 0.06};
  for (int i = 1; i < argc; ++i) {
    auto surfaces = ReadGltfSurfaces(argv[i]);
    if (!surfaces.ok()) { printf("%s: %s\n", argv[i], surfaces.status().message().c_str()); continue; }
    for (auto& s : surfaces.value()) {
      auto check = CheckAttributedMesh(s.mesh);
      if (!check.ok()) { printf("%s: %s\n", s.name.c_str(), check.message().c_str()); continue; }
      const WedgeMesh w = MakeWedgeMesh(s.mesh);
      size_t n[3] = {};
      for (auto f : w.freedom) ++n[int(f)];
      std::vector<double> weights;
      printf("%s: %zu wedges %zu v %zu f; surface %zu curve %zu fixed %zu;", s.name.c_str(), NumWedges(s.mesh), s.mesh.surface.positions.size(), s.mesh.surface.triangles.size(), n[0], n[1], n[2]);
      for (auto& a : s.mesh.attributes) {
        double unit = a.kind == AttributeKind::kTextureCoordinates ? 1024 * uvw : a.kind == AttributeKind::kNormal || a.kind == AttributeKind::kTangent ? 28.65 * nw : 100;
        weights.push_back(eps * unit);
        printf(" %s(%u)", a.name.c_str(), a.num_values());
      }
      double t0 = Now();
      const AttributedSimplification simp(s.mesh, weights);
      double t1 = Now();
      printf(" fewest %u  %.2f s\n", simp.fewest_triangles(), t1 - t0);
      auto meter = SurfaceDistanceMeter::Create(s.mesh.surface);
      auto ameter = AttributeDistanceMeter::Create(s.mesh);
      if (!meter.ok() || !ameter.ok()) { printf("no meter\n"); continue; }
      for (double share : shares) {
        AttributedMesh m = simp.MeshWith(uint32_t(share * simp.num_input_triangles()));
        auto check2 = CheckAttributedMesh(m);
        if (!check2.ok()) printf("BAD %s\n", check2.message().c_str());
        auto d = meter.value().Measure(m.surface, SurfaceDistanceOptions::RmsOnly(50000));
        AttributeDistanceOptions o; o.num_samples = 50000;
        double t2 = Now();
        auto ad = ameter.value().Measure(m, o);
        double t3 = Now();
        printf("  %5zu f %5.1f%% %zu wedges %.1f%% psnr %.1f", m.surface.triangles.size(), 100 * share, NumWedges(m), 100.0 * double(NumWedges(m)) / double(NumWedges(s.mesh)), Psnr(d.value().Rms(), meter.value().diagonal()));
        if (!ad.ok()) { printf("%s\n", ad.status().message().c_str()); continue; }
        for (size_t a = 0; a < s.mesh.attributes.size(); ++a) {
          auto e = ad.value().Worst(a), f = ad.value().forward[a];
          printf(" | %s %.3f/%.3f max %.1f (fwd %.3f)", s.mesh.attributes[a].name.c_str(), e.rms_99, e.rms, e.max, f.rms_99);
        }
        printf("  [%.2fs]\n", t3 - t2);
      }
    }
  }
}
