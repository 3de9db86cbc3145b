// Measures of coded surfaces.
#ifndef LACERTA_TESTS_DRACO_EXT_ENCODER_CODED_SURFACES_H_
#define LACERTA_TESTS_DRACO_EXT_ENCODER_CODED_SURFACES_H_

#include <gtest/gtest.h>

#include <cstring>
#include <vector>

#include "encoder/coefficient_descent.h"
#include "encoder/stream_writer.h"
#include "encoder/surface_target.h"
#include "lacerta/decoder.h"

namespace lacerta::testing {

inline Bytes RefinementOf(const CodedSurface& coded, const BaseTags& tags = {}) {
  StatusOr<RefinementBytes> written = WriteRefinement(coded.base, coded.steps, coded.levels, tags);
  EXPECT_TRUE(written.ok()) << written.status().message();
  return written.ok() ? std::move(written).value().bytes : Bytes();
}

inline double BitsOf(const CodedSurface& coded) { return 8.0 * static_cast<double>(RefinementOf(coded).size()); }

// The decoder must show what the encoder thinks, to the last bit.
inline void ExpectDecodesAsSynthesized(const SurfaceTarget& target, const CodedSurface& coded, const BaseTags& tags = {}) {
  const std::vector<Vec3f> expected = Synthesize(target, coded);
  const StatusOr<RefinementResult> decoded = DecodeRefinement(coded.base, RefinementOf(coded, tags), {});
  ASSERT_TRUE(decoded.ok()) << decoded.status().message();
  EXPECT_TRUE(decoded.value().refinement.ok()) << decoded.value().refinement.message();
  EXPECT_EQ(decoded.value().level, target.num_levels());
  const std::vector<Vec3f>& positions = decoded.value().mesh.positions;
  ASSERT_EQ(positions.size(), expected.size());
  EXPECT_EQ(std::memcmp(positions.data(), expected.data(), expected.size() * sizeof(Vec3f)), 0);
}

}  // namespace lacerta::testing

#endif  // LACERTA_TESTS_DRACO_EXT_ENCODER_CODED_SURFACES_H_
