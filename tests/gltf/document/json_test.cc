#include "document/json.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <random>
#include <string>

namespace lacerta {
namespace {

size_t SignificantDigits(const std::string& text) {
  std::string digits;
  for (const char c : text.substr(0, text.find('e'))) {
    if (c >= (digits.empty() ? '1' : '0') && c <= '9') digits += c;
  }
  return digits.find_last_not_of('0') + 1;
}

TEST(ShortNumberTest, IsReadBackAsTheSameFloatAndHasNineDigitsAtMost) {
  std::mt19937 random(1);
  int num_longer = 0;  // the library that writes JSON seldom finds more than the fewest digits
  for (int i = 0; i < 20'000; ++i) {
    const auto bits = static_cast<uint32_t>(random());
    float value;
    std::memcpy(&value, &bits, sizeof value);
    if (!std::isfinite(value)) continue;
    const std::string text = ShortNumber(value).dump();
    ASSERT_EQ(std::strtof(text.c_str(), nullptr), value) << text;
    num_longer += SignificantDigits(text) > 9;
  }
  EXPECT_LT(num_longer, 200);
  EXPECT_EQ(ShortNumber(-0.04211532697081566f).dump(), "-0.042115327");
  EXPECT_EQ(ShortNumber(0.1f).dump(), "0.1");
}

TEST(ShortNumberTest, WholeNumbersHaveNoPoint) {
  EXPECT_EQ(ShortNumber(65535.0f).dump(), "65535");
  EXPECT_EQ(ShortNumber(-3.0f).dump(), "-3");
  EXPECT_EQ(ShortNumber(-0.0f).dump(), "0");
  EXPECT_EQ(std::stof(ShortNumber(16777216.0f).dump()), 16777216.0f);
  EXPECT_EQ(std::stof(ShortNumber(std::numeric_limits<float>::max()).dump()), std::numeric_limits<float>::max());
}

TEST(RoundedNumberTest, HasFourDigits) {
  EXPECT_EQ(RoundedNumber(0.0015560678439214826).dump(), "0.001556");
  EXPECT_EQ(RoundedNumber(123456.0).dump(), "123500.0");
  EXPECT_EQ(RoundedNumber(0.0).get<double>(), 0.0);
  for (const double value : {1e-30, 0.00123456, 0.999951, 7.7, 98765.4}) {
    EXPECT_NEAR(RoundedNumber(value).get<double>() / value, 1, 0.0005) << value;
    EXPECT_NE(RoundedNumber(value * 1.002).get<double>(), RoundedNumber(value).get<double>()) << value;
  }
}

}  // namespace
}  // namespace lacerta
