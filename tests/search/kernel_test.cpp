// Every vector kernel against the plain one, bit for bit.
#include <gtest/gtest.h>

#include <cstring>

#include "kinebase/search/subsequence_dtw.h"
#include "search/delta_target.h"
#include "search/scans.h"

namespace kinebase::test {
namespace {

void ExpectSameBits(const DeltaCurve& actual, const DeltaCurve& expected) {
  ASSERT_EQ(actual.delta.size(), expected.delta.size());
  EXPECT_EQ(std::memcmp(actual.delta.data(), expected.delta.data(),
                        expected.delta.size() * sizeof(double)),
            0);
  EXPECT_EQ(actual.start, expected.start);
}

// Lengths around those of vectors (N up to 8 doubles, 64 bytes) and of the kernel's tile (512).
constexpr int kTemplateLengths[] = {1, 2, 3, 4, 5, 7, 8, 9, 17, 66};
constexpr int kRecordingLengths[] = {1,   2,   3,   4,   5,   7,    8,    9,    15,   16,
                                     17,  18,  33,  34,  66,  255,  256,  257,  510,  511,
                                     512, 513, 514, 520, 767, 1023, 1024, 1025, 1536, 1600};

class ScanKernel : public ::testing::TestWithParam<std::int64_t> {};

TEST_P(ScanKernel, EqualsTheReferenceInEveryBit) {
  const DeltaTarget target(GetParam());
  Random random(21);
  for (const int columns : kTemplateLengths) {
    for (const int length : kRecordingLengths) {
      for (const Profile matching : {Profile::kBonn, Profile::kPaper}) {
        SCOPED_TRACE(testing::Message() << columns << " x " << length);
        const int features = 1 + random.Below(64);
        const QuantizedTemplate motion_template =
            RandomQuantized(random, columns, features, matching);
        const std::vector<std::uint64_t> recording = RandomRecording(random, length, features);
        ExpectSameBits(ComputeDelta(motion_template, recording),
                       ComputeDeltaReference(motion_template, recording));
      }
    }
  }
}

// The recording need not begin where vectors like to be loaded from.
TEST_P(ScanKernel, EqualsTheReferenceAtAnyAddress) {
  const DeltaTarget target(GetParam());
  Random random(22);
  const QuantizedTemplate motion_template = RandomQuantized(random, 20, 39, Profile::kBonn);
  const std::vector<std::uint64_t> recording = RandomRecording(random, 1100, 39);
  for (std::size_t offset = 0; offset < 9; ++offset) {
    const std::span<const std::uint64_t> part = std::span(recording).subspan(offset);
    ExpectSameBits(ComputeDelta(motion_template, part),
                   ComputeDeltaReference(motion_template, part));
  }
}

TEST_P(ScanKernel, CountsUpToSixtyFourMismatches) {
  const DeltaTarget target(GetParam());
  TemplateMatrix matrix;
  matrix.rate_hz = 30;
  matrix.feature_count = 64;
  matrix.values.assign(192, 1.0);
  matrix.weights = {1.25, 0.8, 1.1};
  const QuantizedTemplate motion_template = Quantize(matrix, 0, Profile::kBonn);
  const std::vector<std::uint64_t> recording = {0, ~std::uint64_t{0}, 0, 0, 0, 1};
  ExpectSameBits(ComputeDelta(motion_template, recording),
                 ComputeDeltaReference(motion_template, recording));
}

TEST_P(ScanKernel, TakesEmptyRecordings) {
  const DeltaTarget target(GetParam());
  Random random(23);
  const DeltaCurve curve = ComputeDelta(RandomQuantized(random, 9, 39, Profile::kBonn), {});
  EXPECT_TRUE(curve.delta.empty());
  EXPECT_TRUE(curve.start.empty());
}

INSTANTIATE_TEST_SUITE_P(Targets, ScanKernel, ::testing::ValuesIn(SupportedDeltaTargets()),
                         [](const auto& target) { return DeltaTargetName(target.param); });

TEST(ScanTargets, AreNamedAndBestFirst) {
  const std::vector<std::int64_t> targets = SupportedDeltaTargets();
  ASSERT_FALSE(targets.empty());
  for (const std::int64_t target : targets) EXPECT_STRNE(DeltaTargetName(target), "Unknown");
  EXPECT_TRUE(std::ranges::is_sorted(targets));
}

}  // namespace
}  // namespace kinebase::test
