#include "baselines/remeshes.h"

#include "baselines/maps_remesh.h"
#include "draco/pierced_base.h"
#include "encoder/quantizer.h"
#include "lacerta/surface_distance.h"
#include "remesh/decimate.h"
#include "remesh/piercing.h"
#include "remesh/surface_fit.h"

namespace lacerta::baselines {

StatusOr<Remeshes> MakeRemeshes(const TriangleMesh& input, uint32_t num_base_vertices, int num_levels) {
  const auto num_vertices = static_cast<uint32_t>(input.positions.size());
  LACERTA_ASSIGN_OR_RETURN(const Topology topology, BuildTopology(num_vertices, input.triangles));
  DecimateOptions decimation;
  decimation.target_vertices = num_base_vertices;
  const CollapseHistory history = Decimate(input, topology, decimation);
  BaseDomain domain(history, history.num_collapses());
  const TriangleMesh nominal = {domain.PositionsOn(input), domain.triangles()};
  const auto step = static_cast<float>(kNominalStep * BoundingBoxDiagonal(input));

  Remeshes result;
  LACERTA_ASSIGN_OR_RETURN(result.base, EncodeBaseMesh(RoundToLattice(nominal, step)));
  domain.Reorder(result.base.vertex_map, result.base.mesh.triangles);
  const std::vector<Vec3f> positions = domain.PositionsOn(input);
  const InputSurface surface(input, topology);
  PiercingOptions piercing;
  piercing.num_levels = num_levels;
  result.normal = Pierce(surface, domain, positions, piercing);
  result.fitted = result.normal;
  FitToInput(surface, SurfaceFitOptions(), &result.fitted);
  MapsOptions maps;
  maps.num_levels = num_levels;
  result.maps = MapsRemesh(surface, domain, maps);
  return result;
}

}  // namespace lacerta::baselines
