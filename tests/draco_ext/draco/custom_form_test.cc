#include "draco/custom_form.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <numeric>

namespace lacerta {
namespace {

using ::testing::ElementsAreArray;
using ::testing::HasSubstr;

Bytes Counting(size_t size) {
  Bytes bytes(size);
  std::iota(bytes.begin(), bytes.end(), uint8_t{1});
  return bytes;
}

TEST(CustomFormTest, HasTheDocumentedBytes) {
  const Bytes base = Counting(200);
  const Bytes refinement = {9, 8, 7};
  Bytes expected = {'D', 'R', 'A', 'C', 'O', 2, 2, 1, 'L', 0, 0, /*version*/ 1, /*200 as a varint*/ 0xC8, 0x01};
  expected.insert(expected.end(), base.begin(), base.end());
  expected.insert(expected.end(), refinement.begin(), refinement.end());
  EXPECT_EQ(WriteCustomForm({base, refinement}), expected);
}

TEST(CustomFormTest, SplitsWhatItWrote) {
  for (const size_t base_size : {0, 1, 127, 128, 70000}) {
    for (const size_t refinement_size : {0, 1, 500}) {
      const Bytes base = Counting(base_size);
      const Bytes refinement = Counting(refinement_size);
      const Bytes stream = WriteCustomForm({base, refinement});
      EXPECT_TRUE(IsCustomForm(stream));
      const StatusOr<StreamParts> parts = SplitCustomForm(stream);
      ASSERT_TRUE(parts.ok()) << parts.status().message();
      EXPECT_THAT(Bytes(parts.value().base.begin(), parts.value().base.end()), ElementsAreArray(base));
      EXPECT_THAT(Bytes(parts.value().refinement.begin(), parts.value().refinement.end()),
                  ElementsAreArray(refinement));
    }
  }
}

TEST(CustomFormTest, RefusesBaseThatIsCutOff) {
  const Bytes stream = WriteCustomForm({Counting(50), Bytes()});
  for (size_t size = 0; size < stream.size(); ++size) {
    const StatusOr<StreamParts> parts = SplitCustomForm(Span<const uint8_t>(stream).First(size));
    ASSERT_FALSE(parts.ok()) << size;
    EXPECT_EQ(parts.status().code(), StatusCode::kInvalidData);
  }
}

TEST(CustomFormTest, RefusesUnknownVersionByName) {
  Bytes stream = WriteCustomForm({Counting(50), Bytes()});
  stream[11] = 2;
  const Status status = SplitCustomForm(stream).status();
  EXPECT_EQ(status.code(), StatusCode::kUnsupported);
  EXPECT_THAT(status.message(), HasSubstr("version 2"));
}

TEST(CustomFormTest, TellsHowTheBaseIsCoded) {
  Bytes stream = WriteCustomForm({Counting(50), Bytes(), BaseCoding::kCompact});
  EXPECT_EQ(stream[11], 0x11);
  EXPECT_EQ(SplitCustomForm(stream).value().coding, BaseCoding::kCompact);
  stream[11] = 0x21;
  EXPECT_EQ(SplitCustomForm(stream).status().code(), StatusCode::kUnsupported);
}

TEST(CustomFormTest, RefusesLengthsThatDoNotFit) {
  // 2^63 and more, and a varint without end.
  Bytes stream = {'D', 'R',  'A',  'C',  'O',  2,    2,    1,    'L',  0,    0,
                  1,   0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0x01};
  EXPECT_EQ(SplitCustomForm(stream).status().code(), StatusCode::kInvalidData);
  stream.insert(stream.end(), 1000, uint8_t{0xff});
  EXPECT_EQ(SplitCustomForm(stream).status().code(), StatusCode::kInvalidData);
}

TEST(CustomFormTest, TellsFormsApart) {
  Bytes stream = WriteCustomForm({Counting(5), Bytes()});
  stream[8] = 1;
  EXPECT_FALSE(IsCustomForm(stream));
  EXPECT_FALSE(SplitCustomForm(stream).ok());
  stream[8] = 'L';
  stream[0] = 'd';
  EXPECT_FALSE(IsCustomForm(stream));
  EXPECT_FALSE(IsCustomForm(Span<const uint8_t>(stream).First(8)));
  EXPECT_FALSE(IsCustomForm(Bytes()));
}

}  // namespace
}  // namespace lacerta
