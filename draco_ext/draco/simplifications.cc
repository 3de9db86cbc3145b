#include "draco/simplifications.h"

#include <array>
#include <optional>
#include <utility>

#include "geometry/for_each_branch.h"
#include "remesh/decimate.h"

namespace lacerta {

std::vector<CollapseHistory> Simplifications(const InputSurface& surface, const Topology& topology, size_t count) {
  constexpr std::array<double, kMostSimplifications> kAspectPowers = {1.0, 2.0};  // of DecimateOptions
  std::vector<std::optional<CollapseHistory>> made(count);
  ForEachBranch(count, [&](size_t i) {
    DecimateOptions options;
    options.aspect_power = kAspectPowers[i];
    made[i].emplace(Decimate(surface.mesh(), topology, options));
  });
  std::vector<CollapseHistory> histories;
  histories.reserve(count);
  for (std::optional<CollapseHistory>& history : made) histories.push_back(*std::move(history));
  return histories;
}

}  // namespace lacerta
