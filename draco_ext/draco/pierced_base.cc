#include "draco/pierced_base.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "common/base_tags.h"
#include "encoder/quantizer.h"
#include "lacerta/surface_distance.h"
#include "remesh/base_optimization.h"
#include "remesh/base_parts.h"
#include "remesh/piercing.h"
#include "remesh/reversal.h"

namespace lacerta {

StatusOr<std::unique_ptr<PiercedBase>> PiercedBase::Make(const RefinableSurface& input, uint32_t time, std::vector<uint32_t> held, BaseCoding coding) {
  BaseDomain domain(input.history, input.history.CutWithout(held, time));
  const uint32_t num_refined = domain.num_vertices();
  std::vector<Vec3f> slid = domain.PositionsOn(input.surface.mesh());
  OptimizeBase(input.surface, &domain, &slid);
  const TriangleMesh nominal = Together({slid, domain.triangles()}, input.still);
  const auto nominal_step = static_cast<float>(kNominalStep * BoundingBoxDiagonal(nominal));
  LACERTA_ASSIGN_OR_RETURN(CodedBase base, EncodeBaseMesh(RoundToLattice(nominal, nominal_step), coding));

  // From here on in the order in which decoders get the base.
  const auto is_still = [&](const Triangle& t) { return base.vertex_map[t[0]] >= num_refined; };
  std::vector<Triangle> split;
  std::copy_if(base.mesh.triangles.begin(), base.mesh.triangles.end(), std::back_inserter(split), [&](const Triangle& t) { return !is_still(t); });
  std::vector<uint8_t> still;
  if (!input.still.triangles.empty()) {
    for (const Triangle& t : base.mesh.triangles) still.push_back(is_still(t));
  }
  domain.Reorder(base.vertex_map, split);
  std::vector<Vec3f> positions;
  for (const uint32_t v : base.vertex_map) positions.push_back(nominal.positions[v]);
  domain.Join(JoinedVertices(positions));
  return std::unique_ptr<PiercedBase>(
      new PiercedBase(input, std::move(base), std::move(domain), positions, std::move(still), std::move(held)));
}

PiercedBase::PiercedBase(const RefinableSurface& input, CodedBase base, BaseDomain domain, const std::vector<Vec3f>& positions,
                         std::vector<uint8_t> is_still, std::vector<uint32_t> held)
    : surface_(input.surface),
      held_(std::move(held)),
      base_(std::move(base)),
      is_still_(std::move(is_still)),
      domain_(std::move(domain)),
      pierced_(surface_, domain_, positions, PiercingOptions()) {}

void PiercedBase::PierceTo(int num_levels) {
  while (pierced_.num_levels() < num_levels) pierced_.AddLevel();
}

NormalMesh PiercedBase::Remesh() const {
  NormalMesh result = pierced_.mesh();
  result.mesh.base_triangles = base_.mesh.triangles;
  result.mesh.tags.still = is_still_;
  return result;
}

StatusOr<std::unique_ptr<PiercedBase>> PierceUnreversed(const RefinableSurface& input, uint32_t num_base_vertices, int num_levels,
                                                        BaseCoding coding, std::unique_ptr<PiercedBase> begun) {
  // Of a base that is made finer where the remesh is reversed: a surface that needs more is better served by the next size.
  constexpr double kLargestGrowth = 1.25;
  constexpr double kFreeVertices = 8;  // that any base may have more
  const auto num_vertices = static_cast<uint32_t>(input.surface.mesh().positions.size());
  const uint32_t time = input.history.CollapsesTo(num_base_vertices);
  std::unique_ptr<PiercedBase> best = std::move(begun);
  if (!best) {
    LACERTA_ASSIGN_OR_RETURN(best, PiercedBase::Make(input, time, {}, coding));
  }
  best->PierceTo(num_levels);
  ReversedPart reversed = FindReversed(input.surface, best->refined());
  double least = reversed.share;
  std::vector<uint32_t> held = best->held();
  bool is_due = HoldReversed(reversed, best->domain(), &held);
  const double first_base = num_vertices - time + static_cast<double>(input.still.positions.size());  // nothing held
  const double largest_base = std::max(kLargestGrowth * first_base, first_base + kFreeVertices);
  for (int round = 1; is_due && round < kReversalRounds; ++round) {
    LACERTA_ASSIGN_OR_RETURN(std::unique_ptr<PiercedBase> finer, PiercedBase::Make(input, time, held, coding));
    if (finer->num_vertices() > largest_base) break;
    finer->PierceTo(num_levels);
    reversed = FindReversed(input.surface, finer->refined());
    is_due = HoldReversed(reversed, finer->domain(), &held);
    if (reversed.share >= least) continue;
    least = reversed.share;
    best = std::move(finer);
  }
  return best;
}

}  // namespace lacerta
