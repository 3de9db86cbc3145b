#include "draco/usual_base.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "draco/decoded_distance.h"
#include "geometry/vertex_area_vectors.h"
#include "remesh/base_domain.h"
#include "remesh/base_parts.h"

namespace lacerta {

double UsualBasePsnr(double psnr) { return 41 + 0.6 * (psnr - 70); }
double UsualAskewShare(double psnr) { return 0.018 * std::pow(10.0, -0.035 * (psnr - 70)); }

double BasePsnr(const RefinableSurface& surface, uint32_t num_vertices, const SurfaceDistanceMeter& meter) {
  constexpr uint64_t kFewSamples = 5'000;
  const BaseDomain domain(surface.history, surface.history.CollapsesTo(num_vertices));
  const TriangleMesh base = Together({domain.PositionsOn(surface.surface.mesh()), domain.triangles()}, surface.still);
  return DecodedPsnr(meter, base, kFewSamples);
}

double AskewShare(const RefinableSurface& surface, uint32_t num_vertices) {
  constexpr size_t kEnoughFaces = 10'000;
  constexpr double kCosine = 0.5;
  constexpr Vec3d kCentroid{1.0 / 3, 1.0 / 3, 1.0 / 3};
  const TriangleMesh& input = surface.surface.mesh();
  const BaseDomain domain(surface.history, surface.history.CollapsesTo(num_vertices));
  const std::vector<Vec3f> base = domain.PositionsOn(input);
  std::vector<DomainPoint> on_input;
  const size_t stride = std::max<size_t>(1, input.triangles.size() / kEnoughFaces);
  for (size_t f = 0; f < input.triangles.size(); f += stride) on_input.push_back({static_cast<uint32_t>(f), kCentroid});
  std::vector<DomainPoint> on_base = on_input;
  domain.FromInput(&on_base);
  double area = 0, askew = 0;
  for (size_t i = 0; i < on_input.size(); ++i) {
    const double of_face = Norm(AreaVector(input.positions, input.triangles[on_input[i].face]));
    const Vec3d of_base = AreaVector(base, domain.triangles()[on_base[i].face]);
    area += of_face;
    if (Dot(of_base, Vec3Cast<double>(surface.surface.NormalAt(on_input[i].face, kCentroid))) < kCosine * Norm(of_base)) askew += of_face;
  }
  return area > 0 ? askew / area : 0;
}

}  // namespace lacerta
