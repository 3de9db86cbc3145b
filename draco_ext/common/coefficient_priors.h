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
  static constexpr int kNumCompanions = 3;  // classes on curves begin like the others
  static constexpr int kNumSteps = 4;       // the last one holds for all longer magnitudes
  std::array<std::array<uint8_t, kNumCompanions>, kNumActivityClasses> nonzero;
  std::array<uint8_t, kNumSignClasses> unexpected_sign;
  std::array<std::array<uint8_t, kNumSteps>, kNumActivityClasses> larger;
};

inline constexpr SetPriors kNormalPriors = {
    {{{{11, 11, 11}}, {{9, 9, 9}}, {{23, 23, 23}}, {{56, 56, 56}}, {{99, 99, 99}}, {{145, 145, 145}},
      {{176, 176, 176}}, {{202, 202, 202}}, {{221, 221, 221}}, {{233, 233, 233}}, {{241, 241, 241}},
      {{246, 246, 246}}, {{250, 250, 250}}, {{252, 252, 252}}}},
    {{132, 70, 117, 83, 39, 96, 88, 29}},
    {{{{139, 180, 203, 213}}, {{28, 29, 70, 170}}, {{24, 45, 92, 115}}, {{32, 49, 76, 134}}, {{47, 58, 74, 129}},
      {{72, 74, 88, 136}}, {{109, 98, 97, 124}}, {{155, 134, 131, 138}}, {{189, 176, 168, 164}},
      {{211, 207, 203, 194}}, {{227, 226, 224, 216}}, {{239, 238, 236, 233}}, {{246, 245, 245, 243}},
      {{251, 250, 248, 248}}}},
};
inline constexpr SetPriors kTangentialPriors = {
    {{{{2, 5, 16}}, {{3, 5, 11}}, {{8, 10, 23}}, {{12, 17, 34}}, {{17, 24, 46}}, {{22, 25, 45}}, {{27, 28, 57}},
      {{29, 30, 59}}, {{38, 33, 70}}, {{34, 37, 70}}, {{46, 50, 85}}, {{67, 62, 118}}, {{67, 62, 118}},
      {{67, 62, 118}}}},
    {{128, 128, 128, 128, 128, 128, 128, 128}},
    {{{{138, 182, 178, 207}}, {{90, 145, 148, 203}}, {{88, 128, 153, 189}}, {{101, 139, 160, 197}},
      {{112, 144, 148, 185}}, {{134, 155, 147, 190}}, {{161, 158, 168, 188}}, {{181, 177, 165, 177}},
      {{201, 185, 197, 188}}, {{202, 212, 207, 205}}, {{202, 212, 207, 205}}, {{202, 212, 207, 205}},
      {{202, 212, 207, 205}}, {{202, 212, 207, 205}}}},
};

}  // namespace lacerta

#endif  // LACERTA_COMMON_COEFFICIENT_PRIORS_H_
