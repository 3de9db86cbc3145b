#include "remesh/base_optimization.h"

#include <cstdint>

#include "remesh/base_flips.h"
#include "remesh/base_slide.h"

namespace lacerta {

void OptimizeBase(const InputSurface& surface, BaseDomain* domain, std::vector<Vec3f>* positions) {
  constexpr uint32_t kMostPoints = 40'000;                        // of base and first level
  constexpr uint32_t kEnoughPoints = 10'000, kForFlips = 2'500;  // of levels: those that slides are about in the end, and before edges turn
  constexpr int kRounds = 2;
  if (domain->topology().num_vertices + domain->topology().num_edges() > kMostPoints) return;
  for (int round = 0; round < kRounds; ++round) {
    SlideBase(surface, domain, positions, kForFlips);
    if (FlipBaseEdges(surface, domain, *positions) == 0) break;
  }
  SlideBase(surface, domain, positions, kEnoughPoints);
}

}  // namespace lacerta
