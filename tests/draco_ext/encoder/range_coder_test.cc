// Round trips of encoder/range_encoder.h and decoder/range_decoder.h.
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "common/bit_model.h"
#include "decoder/range_decoder.h"
#include "encoder/range_encoder.h"

namespace lacerta {
namespace {

struct Decision {
  int model;  // -1: without a model
  bool bit;
};

Bytes EncodeAll(const std::vector<Decision>& decisions, int num_models) {
  std::vector<BitModel> models(num_models);
  RangeEncoder encoder;
  for (const Decision& d : decisions) {
    if (d.model < 0) {
      encoder.CodeEven(d.bit);
    } else {
      encoder.Code(models[d.model], d.bit);
    }
  }
  return encoder.Finish();
}

void ExpectDecodes(const std::vector<Decision>& decisions, int num_models, const Bytes& payload) {
  const std::vector<uint8_t> exact(payload.begin(), payload.end());  // the address sanitizer sees one byte too far
  std::vector<BitModel> models(num_models);
  RangeDecoder decoder(exact);
  for (size_t i = 0; i < decisions.size(); ++i) {
    const Decision& d = decisions[i];
    const bool bit = d.model < 0 ? decoder.CodeEven(false) : decoder.Code(models[d.model], false);
    ASSERT_EQ(bit, d.bit) << "decision " << i << " of " << decisions.size();
  }
}

TEST(RangeCoderTest, NothingTakesNoByte) {
  EXPECT_TRUE(EncodeAll({}, 0).empty());
  RangeDecoder decoder(Span<const uint8_t>{});
  BitModel model;
  decoder.Code(model, false);  // zeros beyond the end: no crash
}

TEST(RangeCoderTest, RoundTripsRandomDecisions) {
  for (uint32_t seed = 0; seed < 200; ++seed) {
    std::mt19937 random(seed);
    std::vector<Decision> decisions(random() % 2000);
    const uint64_t bias = random() % 1001;
    for (Decision& d : decisions) d = {static_cast<int>(random() % 6) - 1, random() % 1000 < bias};
    const Bytes payload = EncodeAll(decisions, 5);
    ExpectDecodes(decisions, 5, payload);
    EXPECT_TRUE(payload.empty() || payload.back() != 0) << "trailing zeros cost bytes";
  }
}

TEST(RangeCoderTest, RoundTripsWhereCarriesRunThroughManyBytes) {
  // Long runs of the likely symbol and a rare surprise walk `low` over byte borders.
  for (uint32_t seed = 0; seed < 50; ++seed) {
    std::mt19937 random(seed);
    std::vector<Decision> decisions(20000);
    for (Decision& d : decisions) d = {0, random() % 4096 == 0};
    ExpectDecodes(decisions, 1, EncodeAll(decisions, 1));
    for (Decision& d : decisions) d.bit = !d.bit;
    ExpectDecodes(decisions, 1, EncodeAll(decisions, 1));
  }
}

TEST(RangeCoderTest, CertainDecisionsCostAlmostNothing) {
  for (const bool bit : {false, true}) {
    const std::vector<Decision> decisions(100000, {0, bit});
    const Bytes payload = EncodeAll(decisions, 1);
    EXPECT_LE(payload.size(), 16u);  // 100,000 times at most 24/65536 * 1.45 bit, plus learning
    ExpectDecodes(decisions, 1, payload);
  }
}

TEST(RangeCoderTest, SizeIsCloseToEntropy) {
  for (const double p : {0.02, 0.1, 0.3, 0.5}) {
    std::mt19937 random(7);
    std::vector<Decision> decisions(50000);
    size_t ones = 0;
    for (Decision& d : decisions) {
      d = {0, static_cast<double>(random()) < p * 4294967296.0};
      ones += d.bit;
    }
    const double share = static_cast<double>(ones) / 50000;
    const double entropy_bytes = -(share * std::log2(share) + (1 - share) * std::log2(1 - share)) * 50000 / 8;
    const double size = static_cast<double>(EncodeAll(decisions, 1).size());
    EXPECT_GE(size, entropy_bytes * 0.995) << p;
    EXPECT_LE(size, entropy_bytes * 1.05) << p;  // the price of adapting fast
  }
}

TEST(RangeCoderTest, EvenDecisionsCostOneBit) {
  std::mt19937 random(3);
  std::vector<Decision> decisions(8000);
  for (Decision& d : decisions) d = {-1, (random() & 1) != 0};
  const Bytes payload = EncodeAll(decisions, 0);
  EXPECT_GE(payload.size(), 999u);
  EXPECT_LE(payload.size(), 1001u);
  ExpectDecodes(decisions, 0, payload);
}

TEST(BitModelTest, LearnsFastThenSettles) {
  BitModel model;
  EXPECT_EQ(model.ProbabilityOfOne(), 32768u);
  model.Update(true);
  EXPECT_GT(model.ProbabilityOfOne(), 42000u);  // one bit seen: about 3/4
  EXPECT_LT(model.ProbabilityOfOne(), 56000u);
  for (int i = 0; i < 100000; ++i) model.Update(true);
  EXPECT_EQ(model.ProbabilityOfOne(), 65536 - kMinProbability);
  for (int i = 0; i < 100000; ++i) model.Update(false);
  EXPECT_EQ(model.ProbabilityOfOne(), kMinProbability);
}

}  // namespace
}  // namespace lacerta
