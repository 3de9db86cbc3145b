// A budget in bytes shared by the parts of a scene so that the scene's error is least: at the optimum the last byte of each lowers the
// squared error, summed over the scene, by the same (Lagrangian rate allocation, Shoham and Gersho 1988).
#ifndef LACERTA_PACK_SCENE_BUDGET_H_
#define LACERTA_PACK_SCENE_BUDGET_H_

#include <cstddef>
#include <vector>

namespace lacerta {

// The qualities that can be asked for: PSNR in dB, of the scene.
inline constexpr size_t kQualitySteps = 221;
inline double PsnrOfStep(size_t step) { return 20.0 + 0.5 * static_cast<double>(step); }

// What a part took when it was coded for a quality. Errors here are squared and summed over the scene.
struct RatePoint {
  size_t step = 0;  // of the quality
  double bytes = 0.0;
  double error = 0.0;
};

// A part of the scene.
struct RateCurve {
  std::vector<double> expected;  // error at every quality, kQualitySteps; never rising
  std::vector<RatePoint> known;  // at least one, no two of one quality
};

// For each part the quality at which the error of all is expected to be least while their bytes stay within the budget: between
// two qualities that are known bytes go as a power of the error, beyond them as they do nearby, up to 20 dB away.
std::vector<size_t> ShareBudget(const std::vector<RateCurve>& curves, double budget);

// Whether what is known meets a quality, while what was asked for was not a higher one.
bool IsKnown(const RateCurve& curve, size_t step);

// The bytes and the error expected for a part at a quality.
double ExpectedBytes(const RateCurve& curve, size_t step);
double ExpectedError(const RateCurve& curve, size_t step);

// Of what is known: for each part the index in RateCurve::known. The error of all is the least that is found within the budget; where
// the smallest of all parts exceed it, these.
std::vector<size_t> ChooseKnown(const std::vector<RateCurve>& curves, double budget);

}  // namespace lacerta

#endif  // LACERTA_PACK_SCENE_BUDGET_H_
