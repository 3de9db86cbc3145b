// What the models of a coefficient set begin with: probabilities in 1/256, as they were in the mean of streams of two dozen scanned and
// sculpted meshes at 60 to 76 dB. They count as kPriorBits bits, so that a stream of a few hundred coefficients need not learn what all
// have in common; sets of a thousand have their own way (docs/decisions/0005-entropy-contexts.md). Specified in docs/format.md,
// "Binarization".
#ifndef LACERTA_COMMON_COEFFICIENT_PRIORS_H_
#define LACERTA_COMMON_COEFFICIENT_PRIORS_H_

#include <array>
#include <cstdint>

namespace lacerta {

inline constexpr int kNumActivityClasses = 14;  // of the expected magnitude
inline constexpr int kNumSignClasses = 8;
inline constexpr uint32_t kPriorBits = 16;

struct SetPriors {
  static constexpr int kNumCompanions = 3;  // of normal sets: length classes; those on curves begin like the others
  static constexpr int kNumSteps = 4;       // the last one holds for all longer magnitudes
  std::array<std::array<uint8_t, kNumCompanions>, kNumActivityClasses> nonzero;
  std::array<uint8_t, kNumSignClasses> unexpected_sign;
  std::array<std::array<uint8_t, kNumSteps>, kNumActivityClasses> larger;
};

inline constexpr SetPriors kNormalPriors = {
    {{
        {{2, 1, 3}}, {{9, 1, 17}}, {{28, 7, 46}}, {{65, 24, 86}}, {{106, 56, 126}}, {{146, 98, 160}},
        {{172, 135, 185}}, {{198, 169, 207}}, {{217, 194, 223}}, {{231, 214, 235}}, {{240, 229, 242}},
        {{245, 241, 249}}, {{249, 245, 250}}, {{251, 246, 253}}
    }},
    {{132, 91, 100, 83, 47, 76, 84, 41}},
    {{
        {{88, 123, 183, 188}}, {{27, 33, 70, 139}}, {{24, 57, 88, 113}}, {{37, 56, 72, 138}},
        {{58, 67, 80, 127}}, {{81, 84, 91, 127}}, {{111, 110, 110, 135}}, {{146, 141, 144, 155}},
        {{179, 174, 178, 181}}, {{203, 200, 200, 205}}, {{221, 220, 218, 219}}, {{233, 234, 231, 230}},
        {{243, 243, 242, 239}}, {{245, 246, 246, 246}}
    }},
};
inline constexpr SetPriors kTangentialPriors = {
    {{
        {{3, 5, 9}}, {{2, 6, 14}}, {{6, 13, 23}}, {{9, 16, 34}}, {{12, 21, 39}}, {{19, 22, 41}},
        {{19, 26, 50}}, {{25, 28, 55}}, {{31, 31, 56}}, {{32, 33, 72}}, {{28, 35, 70}}, {{34, 47, 101}},
        {{55, 55, 130}}, {{63, 61, 135}}
    }},
    {{128, 128, 128, 128, 128, 128, 128, 128}},
    {{
        {{178, 189, 182, 210}}, {{120, 148, 138, 204}}, {{116, 142, 163, 202}}, {{126, 137, 143, 199}},
        {{157, 143, 154, 195}}, {{170, 158, 147, 191}}, {{191, 173, 168, 183}}, {{198, 186, 157, 190}},
        {{217, 192, 207, 192}}, {{217, 210, 197, 207}}, {{224, 235, 225, 219}}, {{208, 242, 231, 223}},
        {{196, 231, 237, 241}}, {{180, 234, 232, 246}}
    }},
};

}  // namespace lacerta

#endif  // LACERTA_COMMON_COEFFICIENT_PRIORS_H_
