// A base mesh of a candidate with the levels pierced so far.
#ifndef LACERTA_DRACO_PIERCED_BASE_H_
#define LACERTA_DRACO_PIERCED_BASE_H_

#include <cstdint>
#include <memory>
#include <vector>

#include "draco/base_mesh_codec.h"
#include "draco/refinable_surface.h"
#include "lacerta/remesh.h"
#include "remesh/base_domain.h"
#include "remesh/growing_normal_mesh.h"

namespace lacerta {

// Step of the base lattice while the order of the base is found, as a share of the diagonal.
inline constexpr double kNominalStep = 5e-4;

class PiercedBase {
 public:
  // The base at the first `time` collapses of the history without those of `held` (CollapseHistory::CutWithout), with the still part beside it.
  // What `input` refers to must outlive the result. Fails where the base cannot be coded.
  static StatusOr<std::unique_ptr<PiercedBase>> Make(const RefinableSurface& input, uint32_t time, std::vector<uint32_t> held, BaseCoding coding);

  PiercedBase(const PiercedBase&) = delete;
  PiercedBase& operator=(const PiercedBase&) = delete;

  // Pierces the levels that are missing up to num_levels.
  void PierceTo(int num_levels);

  // The remesh over base().mesh, in its order: its vertices are points of the input.
  NormalMesh Remesh() const;
  // The same without the still part.
  const NormalMesh& refined() const { return pierced_.mesh(); }

  const CodedBase& base() const { return base_; }  // at a nominal step
  const BaseDomain& domain() const { return domain_; }
  uint32_t num_vertices() const { return static_cast<uint32_t>(base_.vertex_map.size()); }  // those of the still part too
  const std::vector<uint32_t>& held() const { return held_; }
  int num_levels() const { return pierced_.num_levels(); }

 private:
  // domain: reordered as the base is.
  PiercedBase(const RefinableSurface& input, CodedBase base, BaseDomain domain, const std::vector<Vec3f>& positions, std::vector<uint8_t> is_still,
              std::vector<uint32_t> held);

  const InputSurface& surface_;
  const std::vector<uint32_t> held_;
  const CodedBase base_;
  const std::vector<uint8_t> is_still_;  // #F0 of base_, 1 for triangles of the still part; empty where there is none
  const BaseDomain domain_;
  GrowingNormalMesh pierced_;
};

// The base that the history has at `num_base_vertices` vertices, or its coarsest if that is larger, with the still part beside it and
// num_levels pierced; up to a quarter or 8 vertices finer where the remesh would be reversed (remesh/reversal.h). begun: that of the same input
// and size with fewer levels, from which it goes on, or null. Fails where the base cannot be coded.
StatusOr<std::unique_ptr<PiercedBase>> PierceUnreversed(const RefinableSurface& input, uint32_t num_base_vertices, int num_levels,
                                                        BaseCoding coding = BaseCoding::kStock, std::unique_ptr<PiercedBase> begun = nullptr);

}  // namespace lacerta

#endif  // LACERTA_DRACO_PIERCED_BASE_H_
