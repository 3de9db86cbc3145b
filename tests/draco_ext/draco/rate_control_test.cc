// Targets and the choice of a base size.
#include "draco/rate_control.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <tbb/task_arena.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <vector>

#include "draco/for_each_candidate.h"
#include "draco_ext/draco/simplified_input.h"
#include "shapes/shapes.h"

namespace lacerta {
namespace {

using ::testing::HasSubstr;
using Kind = EncodeTarget::Kind;

TEST(ResolveTargetTest, BringsUnitsTogether) {
  const ResolvedTarget bytes = ResolveTarget({Kind::kBytes, 1234}, 10, 1).value();
  EXPECT_TRUE(bytes.is_rate);
  EXPECT_EQ(bytes.bytes, 1234);
  const ResolvedTarget rate = ResolveTarget({Kind::kBitsPerVertex, 0.5}, 48485, 1).value();
  EXPECT_TRUE(rate.is_rate);
  EXPECT_DOUBLE_EQ(rate.bytes, 0.5 * 48485 / 8);
  const ResolvedTarget psnr = ResolveTarget({Kind::kPsnr, 70}, 10, 1).value();
  EXPECT_FALSE(psnr.is_rate);
  EXPECT_EQ(psnr.psnr, 70);
  const ResolvedTarget error = ResolveTarget({Kind::kError, 1e-4}, 10, 7).value();
  EXPECT_FALSE(error.is_rate);
  EXPECT_NEAR(error.psnr, 80, 1e-12);
  const ResolvedTarget distance = ResolveTarget({Kind::kDistance, 7e-4}, 10, 7).value();
  EXPECT_FALSE(distance.is_rate);
  EXPECT_NEAR(distance.psnr, 80, 1e-12);
}

TEST(ResolveTargetTest, NamesTheValueThatMakesNoSense) {
  const Status status = ResolveTarget({Kind::kPsnr, 500}, 10, 1).status();
  EXPECT_EQ(status.code(), StatusCode::kInvalidArgument);
  EXPECT_THAT(status.message(), HasSubstr("500"));
  EXPECT_THAT(status.message(), HasSubstr("dB"));
  const Status far = ResolveTarget({Kind::kDistance, 3}, 10, 20).status();
  EXPECT_EQ(far.code(), StatusCode::kInvalidArgument);
  EXPECT_THAT(far.message(), HasSubstr("3 units"));
  EXPECT_THAT(far.message(), HasSubstr("between 2e-06 and 2"));
  for (const Kind kind : {Kind::kBytes, Kind::kBitsPerVertex, Kind::kPsnr, Kind::kError, Kind::kDistance}) {
    EXPECT_FALSE(ResolveTarget({kind, std::numeric_limits<double>::quiet_NaN()}, 10, 1).ok());
    EXPECT_FALSE(ResolveTarget({kind, std::numeric_limits<double>::infinity()}, 10, 1).ok());
  }
}

// Codes a mesh at a target.
struct Coder : testing::SimplifiedInput {
  using SimplifiedInput::SimplifiedInput;
  ChosenStream Code(const ResolvedTarget& target) const { return CodeAtTarget(Refinable(), meter, target, EncodeMode::kDefault, {}).value(); }
};

TEST(CodeAtTargetTest, BasesGrowWithTheQualityAskedFor) {
  const Coder coder(shapes::BumpySphere(4, 0.2f, 0.003f));
  const ChosenStream coarse = coder.Code({false, 0, 34}), fine = coder.Code({false, 0, 60}), finest = coder.Code({false, 0, 75});  // its noise, too
  for (const ChosenStream* chosen : {&coarse, &fine, &finest}) EXPECT_TRUE(chosen->measured.meets_target);
  EXPECT_LE(4 * coarse.measured.stream.decoded.num_base_vertices, finest.measured.stream.decoded.num_base_vertices);
  EXPECT_GE(fine.measured.stream.size(), 2 * coarse.measured.stream.size());
  EXPECT_LE(fine.measured.stream.size(), 6 * coarse.measured.stream.size());
}

TEST(CodeAtTargetTest, SmoothSurfacesHaveTinyBases) {
  const Coder coder(shapes::BumpySphere(4, 0.1f));
  const ChosenStream chosen = coder.Code({false, 0, 52});
  EXPECT_TRUE(chosen.measured.meets_target);
  EXPECT_LE(chosen.measured.stream.decoded.num_base_vertices, 32u);
  EXPECT_GE(chosen.measured.stream.decoded.num_base_vertices, 14u);
}

// Its triangles are as large as what the stream may be wrong by, and few to decode.
TEST(CodeAtTargetTest, CoarseInputsGetMoreVerticesThanTheyHave) {
  const Coder coder(shapes::BumpySphere(3, 0.2f));
  const double num_input = static_cast<double>(coder.mesh.positions.size());
  const ChosenStream coarse = coder.Code({false, 0, 40}), fine = coder.Code({false, 0, 62});
  EXPECT_TRUE(fine.measured.meets_target);
  EXPECT_LT(static_cast<double>(coarse.measured.stream.decoded.positions.size()), 6 * num_input);
  EXPECT_GT(static_cast<double>(fine.measured.stream.decoded.positions.size()), 6 * num_input);
  EXPECT_LE(static_cast<double>(fine.measured.stream.decoded.positions.size()), 26 * num_input);
}

// Each keeps to itself, so this is all that the size of the input may change.
TEST(CodeAtTargetTest, EffortTradesBaseSizesForBytes) {
  const Coder coder(shapes::BumpySphere(4, 0.2f, 0.002f));
  struct Outcome {
    double bytes;
    int rounds;  // of base sizes
  };
  const auto code = [&](Effort effort) {
    int rounds = 0;
    const auto progress = [&](double, const char* stage) { rounds += std::string(stage) == "choosing the base mesh"; };
    const ChosenStream chosen =
        CodeAtTarget(coder.Refinable(), coder.meter, {false, 0, 59}, EncodeMode::kDefault, progress, EffortOf(effort)).value();
    EXPECT_TRUE(chosen.measured.meets_target);
    return Outcome{static_cast<double>(chosen.measured.stream.size()), rounds};
  };
  const Outcome fast = code(Effort::kFast), normal = code(Effort::kNormal);
  EXPECT_EQ(fast.rounds, 1);
  EXPECT_GE(normal.rounds, fast.rounds);
  EXPECT_GE(fast.bytes, 0.98 * normal.bytes);
  EXPECT_LE(fast.bytes, 1.21 * normal.bytes);
}

TEST(ForEachCandidateTest, LargeInputsAreWorkedOnOneByOne) {
  for (const double num_vertices : {0.999 * kOneCandidateAtATime, kOneCandidateAtATime}) {
    std::vector<size_t> order;
    std::vector<int> calls(20, 0);
    std::mutex mutex;
    std::set<std::thread::id> threads;
    ForEachCandidate(num_vertices, calls.size(), [&](size_t i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(2));  // for another thread to take its share
      const std::lock_guard<std::mutex> lock(mutex);
      ++calls[i];
      order.push_back(i);
      threads.insert(std::this_thread::get_id());
    });
    EXPECT_THAT(calls, ::testing::Each(1));
    if (num_vertices < kOneCandidateAtATime) {
      EXPECT_EQ(threads.size() > 1, tbb::this_task_arena::max_concurrency() > 1);
    } else {
      EXPECT_EQ(threads.size(), 1u);
      EXPECT_TRUE(std::is_sorted(order.begin(), order.end()));
    }
  }
}

TEST(CodeAtTargetTest, ReportsStages) {
  const Coder coder(shapes::BumpySphere(3, 0.2f));
  std::vector<double> shares;
  const auto progress = [&](double share, const char* stage) {
    EXPECT_STRNE(stage, "");
    shares.push_back(share);
  };
  ASSERT_TRUE(CodeAtTarget(coder.Refinable(), coder.meter, {false, 0, 50}, EncodeMode::kDefault, progress).ok());
  ASSERT_GE(shares.size(), 2u);
  for (size_t i = 0; i < shares.size(); ++i) {
    EXPECT_GE(shares[i], i == 0 ? 0.0 : shares[i - 1]);
    EXPECT_LE(shares[i], 1.0);
  }
}

// A rival of so many bytes that takes note of what it is asked.
struct NotingRival {
  double bytes;
  std::vector<double> asked = {}, prepared = {};

  StatusOr<ChosenStream> Code(const Coder& coder, const ResolvedTarget& target, Effort effort = Effort::kFast) {
    const RivalStream rival = {[&](double most) {
                                 asked.push_back(most);
                                 return bytes < most;
                               },
                               [&](double most) { return bytes < most; },
                               [&](double beside) { prepared.push_back(beside); }};
    return CodeAtTarget(coder.Refinable(), coder.meter, target, EncodeMode::kDefault, {}, EffortOf(effort), &rival);
  }
};

TEST(CodeAtTargetTest, GivesUpWhereItIsOutdone) {
  const Coder coder(shapes::BumpySphere(4, 0.2f, 0.003f));
  const ResolvedTarget psnr{false, 0, 56};
  NotingRival large{1e9};
  const auto size = static_cast<double>(large.Code(coder, psnr).value().measured.stream.size());
  ASSERT_GE(large.asked.size(), 2u);
  for (const double least : large.asked) EXPECT_LT(least, size) << "what the stream takes at least";
  EXPECT_GT(large.asked.back(), 0.6 * size);
  ASSERT_EQ(large.prepared.size(), 1u) << "once it is known what the stream takes";
  EXPECT_NEAR(large.prepared.front(), size, 0.2 * size);
  NotingRival small{0.5 * size};
  EXPECT_EQ(small.Code(coder, psnr).status().code(), StatusCode::kUnsupported);
  EXPECT_TRUE(small.prepared.empty());
}

TEST(CodeAtTargetTest, TheWalkOverBasesEndsWhereTheBestCanHardlyGetAsSmallAsTheRival) {
  const Coder coder(shapes::BumpySphere(4, 0.2f, 0.003f));
  const ResolvedTarget psnr{false, 0, 63};
  NotingRival large{1e9};
  const auto size = static_cast<double>(large.Code(coder, psnr, Effort::kNormal).value().measured.stream.size());
  ASSERT_GE(large.asked.size(), 3u);
  for (const double least : large.asked) EXPECT_LT(least, size);
  NotingRival small{0.7 * size}, near{0.98 * size};
  EXPECT_EQ(small.Code(coder, psnr, Effort::kNormal).status().code(), StatusCode::kUnsupported);
  EXPECT_LT(small.asked.size(), large.asked.size());
  EXPECT_TRUE(near.Code(coder, psnr, Effort::kNormal).ok());
}

TEST(CodeAtTargetTest, ForeseesWhatAStreamNearToItsRemeshTakes) {
  const struct {
    TriangleMesh mesh;
    double psnr;
  } near[] = {{shapes::BumpySphere(3, 0.2f), 69}, {shapes::BumpySphere(4, 0.2f, 0.003f), 81}, {shapes::BumpySphere(4, 0.2f, 0.01f), 81}};
  for (const auto& [mesh, psnr] : near) {
    const Coder coder(mesh);
    NotingRival rival{1e9};
    const ChosenStream chosen = rival.Code(coder, {false, 0, psnr}).value();
    EXPECT_LT(chosen.remesh_psnr, psnr + 3);
    const auto size = static_cast<double>(chosen.measured.stream.size());
    EXPECT_NEAR(rival.prepared.front(), size, 0.12 * size) << psnr << " dB";
  }
}

TEST(CodeAtTargetTest, ARivalIsOnlyPreparedAtARate) {
  const Coder coder(shapes::BumpySphere(4, 0.2f, 0.003f));
  NotingRival rival{0};
  EXPECT_TRUE(rival.Code(coder, {true, 1000, 0}).ok());
  EXPECT_TRUE(rival.asked.empty());
  EXPECT_EQ(rival.prepared, std::vector<double>{1000});
}

TEST(CodeAtTargetTest, AnyStreamOutdoesBasesThatMissTheTarget) {
  const Coder coder(shapes::SpikySphere(3));  // spikes that a remesh blunts
  NotingRival rival{1e9};
  EXPECT_EQ(rival.Code(coder, {false, 0, 120}).status().code(), StatusCode::kUnsupported);
  EXPECT_EQ(rival.asked.back(), std::numeric_limits<double>::infinity());
  EXPECT_TRUE(rival.prepared.empty());
}

TEST(CodeAtTargetTest, BeyondTheRemeshTheNearestIsReturned) {
  const Coder coder(shapes::SpikySphere(3));  // spikes that a remesh blunts
  const ChosenStream chosen = coder.Code({false, 0, 120});
  EXPECT_FALSE(chosen.measured.meets_target);
  EXPECT_LT(chosen.measured.psnr, 120);
  EXPECT_GT(chosen.measured.psnr, 30);
}

}  // namespace
}  // namespace lacerta
