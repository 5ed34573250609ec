#include "kinebase/library/feedback.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "kinebase/core/error.h"
#include "kinebase/library/class_learning.h"
#include "kinebase/library/take_search.h"
#include "kinebase/templates/learning.h"
#include "support/files.h"
#include "support/temporary_folder.h"
#include "support/test_data.h"

namespace kinebase::test {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

// Three features at 30 Hz; the file has one frame a column. The class holds the first for ten
// columns between ten without; so does what is taken for it, but there the second holds, too. The
// third goes on and off anywhere. Poses are still.
TakeFeatures Take(const std::string& name, std::uint64_t middle, int length = 10) {
  TakeFeatures take{.path = name, .stretch = {.file = name}, .rate_hz = 30};
  take.features = {.rate_hz = 30, .feature_count = 3};
  for (int column = 0; column < 20 + length; ++column) {
    const bool is_middle = column >= 10 && column < 10 + length;
    take.features.columns.push_back((is_middle ? middle : 0) | (column % 5 == 0 ? 0b100U : 0U));
  }
  take.frame_count = take.features.column_count();
  take.poses.rate_hz = 30;
  take.poses.values.resize(take.features.columns.size() * kPoseValues);
  return take;
}

TakeFeatures CutColumns(const TakeFeatures& take, const TemplateMark& mark) {
  TakeFeatures cut = take;
  cut.features.columns = {take.features.columns.begin() + mark.first_frame - 1,
                          take.features.columns.begin() + mark.last_frame};
  cut.frame_count = cut.features.column_count();
  cut.poses.values.resize(cut.features.columns.size() * kPoseValues);
  return cut;
}

MotionTemplate TemplateFrom(const std::vector<TakeFeatures>& clips) {
  std::vector<TemplateMatrix> performances;
  MotionTemplate learned{.name = "class"};
  for (const TakeFeatures& clip : clips) {
    performances.push_back(ToTemplateMatrix(clip.features));
    learned.clips.push_back({.file = clip.path});
  }
  learned.matrix = LearnTemplate(performances).matrix;
  return learned;
}

Feedback FeedbackOn(const std::vector<TakeFeatures>& clips, const std::vector<TakeFeatures>& takes,
                    const std::vector<TemplateMark>& marks) {
  Feedback feedback{.clips = clips, .takes = takes};
  for (std::size_t i = 0; i < marks.size(); ++i) {
    feedback.judged.push_back({marks[i], i, CutColumns(takes[i], marks[i])});
  }
  return feedback;
}

const std::vector<TakeFeatures> kClips = {Take("a", 0b001), Take("b", 0b001, 12)};
const TakeFeatures kWrongTake = Take("wrong", 0b011);

double CostIn(const MotionTemplate& motion_template, const TakeFeatures& take) {
  const auto hits = RankTakes(std::span(&motion_template, 1), std::span(&take, 1), {.tau = 99});
  return hits.front().front().cost;
}

TEST(UpdateTemplate, LearnsAgainFromRightHits) {
  const MotionTemplate before = TemplateFrom(kClips);
  const TakeFeatures more = Take("c", 0b011);  // Right all the same: the second does not matter.
  const TemplateUpdate update =
      UpdateTemplate(before, FeedbackOn(kClips, {more}, {{"c", 1, 30, Verdict::kRight}}));
  EXPECT_EQ(update.matrix, MatrixUpdate::kRelearned);
  EXPECT_EQ(update.clips_added, 1);
  EXPECT_THAT(update.updated.clips,
              ElementsAre(TemplateClip{"a"}, TemplateClip{"b"}, TemplateClip{"c", 1, 30}));
  EXPECT_THAT(update.updated.marks, ElementsAre(TemplateMark{"c", 1, 30, Verdict::kRight}));
  std::vector<TakeFeatures> all = kClips;
  all.push_back(more);
  EXPECT_EQ(update.updated.matrix, TemplateFrom(all).matrix);
  // It was missed: the threshold of templates without one is .06.
  EXPECT_GT(CostIn(before, more), 0.06);
  EXPECT_LE(CostIn(update.updated, more), update.updated.tau.value_or(0.06));
}

TEST(UpdateTemplate, PutsTheThresholdBetweenRightAndWrongMarks) {
  const MotionTemplate before = TemplateFrom(kClips);
  const TemplateUpdate update = UpdateTemplate(
      before, FeedbackOn(kClips, {kClips[0], kWrongTake},
                         {{"a", 1, 30, Verdict::kRight}, {"wrong", 1, 30, Verdict::kWrong}}));
  EXPECT_EQ(update.clips_added, 0);
  EXPECT_EQ(update.updated.matrix, before.matrix);
  EXPECT_FALSE(update.updated.contrast);
  const double right = CostIn(before, kClips[0]);
  const double wrong = CostIn(before, kWrongTake);
  ASSERT_LT(right, wrong);
  EXPECT_NEAR(update.updated.tau.value(), (right + wrong) / 2, 1e-12);
  EXPECT_THAT(update.updated.tau_origin, HasSubstr("1 right and 1 wrong marks"));
  EXPECT_FALSE(update.contradictory);
}

TEST(UpdateTemplate, ChangesNothingButThresholdsIfNothingIsNew) {
  for (const bool with_contrast : {false, true}) {
    MotionTemplate before = TemplateFrom(kClips);
    if (with_contrast) {
      const std::vector<RecordingStreams> clips = {{kClips[0].features, &kClips[0].poses},
                                                   {kClips[1].features, &kClips[1].poses}};
      before.contrast = MeasureContrast(before, clips, MeasureBackground(clips));
      std::vector<float>& lookalikes = before.contrast->places.lookalikes;
      for (std::size_t i = 0; i < before.contrast->places.mean.size(); ++i) {
        lookalikes.push_back(static_cast<float>(i));
      }
    }
    const TemplateUpdate update = UpdateTemplate(
        before,
        FeedbackOn(kClips, kClips, {{"a", 1, 30, Verdict::kRight}, {"b", 3, 30, Verdict::kRight}}));
    EXPECT_EQ(update.updated.matrix, before.matrix);
    EXPECT_EQ(update.updated.contrast, before.contrast);
    EXPECT_EQ(update.updated.clips, before.clips);
    EXPECT_EQ(update.updated.tau, before.tau);
  }
}

TEST(UpdateTemplate, KeepsLookalikesInTheColumnsOfTheNewMatrix) {
  MotionTemplate before = TemplateFrom(kClips);
  const std::vector<RecordingStreams> clips = {{kClips[0].features, &kClips[0].poses},
                                               {kClips[1].features, &kClips[1].poses}};
  before.contrast = MeasureContrast(before, clips, MeasureBackground(clips));
  // 1 where the first feature holds, 0 elsewhere.
  for (int column = 0; column < before.matrix.column_count(); ++column) {
    const float holds = before.matrix.Column(column)[0] > 0.5 ? 1 : 0;
    before.contrast->places.lookalikes.insert(before.contrast->places.lookalikes.end(), kPoseValues,
                                              holds);
  }
  const TakeFeatures longer = Take("c", 0b001, 19);
  const MotionTemplate updated =
      UpdateTemplate(before, FeedbackOn(kClips, {longer}, {{"c", 1, 39, Verdict::kRight}})).updated;
  ASSERT_NE(updated.matrix.column_count(), before.matrix.column_count());
  const PoseModel& places = updated.contrast->places;
  ASSERT_EQ(places.lookalikes.size(), places.mean.size());
  EXPECT_EQ(places.lookalikes.front(), 0);
  EXPECT_EQ(places.lookalikes.back(), 0);
  EXPECT_EQ(places.lookalikes[places.mean.size() / kPoseValues / 2 * kPoseValues], 1);
}

TEST(UpdateTemplate, SharpensAContrastByWrongHits) {
  MotionTemplate before = TemplateFrom(kClips);
  const std::vector<RecordingStreams> clips = {{kClips[0].features, &kClips[0].poses},
                                               {kClips[1].features, &kClips[1].poses}};
  before.contrast = MeasureContrast(before, clips, MeasureBackground(clips));
  before.tau = 0.9;
  before.calibration = Calibration{.slope = 20, .offset = -18};
  const Feedback feedback = FeedbackOn(kClips, {kWrongTake}, {{"wrong", 1, 30, Verdict::kWrong}});
  const MotionTemplate updated = UpdateTemplate(before, feedback).updated;
  EXPECT_LE(CostIn(before, kWrongTake), *before.tau);
  EXPECT_GT(CostIn(updated, kWrongTake), *updated.tau);
  // Against right ones, which cost as much as ever, it costs more.
  EXPECT_GT(CostIn(updated, kWrongTake) - CostIn(updated, kClips[0]),
            CostIn(before, kWrongTake) - CostIn(before, kClips[0]));
  ASSERT_TRUE(updated.calibration);
  EXPECT_NEAR(Confidence(*updated.calibration, *updated.tau), 0.5, 1e-12);
  // A second update with the marks of the first changes nothing.
  const MotionTemplate again = UpdateTemplate(updated, feedback).updated;
  EXPECT_EQ(again.contrast, updated.contrast);
  EXPECT_EQ(again.tau, updated.tau);
  before.contrast->background.reset();
  EXPECT_THAT(ErrorOf([&] { (void)UpdateTemplate(before, feedback); }).what(),
              HasSubstr("learn it again"));
}

TEST(UpdateTemplate, NoLongerLearnsFromAClipThatIsMarkedWrong) {
  std::vector<TakeFeatures> clips = kClips;
  clips.push_back(kWrongTake);
  const MotionTemplate before = TemplateFrom(clips);
  const TemplateUpdate update =
      UpdateTemplate(before, FeedbackOn(clips, {kWrongTake}, {{"wrong", 4, 28, Verdict::kWrong}}));
  EXPECT_EQ(update.clips_dropped, 1);
  EXPECT_EQ(update.updated.matrix, TemplateFrom(kClips).matrix);
  const std::vector<TakeFeatures> only = {kWrongTake};
  EXPECT_THAT(ErrorOf([&] {
                (void)UpdateTemplate(
                    TemplateFrom(only),
                    FeedbackOn(only, {kWrongTake}, {{"wrong", 1, 30, Verdict::kWrong}}));
              }).what(),
              HasSubstr("all that template 'class' was learned from"));
}

TEST(UpdateTemplate, AveragesInWhatItCannotLearnAgain) {
  MotionTemplate before = TemplateFrom({kClips[0], kClips[0]});
  Feedback feedback = FeedbackOn({}, {kWrongTake}, {{"wrong", 1, 30, Verdict::kRight}});
  feedback.lost = {"a", "a"};
  const TemplateUpdate update = UpdateTemplate(before, feedback);
  EXPECT_EQ(update.matrix, MatrixUpdate::kAveraged);
  // Two clips with 0 and one with 1, in a column of the middle.
  EXPECT_NEAR(update.updated.matrix.Column(15)[1], 1.0 / 3, 1e-12);
  EXPECT_NEAR(update.updated.matrix.Column(15)[0], 1, 1e-12);
  EXPECT_EQ(update.updated.matrix.weights, before.matrix.weights);
  // So it is for a template that somebody changed.
  before.matrix.values[0] = 0.75;
  feedback.lost.clear();
  feedback.clips = {kClips[0], kClips[0]};
  EXPECT_EQ(UpdateTemplate(before, feedback).matrix, MatrixUpdate::kAveragedOwn);
  before.name += " mirrored";
  EXPECT_THAT(ErrorOf([&] { (void)UpdateTemplate(before, feedback); }).what(),
              HasSubstr("mirrored"));
}

TEST(UpdateTemplate, SaysThatMarksContradictEachOther) {
  const MotionTemplate before = TemplateFrom(kClips);
  const TakeFeatures twin = Take("twin", 0b001);
  const TemplateUpdate update = UpdateTemplate(
      before, FeedbackOn(kClips, {twin, Take("other", 0b001)},
                         {{"twin", 1, 30, Verdict::kWrong}, {"other", 1, 30, Verdict::kRight}}));
  EXPECT_TRUE(update.contradictory);
  EXPECT_THAT(update.updated.tau_origin, HasSubstr("fewest mistakes"));
  EXPECT_GE(*update.updated.tau, CostIn(update.updated, Take("other", 0b001)));
}

class MarkTables : public ::testing::Test {
 protected:
  std::vector<ListedMark> Read(const std::string& text) const {
    WriteText(table_, text);
    return ReadMarks(table_);
  }
  void ExpectError(const std::string& text, const std::vector<std::string>& parts) const {
    const Error error = ErrorOf([&] { (void)Read(text); });
    EXPECT_EQ(error.code(), ErrorCode::kMalformedFile);
    for (const std::string& part : parts) EXPECT_THAT(error.what(), HasSubstr(part));
  }

  TemporaryFolder folder_;
  fs::path table_ = folder_.path() / "hits";
};

TEST_F(MarkTables, AreCsvOrJson) {
  const std::vector<TemplateMark> expected = {{"a.amc", 5, 90, Verdict::kRight},
                                              {"b.amc", 1, 7, Verdict::kWrong}};
  for (const std::string text :
       {"cost,file,first_frame,last_frame,verdict\n0.1,a.amc,5,90,right\n0.2,c.amc,1,2,\n"
        "0.3,b.amc,1,7, Wrong\n",
        R"({"hits": [{"file": "a.amc", "first_frame": 5, "last_frame": 90, "verdict": "right"},
            {"file": "c.amc", "first_frame": 1, "last_frame": 2},
            {"file": "c.amc", "first_frame": 3, "last_frame": 4, "verdict": null},
            {"file": "b.amc", "first_frame": 1, "last_frame": 7, "verdict": "wrong"}]})"}) {
    std::vector<TemplateMark> marks;
    for (const ListedMark& listed : Read(text)) marks.push_back(listed.mark);
    EXPECT_EQ(marks, expected) << text;
  }
}

TEST_F(MarkTables, SayWhereSomethingIsWrong) {
  ExpectError("file,first_frame,last_frame,verdict\na,1,2,right\na,1,2,maybe\n",
              {"hits:3", "'maybe'", "right or wrong"});
  ExpectError("file,first_frame,last_frame,verdict\na,0,2,right\n", {"hits:2", "0 to 2"});
  ExpectError("file,first_frame,last_frame,verdict\na,one,2,right\n", {"hits:2", "'one'"});
  ExpectError("file,first_frame,last_frame\na,1,2\n", {"verdict"});
  ExpectError("{\"hits\": [", {"not JSON"});
  ExpectError("{}", {"no list of hits"});
  ExpectError(R"({"hits": [{}, {"verdict": "right", "file": "a"}]})", {"hit 2", "first_frame"});
  ExpectError(R"({"hits": [{"verdict": true}]})", {"hit 1", "verdict"});
}

}  // namespace
}  // namespace kinebase::test
