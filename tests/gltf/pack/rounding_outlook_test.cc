#include "pack/rounding_outlook.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <vector>

#include "gltf/pack/textured_ball.h"
#include "lacerta/surface_distance.h"

namespace lacerta {
namespace {

struct Outlook {
  explicit Outlook(float repeats = 1.0f)
      : ball(testing::TexturedBall(repeats)),
        meter({&ball}, DistanceOfPsnr(50.0, BoundingBoxDiagonal(Surface(ball))), {}, 1024, [](size_t, uint64_t) { return 1024.0; }),
        outlook(meter.primitives(), meter, nullptr, {}) {}

  RoundingLevels Coarsest() { return outlook.Candidates().front(); }
  // As if everything erred by so much of its target.
  SurfaceErrors Errors(double ratio) const {
    SurfaceErrors errors;
    errors.distance = ratio * outlook.targets().distance;
    for (const double target : outlook.targets().attributes) errors.attributes.push_back({ratio * target, ratio * target});
    return errors;
  }
  std::vector<double> Rounded(const RoundingLevels& levels) {
    std::vector<double> rounded;
    for (size_t a = 0; a < levels.attributes.size(); ++a) rounded.push_back(outlook.forecast().Rounded(a, levels.attributes[a]));
    return rounded;
  }

  const Primitive ball;
  const FamilyMeter meter;
  RoundingOutlook outlook;
};

TEST(RoundingLevels, AreAsFineAsOthersInEverything) {
  const RoundingLevels levels{10, {20, 30}};
  EXPECT_TRUE(levels.IsAsFineAs({10, {20, 30}}));
  EXPECT_TRUE(levels.IsAsFineAs({9, {20, 29}}));
  EXPECT_FALSE(levels.IsAsFineAs({9, {21, 29}}));
  EXPECT_FALSE(levels.IsAsFineAs({11, {20, 30}}));
}

TEST(RoundingOutlook, CandidatesAreExpectedToMeetTheTargetsAndHardlyMore) {
  Outlook o;
  for (const RoundingLevels& levels : o.outlook.Candidates()) {
    const RoundedPositions& positions = o.outlook.forecast().Positions(levels.positions);
    EXPECT_LE(positions.distance, o.meter.error());
    for (size_t a = 0; a < levels.attributes.size(); ++a) {
      const RoundedAttribute& attribute = o.outlook.attributes()[a];
      const auto added = [&](int level) { return o.outlook.forecast().Rounded(a, level) / attribute.target; };
      const double room = o.outlook.RoomFor(a, positions);
      EXPECT_LE(added(levels.attributes[a]) * added(levels.attributes[a]), room);
      const int coarser = levels.attributes[a] - (attribute.octahedral ? kLevelsPerBit : 1);
      EXPECT_GT(added(coarser) * added(coarser), room);
    }
  }
}

TEST(RoundingOutlook, WhatWasMeasuredCorrectsIt) {
  for (const double ratio : {0.5, 1.2}) {
    Outlook o;
    const RoundingLevels before = o.Coarsest();
    EXPECT_EQ(o.outlook.Learn(o.Errors(ratio), before, o.Rounded(before)), ratio <= 1.0);
    const RoundingLevels after = o.Coarsest();
    EXPECT_TRUE(ratio < 1.0 ? before.IsAsFineAs(after) : after.positions > before.positions) << ratio;
    EXPECT_TRUE(before < after || after < before) << ratio;
    EXPECT_LT(std::abs(after.positions - before.positions), 3 * kLevelsPerBit) << ratio;
  }
}

TEST(RoundingOutlook, PositionsThatWereOfNoUseGetFiner) {
  Outlook o;
  const int before = o.Coarsest().positions;
  o.outlook.RefusePositions(before);
  EXPECT_EQ(o.Coarsest().positions, before + kLevelsPerBit / 2);
  EXPECT_FALSE(o.outlook.Learn(InvalidData("no area is left"), {before + 4, {}}, {}));
  EXPECT_EQ(o.Coarsest().positions, before + 5);
  EXPECT_FALSE(o.outlook.Learn(InvalidData("no area is left"), {before + 5, {}}, {}));
  EXPECT_EQ(o.Coarsest().positions, before + 7);
}

TEST(RoundingOutlook, WhatIsCoarserMayMeetTheTargetsWhereThereIsRoom) {
  Outlook o;
  const RoundingLevels best = o.Coarsest();
  RoundingLevels coarser = best;
  --coarser.attributes[1];
  EXPECT_TRUE(o.outlook.MayMeet(coarser, best, o.Errors(0.3)));
  EXPECT_FALSE(o.outlook.MayMeet(coarser, best, o.Errors(1.0)));
  coarser.attributes[1] -= 6 * kLevelsPerBit;
  EXPECT_FALSE(o.outlook.MayMeet(coarser, best, o.Errors(0.3)));
}

}  // namespace
}  // namespace lacerta
