#include "kinebase/search/ranking.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <map>
#include <utility>

#include "kinebase/core/error.h"
#include "search/scans.h"
#include "support/files.h"

namespace kinebase::test {
namespace {

// Some entries cost something, in a tenth of the columns none.
QuantizedTemplate RandomWeighted(Random& random, int columns, int features, Profile matching) {
  QuantizedTemplate quantized = RandomQuantized(random, columns, features, matching);
  quantized.costs.resize(static_cast<std::size_t>(columns) * features);
  for (int column = 0; column < columns; ++column) {
    const bool is_free = random.Below(10) == 0;
    quantized.columns[column].consistent = 0;
    for (int feature = 0; feature < features; ++feature) {
      if (is_free || random.Below(3) == 0) continue;
      quantized.columns[column].consistent |= std::uint64_t{1} << feature;
      quantized.costs[static_cast<std::size_t>(column) * features + feature] = random.Unit();
    }
  }
  return quantized;
}

// The recursion of the paper, word for word, cell by cell.
class PlainTable {
 public:
  PlainTable(const QuantizedTemplate& motion_template, std::span<const std::uint64_t> columns)
      : template_(motion_template), columns_(columns) {}

  double Cell(int k, int l) {
    if (k < 0 || l < 0) return kNever;
    const auto known = cells_.find({k, l});
    if (known != cells_.end()) return known->second;
    double cost = LocalCost(k, l);
    if (k > 0) {
      const double one = std::min(Cell(k - 1, l - 1), Cell(k - 1, l - 2));
      const double two = Cell(k - 2, l - 1);
      const bool is_double = two < one && template_.matching == Profile::kBonn;
      cost = std::min(one, two) + (is_double ? 2 : 1) * cost;
    }
    return cells_[{k, l}] = cost;
  }

 private:
  static constexpr double kNever = std::numeric_limits<double>::infinity();

  [[nodiscard]] double LocalCost(int k, int l) const {
    double cost = 0;
    for (int feature = 0; feature < template_.feature_count; ++feature) {
      const std::uint64_t bit = std::uint64_t{1} << feature;
      const QuantizedColumn& column = template_.columns[k];
      const bool differs = ((columns_[l] ^ column.ones) & column.consistent & bit) != 0;
      if (differs)
        cost += template_.costs[static_cast<std::size_t>(k) * template_.feature_count + feature];
    }
    return cost;
  }

  const QuantizedTemplate& template_;
  std::span<const std::uint64_t> columns_;
  std::map<std::pair<int, int>, double> cells_;
};

RC_GTEST_PROP(WeightedDelta, IsThePlainRecursion, ()) {
  Random random(*rc::gen::arbitrary<std::uint32_t>());
  const int features = 1 + random.Below(64);
  const Profile matching = random.Below(2) == 0 ? Profile::kBonn : Profile::kPaper;
  const QuantizedTemplate motion_template =
      RandomWeighted(random, 1 + random.Below(9), features, matching);
  const std::vector<std::uint64_t> recording = RandomRecording(random, 30, features);
  const DeltaCurve curve = ComputeDeltaReference(motion_template, recording);
  PlainTable table(motion_template, recording);
  const int rows = motion_template.column_count();
  for (int l = 0; l < 30; ++l) {
    const double expected = table.Cell(rows - 1, l) / rows;
    const bool is_same = std::isinf(expected) ? std::isinf(curve.delta[l])
                                              : std::abs(curve.delta[l] - expected) < 1e-9;
    RC_ASSERT(is_same);
  }
}

// Tiles of a scan are 4096 columns.
TEST(WeightedDelta, IsTheSameHoweverTheRecordingIsCut) {
  Random random(7);
  for (const int length : {1, 4095, 4096, 4097, 9000}) {
    const QuantizedTemplate motion_template = RandomWeighted(random, 37, 39, Profile::kBonn);
    const std::vector<std::uint64_t> recording = RandomRecording(random, length, 39);
    const DeltaCurve expected = ComputeDeltaReference(motion_template, recording);
    const DeltaCurve actual = ComputeDelta(motion_template, recording);
    EXPECT_EQ(std::memcmp(actual.delta.data(), expected.delta.data(),
                          expected.delta.size() * sizeof(double)),
              0);
    EXPECT_EQ(actual.start, expected.start);
  }
}

// A feature that holds in columns 10 to 14, and poses whose first value is `value` there.
struct Recording {
  explicit Recording(float value) {
    features = {.rate_hz = 30, .feature_count = 2};
    poses.rate_hz = 30;
    for (int column = 0; column < 30; ++column) {
      const bool inside = column >= 10 && column <= 14;
      features.columns.push_back(inside ? 1 : 0);
      poses.values.resize(poses.values.size() + kPoseValues);
      if (inside) poses.values[static_cast<std::size_t>(column) * kPoseValues] = value;
    }
  }
  [[nodiscard]] RecordingStreams streams() const { return {features, &poses}; }

  FeatureMatrix features;
  PoseStream poses;
};

// "The first feature five times, and the first pose value is 1."
MotionTemplate Template(const std::string& name) {
  MotionTemplate result{.name = name};
  result.matrix = MakeMatrix(std::vector<std::vector<double>>(5, {1, 0.5}));
  Contrast contrast;
  for (int column = 0; column < 5; ++column) {
    contrast.entry_weights.insert(contrast.entry_weights.end(), {1, 0});
    for (int value = 0; value < kPoseValues; ++value) {
      contrast.places.mean.push_back(value == 0 ? 1.0F : 0.0F);
      contrast.places.weight.push_back(value == 0 ? 1.0F : 0.0F);
    }
  }
  contrast.places.spread.assign(kPoseValues, 0.25F);
  result.contrast = contrast;
  return result;
}

TEST(Ranking, PutsTheHitFirstWhosePoseIsNearest) {
  const Recording near(1);
  const Recording far(-3);
  const Recording between(0.75F);
  const std::vector<RecordingStreams> recordings = {far.streams(), between.streams(),
                                                    near.streams()};
  const auto hits = RankHits(std::vector{Template("a")}, recordings).at(0);
  ASSERT_GE(hits.size(), 3);
  EXPECT_EQ(hits[0].hit.recording, 2);
  EXPECT_EQ(hits[0].hit.cost, 0);
  EXPECT_EQ(hits[1].hit.recording, 1);
  // A quarter off, of a variance of a quarter; weighs a tenth.
  EXPECT_NEAR(hits[1].places, 0.25, 1e-6);
  EXPECT_NEAR(hits[1].hit.cost, 0.025, 1e-6);
  EXPECT_EQ(hits[2].hit.recording, 0);
  EXPECT_EQ(hits[2].places, 4);  // More is not worse.
  // Without poses they are all the same.
  const auto plain =
      RankHits(std::vector{Template("a")}, recordings, {.places = false, .tau = 0}).at(0);
  EXPECT_EQ(plain.size(), 3);
  for (const RankedHit& hit : plain) {
    EXPECT_EQ(hit.hit.cost, 0);
    EXPECT_EQ(hit.hit.first, 10);
    EXPECT_EQ(hit.hit.last, 12);  // The first of equals: as fast as can be.
  }
}

TEST(Ranking, LetsTemplatesOfOtherNamesBeRivals) {
  const Recording recording(1);
  const std::vector<RecordingStreams> recordings = {recording.streams()};
  const auto best = [&](const std::vector<MotionTemplate>& templates, bool rivals = true) {
    return RankHits(templates, recordings, {.rivals = rivals}).at(0).at(0);
  };
  EXPECT_EQ(best({Template("a")}).rival, 0);
  EXPECT_EQ(best({Template("a"), Template("a")}).rival, 0);
  EXPECT_EQ(best({Template("a"), Template("b")}).rival, 0.5);
  EXPECT_EQ(best({Template("a"), Template("b")}).score, 0.25);
  EXPECT_EQ(best({Template("a"), Template("b")}).hit.cost, 0);
  EXPECT_EQ(best({Template("a"), Template("b")}, false).score, 0);
  // One that fits nowhere near is none.
  MotionTemplate elsewhere = Template("b");
  for (double& value : elsewhere.matrix.values) value = value == 1 ? 0 : value;
  EXPECT_LT(best({Template("a"), elsewhere}).rival, 0.5);
}

TEST(Ranking, NamesTheRivalAndWhereItFits) {
  const Recording recording(1);
  const std::vector<RecordingStreams> recordings = {recording.streams()};
  const std::vector<MotionTemplate> templates = {Template("a"), Template("b")};
  const RankedHit best = RankHits(templates, recordings).at(1).at(0);
  EXPECT_EQ(best.nearest, (Rival{.motion_template = 0, .first = 10, .last = 12, .matching = 0}));
  EXPECT_FALSE(RankHits(std::vector{Template("a")}, recordings).at(0).at(0).nearest);
  EXPECT_FALSE(RankHits(templates, recordings, {.rivals = false}).at(0).at(0).nearest);
}

TEST(Ranking, OfOnePathIsThatOfTheHit) {
  const Recording recording(0.5F);
  const std::vector<RecordingStreams> recordings = {recording.streams()};
  const std::vector<MotionTemplate> templates = {Template("a"), Template("b")};
  const auto hits = RankHits(templates, recordings).at(1);
  ASSERT_GT(hits.size(), 1);
  for (const RankedHit& hit : hits) {
    const auto same = RankEnd(templates, 1, recording.streams(), hit.hit.last);
    ASSERT_TRUE(same);
    EXPECT_EQ(same->hit, hit.hit);
    EXPECT_EQ(same->matching, hit.matching);
    EXPECT_EQ(same->places, hit.places);
    EXPECT_EQ(same->score, hit.score);
    EXPECT_EQ(same->nearest, hit.nearest);
  }
  EXPECT_FALSE(RankEnd(templates, 1, recording.streams(), 1));  // Half of five do not fit in two.
}

TEST(Ranking, NeedsAPoseForEachColumnWhereTheTemplateLooksAtPlaces) {
  const Recording recording(1);
  PoseStream brief = recording.poses;
  brief.values.resize(brief.values.size() - kPoseValues);
  const std::vector<MotionTemplate> templates = {Template("a")};
  for (const PoseStream* poses : {static_cast<const PoseStream*>(nullptr), &std::as_const(brief)}) {
    const std::vector<RecordingStreams> recordings = {{recording.features, poses}};
    EXPECT_EQ(ErrorOf([&] { (void)RankHits(templates, recordings); }).code(), ErrorCode::kMismatch);
    EXPECT_FALSE(RankHits(templates, recordings, {.places = false}).at(0).empty());
  }
}

TEST(Ranking, OfATemplateOfAnyFitsEverywhereAtThePriceOfPosesAlone) {
  MotionTemplate any = Template("any");
  for (double& value : any.matrix.values) value = 0.5;
  for (double& weight : any.contrast->entry_weights) weight = 0;
  const Recording recording(1);
  const std::vector<RecordingStreams> recordings = {recording.streams()};
  const auto hits = RankHits(std::vector{any}, recordings).at(0);
  ASSERT_FALSE(hits.empty());
  for (const RankedHit& hit : hits) {
    EXPECT_EQ(hit.matching, 0);
    EXPECT_EQ(hit.hit.cost, 0.1 * hit.places);
  }
  // What fits everywhere is everybody's rival.
  EXPECT_EQ(RankHits(std::vector{Template("a"), any}, recordings).at(0).at(0).rival, 0.5);
}

TEST(Ranking, OfARecordingShorterThanHalfTheTemplateFindsNothing) {
  Recording recording(1);
  for (const int columns : {0, 1, 2}) {
    recording.features.columns.resize(static_cast<std::size_t>(columns));
    recording.poses.values.resize(static_cast<std::size_t>(columns) * kPoseValues);
    const std::vector<RecordingStreams> recordings = {recording.streams()};
    EXPECT_TRUE(RankHits(std::vector{Template("a"), Template("b")}, recordings).at(0).empty());
  }
}

// The class has 1 in the first pose value, what looks like it 0, and the spread is a half.
TEST(Ranking, AddsHowNearPosesAreToThoseOfLookalikes) {
  MotionTemplate knowing = Template("a");
  knowing.contrast->places.lookalikes.assign(std::size_t{5} * kPoseValues, 0.0F);
  const auto best = [](const MotionTemplate& motion_template, float value, bool lookalikes = true) {
    const Recording recording(value);
    return RankHits(std::vector{motion_template}, std::vector{recording.streams()},
                    {.lookalikes = lookalikes})
        .at(0)
        .at(0);
  };
  // (0.25 / 0.5)² from them, (0.75 / 0.5)² from the class.
  const RankedHit near = best(knowing, 0.25F);
  EXPECT_NEAR(near.places, 2.25, 1e-6);
  EXPECT_NEAR(near.lookalikes, 0.75, 1e-6);
  EXPECT_NEAR(near.hit.cost, 0.1 * (2.25 + 0.75), 1e-6);
  EXPECT_EQ(near.hit.cost, near.score);
  EXPECT_NEAR(best(knowing, 0.25F, false).hit.cost, 0.225, 1e-6);
  EXPECT_EQ(best(knowing, 1).lookalikes, 0);  // Two spreads away.
  EXPECT_EQ(best(Template("a"), 0.25F).lookalikes, 0);
}

// Two styles: the hand at 1, and at -1. Recordings of both, and of one that is in between.
TEST(Ranking, GivesAPerformanceToTheStyleThatFitsBest) {
  MotionTemplate other = Template("a");
  for (float& mean : other.contrast->places.mean) mean = -mean;
  const std::vector<MotionTemplate> templates = {Template("a"), other};
  const Recording right(1);
  const Recording left(-1);
  const Recording between(0);
  const std::vector<RecordingStreams> recordings = {right.streams(), left.streams(),
                                                    between.streams()};
  const auto hits = RankHits(templates, recordings);
  const auto of_recording = [](const std::vector<RankedHit>& all, int recording) {
    return std::ranges::count(all, recording, [](const RankedHit& hit) {
      return hit.matching == 0 ? hit.hit.recording : -1;
    });
  };
  EXPECT_EQ(of_recording(hits[0], 0), 1);
  EXPECT_EQ(of_recording(hits[1], 0), 0);
  EXPECT_EQ(of_recording(hits[0], 1), 0);
  EXPECT_EQ(of_recording(hits[1], 1), 1);
  EXPECT_EQ(of_recording(hits[0], 2), 1);  // Of equals the first.
  EXPECT_EQ(of_recording(hits[1], 2), 0);
  const std::vector<RankedHit> of_class = HitsOfClass("a", templates, hits);
  EXPECT_EQ(of_class.size(), hits[0].size() + hits[1].size());
  EXPECT_TRUE(std::ranges::is_sorted(of_class, {}, &RankedHit::score));
  EXPECT_TRUE(HitsOfClass("b", templates, hits).empty());
  // Classes of other names keep theirs.
  std::vector<MotionTemplate> strangers = templates;
  strangers[1].name = "b";
  const auto apart = RankHits(strangers, recordings);
  EXPECT_EQ(of_recording(apart[1], 0), 1);
  EXPECT_EQ(of_recording(apart[1], 2), 1);
}

TEST(Ranking, LetsTemplatesCompeteThatLookAtDisjointFeatures) {
  // One looks at the first feature only, the other at the second, which holds nowhere.
  MotionTemplate second = Template("second");
  for (std::size_t i = 0; i < second.matrix.values.size(); i += 2) {
    std::swap(second.matrix.values[i], second.matrix.values[i + 1]);
    std::swap(second.contrast->entry_weights[i], second.contrast->entry_weights[i + 1]);
  }
  const Recording recording(1);
  const std::vector<RecordingStreams> recordings = {recording.streams()};
  const auto hits = RankHits(std::vector{Template("first"), second}, recordings);
  EXPECT_EQ(hits[0][0].rival, 0);  // All of its entries are wrong.
  EXPECT_EQ(hits[0][0].matching, 0);
  ASSERT_FALSE(hits[1].empty());
  EXPECT_EQ(hits[1][0].matching, 1);
}

TEST(Ranking, DoesNotDependOnThreads) {
  std::vector<Recording> made;
  made.reserve(20);
  for (int i = 0; i < 20; ++i) made.emplace_back(static_cast<float>(i) / 10);
  std::vector<RecordingStreams> recordings;
  recordings.reserve(made.size());
  for (const Recording& each : made) recordings.push_back(each.streams());
  const std::vector<MotionTemplate> templates = {Template("a"), Template("b")};
  const auto one = RankHits(templates, recordings, {.threads = 1});
  const auto many = RankHits(templates, recordings, {.threads = 4});
  ASSERT_EQ(one[1].size(), many[1].size());
  for (std::size_t i = 0; i < one[1].size(); ++i) EXPECT_EQ(one[1][i].hit, many[1][i].hit);
  EXPECT_EQ(RankHits(templates, recordings, {.most_hits = 3})[0].size(), 3);
}

TEST(Ranking, TakesPlainTemplatesAndEmptyRecordings) {
  MotionTemplate plain = Template("a");
  plain.contrast.reset();
  const Recording recording(1);
  FeatureMatrix nothing{.rate_hz = 30, .feature_count = 2};
  const PoseStream no_poses{.rate_hz = 30};
  const std::vector<RecordingStreams> recordings = {{nothing, &no_poses}, recording.streams()};
  const auto hits = RankHits(std::vector{plain}, recordings).at(0);
  ASSERT_FALSE(hits.empty());
  EXPECT_EQ(hits[0].hit.recording, 1);
  EXPECT_EQ(hits[0].hit.cost, 0);
  FeatureMatrix other{.rate_hz = 60, .feature_count = 2};
  EXPECT_EQ(ErrorOf([&] {
              (void)RankHits(std::vector{plain}, std::vector<RecordingStreams>{{other, nullptr}});
            }).code(),
            ErrorCode::kMismatch);
}

}  // namespace
}  // namespace kinebase::test
