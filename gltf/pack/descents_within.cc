#include "pack/descents_within.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "geometry/for_each_branch.h"
#include "geometry/root_bracket.h"
#include "pack/value_descent.h"

namespace lacerta {
namespace {

// Normals are predicted well, so that finer lattices let more of them be what is predicted; others gain by coarser ones, on which neighbors' errors cancel out.
std::vector<int> LevelsNear(const RoundedAttribute& attribute, int level) {
  std::vector<int> levels;
  for (const int finer : attribute.octahedral ? std::vector<int>{0, kLevelsPerBit, 2 * kLevelsPerBit} : std::vector<int>{-3, -2, -1, 0}) {
    if (level + finer >= attribute.FirstLevel() && level + finer <= kMostLevel) levels.push_back(level + finer);
  }
  return levels;
}

// Of errors with next to no slope those that are worth a search: of directions about the coarsest lattice that leaves half of what is allowed, the coarsest
// ones of others.
std::vector<size_t> Promising(const std::vector<DescendedValues>& flattest, double most_error, bool octahedral) {
  constexpr size_t kMost = 2;
  constexpr double kShare = 0.5;
  std::vector<size_t> promising;
  for (size_t i = 0; i < flattest.size(); ++i) {
    if (flattest[i].error > most_error) continue;
    const bool is_late = octahedral && i + 1 < flattest.size() && flattest[i + 1].error > kShare * most_error;
    if (!is_late) promising.push_back(i);
    if (promising.size() == kMost) break;
  }
  return promising;
}

}  // namespace

std::vector<DescendedValues> DescentsWithin(const std::vector<const Primitive*>& primitives, const std::vector<std::vector<Vec3f>>& positions,
                                            const RoundedAttribute& attribute, const std::vector<AccessorData>& values, int level, double most_error,
                                            const std::function<double(const std::vector<AccessorData>&)>& error_of) {
  constexpr double kMostErrorShare = 4.0;              // of a single value, over what is allowed in the mean
  constexpr double kFlattest = -7.0, kUsual = -0.75, kStride = 1.75, kSteepest = 3.0;  // powers of 2, of the squared target over the number of values
  constexpr double kNear = -0.01, kTiny = 1e-6;        // of the error over what is allowed; the first its logarithm
  constexpr int kMostSteps = 5;
  const std::vector<int> levels = LevelsNear(attribute, level);
  std::vector<std::unique_ptr<ValueDescent>> descents(levels.size());
  std::vector<DescendedValues> results(levels.size());
  const auto descended = [&](size_t i, double power) {
    const double slope = attribute.target * attribute.target / static_cast<double>(descents[i]->num_values()) * std::exp2(power);
    DescendedValues result{levels[i], descents[i]->At(slope), 0.0};
    result.error = error_of(result.values);
    return result;
  };
  ForEachBranch(levels.size(), [&](size_t i) {
    descents[i] = std::make_unique<ValueDescent>(primitives, positions, attribute, values, levels[i], kMostErrorShare * attribute.target);
    results[i] = descended(i, kFlattest);
  });
  const std::vector<size_t> promising = Promising(results, most_error, attribute.octahedral);
  ForEachBranch(promising.size(), [&](size_t p) {
    const size_t i = promising[p];
    const auto logarithm = [&](double error) { return std::log(std::max(error / most_error, kTiny)); };
    RootBracket bracket({kFlattest, logarithm(results[i].error)}, {kSteepest, RootBracket::kUnknown});
    double power = kUsual;
    for (int step = 0; step < kMostSteps && logarithm(results[i].error) < kNear; ++step) {
      DescendedValues result = descended(i, power);
      bracket.Narrow({power, logarithm(result.error)});
      if (result.error <= most_error) results[i] = std::move(result);
      power = bracket.IsKnown() ? bracket.Next() : std::min(power + kStride, kSteepest);
    }
  });
  std::vector<DescendedValues> kept;
  kept.reserve(promising.size());
  for (const size_t i : promising) kept.push_back(std::move(results[i]));
  return kept;
}

}  // namespace lacerta
