// Classes of which there is little to learn from: one clip, one actor, clips that are too short.
#include "kinebase/library/class_learning.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "kinebase/core/error.h"
#include "kinebase/library/evaluation.h"
#include "support/files.h"
#include "support/temporary_folder.h"

namespace kinebase::test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

FeatureSet TwoFeatures() { return {.name = "two", .hash = 2}; }

// At 120 Hz, four frames a column.
TakeFeatures Take(const std::string& name, int columns) {
  TakeFeatures take{
      .path = name + ".amc", .rate_hz = 120, .frame_count = std::int64_t{4} * columns};
  take.features = {.rate_hz = 30, .feature_count = 2};
  take.features.columns.resize(static_cast<std::size_t>(columns));
  take.poses.rate_hz = 30;
  take.poses.values.resize(static_cast<std::size_t>(columns) * kPoseValues);
  return take;
}

// "a" is the first feature in the middle half, "b" the second; the hand goes along.
LabelledClip Clip(const std::string& class_name, const std::string& actor, int columns = 12) {
  LabelledClip clip{Take(class_name + actor, columns), class_name, actor};
  const bool is_a = class_name == "a";
  for (int column = columns / 4; column < columns - columns / 4; ++column) {
    const auto c = static_cast<std::size_t>(column);
    clip.take.features.columns[c] = is_a ? 0b01 : 0b10;
    clip.take.poses.values[c * kPoseValues] = is_a ? 1.0F : -1.0F;
  }
  return clip;
}

std::vector<const LabelledClip*> Pointers(const std::vector<LabelledClip>& clips) {
  std::vector<const LabelledClip*> pointers;
  pointers.reserve(clips.size());
  for (const LabelledClip& clip : clips) pointers.push_back(&clip);
  return pointers;
}

struct Learned {
  std::vector<MotionTemplate> templates;
  Evidence evidence;
};

Learned Learn(const std::vector<LabelledClip>& clips) {
  const auto pointers = Pointers(clips);
  Learned learned{.templates = LearnClasses(pointers, TwoFeatures())};
  const std::array methods = {*FindMethod("mt+")};
  learned.evidence = GatherEvidence(pointers, learned.templates, TwoFeatures(), methods).front();
  Calibrate(learned.evidence, learned.templates);
  return learned;
}

std::size_t CountRight(std::span<const KnownHit> hits) {
  return static_cast<std::size_t>(std::ranges::count(hits, true, &KnownHit::right));
}

TEST(ClassLearning, OfAClassWithOneClipKnowsNothingUnseenOfIt) {
  const Learned learned = Learn({Clip("a", "x"), Clip("b", "x"), Clip("b", "y")});
  ASSERT_THAT(learned.templates, SizeIs(2));
  EXPECT_THAT(learned.evidence.at("a").seen,
              testing::Contains(testing::Field(&KnownHit::right, true)));
  EXPECT_EQ(CountRight(learned.evidence.at("a").unseen), 0);
  EXPECT_EQ(CountRight(learned.evidence.at("b").unseen), 2);
  // Between its own clip, which costs nothing, and the best of the other class.
  ASSERT_TRUE(learned.templates[0].tau);
  double best_wrong = 9;
  for (const auto* hits : {&learned.evidence.at("a").seen, &learned.evidence.at("a").unseen}) {
    for (const KnownHit& hit : *hits) {
      if (!hit.right) best_wrong = std::min(best_wrong, hit.cost);
    }
  }
  EXPECT_NEAR(*learned.templates[0].tau, best_wrong / 2, 1e-6);
}

TEST(ClassLearning, OfAClassThatOneActorPerformsLearnsFromThatOne) {
  const Learned learned =
      Learn({Clip("a", "x"), Clip("a", "x", 14), Clip("b", "x"), Clip("b", "y")});
  EXPECT_EQ(CountRight(learned.evidence.at("a").seen), 2);
  EXPECT_EQ(CountRight(learned.evidence.at("a").unseen), 0);  // Nobody is left to learn from.
  EXPECT_TRUE(learned.templates[0].calibration);
}

TEST(ClassLearning, OfOneActorHoldsHalvesOfTheClipsBack) {
  const Learned learned =
      Learn({Clip("a", "x"), Clip("a", "x", 14), Clip("b", "x"), Clip("b", "x")});
  EXPECT_EQ(CountRight(learned.evidence.at("a").unseen), 2);
  EXPECT_EQ(CountRight(learned.evidence.at("b").unseen), 2);
  // With one clip a class there are no halves.
  const Learned single = Learn({Clip("a", "x"), Clip("b", "x")});
  EXPECT_THAT(single.evidence.at("a").unseen, IsEmpty());
  EXPECT_TRUE(single.templates[0].tau);
}

// Slopes from ½ to 2: what is shorter than half the template is found nowhere.
TEST(ClassLearning, DoesNotFindClipsShorterThanHalfTheTemplate) {
  const std::vector<LabelledClip> clips = {Clip("a", "x", 40), Clip("a", "y", 40),
                                           Clip("a", "z", 12), Clip("b", "x"), Clip("b", "y")};
  const Learned learned = Learn(clips);
  ASSERT_GT(learned.templates[0].matrix.column_count(), 24);
  EXPECT_EQ(CountRight(learned.evidence.at("a").seen), 2);
  const auto hits =
      RankHits(learned.templates,
               std::vector<RecordingStreams>{{clips[2].take.features, &clips[2].take.poses}});
  EXPECT_THAT(hits[0], IsEmpty());
}

// Two clips that contradict each other everywhere leave a template that asks for nothing.
TEST(ClassLearning, OfWhatNothingIsCommonToGetsNoThreshold) {
  std::vector<LabelledClip> clips = {Clip("a", "x"), Clip("a", "y"), Clip("b", "x"),
                                     Clip("b", "y")};
  for (std::uint64_t& word : clips[0].take.features.columns) word = 0b00;
  for (std::uint64_t& word : clips[1].take.features.columns) word = 0b11;
  const Learned learned = Learn(clips);
  for (const double weight : learned.templates[0].contrast->entry_weights) EXPECT_EQ(weight, 0);
  for (const KnownHit& hit : learned.evidence.at("a").seen) EXPECT_LT(hit.cost, 0.4 + 1e-9);
  const std::array methods = {*FindMethod("mt+weights")};
  const auto pointers = Pointers(clips);
  std::vector<MotionTemplate> templates = LearnClasses(pointers, TwoFeatures());
  Calibrate(GatherEvidence(pointers, templates, TwoFeatures(), methods).front(), templates);
  EXPECT_FALSE(templates[0].tau);  // Right and wrong alike cost nothing.
  EXPECT_FALSE(templates[0].calibration);
  EXPECT_TRUE(templates[1].tau);
}

TEST(ClassLearning, NeedsAPoseForEachColumn) {
  std::vector<LabelledClip> clips = {Clip("a", "x"), Clip("b", "x")};
  clips[1].take.poses.values.clear();
  EXPECT_THAT(ErrorOf([&] { (void)LearnClasses(Pointers(clips), TwoFeatures()); }).what(),
              HasSubstr("12 columns of features and 0 poses"));
  EXPECT_THAT(LearnClasses(Pointers(clips), TwoFeatures(), {.with_contrast = false}), SizeIs(2));
}

EvaluationData DataOf(std::vector<LabelledClip> clips) {
  EvaluationData data{.clips = std::move(clips)};
  for (const char* name : {"d1", "d2"}) data.distractors.push_back(Take(name, 700));
  return data;
}

EvaluateOptions Options(Protocol protocol = Protocol::kLeaveOneActorOut) {
  return {.protocol = protocol, .methods = {*FindMethod("mt"), *FindMethod("mt+")}};
}

TEST(Evaluate, LeavesOutClassesThatOneActorPerforms) {
  const EvaluationData data = DataOf({Clip("a", "x"), Clip("b", "x"), Clip("b", "y")});
  const Evaluation evaluation = Evaluate(data, TwoFeatures(), Options());
  for (const MethodResult& result : evaluation.methods) {
    EXPECT_THAT(result.classes[0].by_actor, IsEmpty());
    EXPECT_THAT(result.classes[1].by_actor, SizeIs(2));
    EXPECT_EQ(result.macro.ap_strict, result.classes[1].mean.ap_strict);
    EXPECT_EQ(result.macro.ap_strict, 1);
  }
  const std::string none =
      ErrorOf([&] {
        (void)Evaluate(DataOf({Clip("a", "x"), Clip("b", "y")}), TwoFeatures(), Options());
      }).what();
  EXPECT_THAT(none, HasSubstr("no class is performed by two actors"));
  EXPECT_THAT(ErrorOf([&] { (void)Evaluate(DataOf({}), TwoFeatures(), Options()); }).what(),
              HasSubstr("two or more"));
}

TEST(Evaluate, OfHalvesLeavesOutClassesWithOneClip) {
  const Evaluation evaluation = Evaluate(DataOf({Clip("a", "x"), Clip("b", "x"), Clip("b", "x")}),
                                         TwoFeatures(), Options(Protocol::kHalf));
  EXPECT_THAT(evaluation.methods[0].classes[0].by_actor, IsEmpty());
  EXPECT_EQ(evaluation.methods[0].macro.ap_strict, 1);
  EXPECT_THAT(ErrorOf([&] {
                (void)Evaluate(DataOf({Clip("a", "x"), Clip("b", "x")}), TwoFeatures(),
                               Options(Protocol::kHalf));
              }).what(),
              HasSubstr("no class has two clips"));
}

TEST(EvaluateAnnotation, LeavesOutClassesAndActorsThatNobodyElseCanStandFor) {
  // Only z performs a.
  const EvaluationData data = DataOf({Clip("b", "x", 40), Clip("b", "y", 40), Clip("a", "z", 40)});
  const auto results = EvaluateAnnotation(data, TwoFeatures(), Options());
  for (const AnnotateEvaluation& result : results) {
    EXPECT_THAT(result.by_actor, SizeIs(2));
    EXPECT_FALSE(result.by_actor.contains("z"));
    EXPECT_EQ(AnnotationAccuracy::Micro(result.accuracy.segments).recall(), 1);
  }
  EXPECT_THAT(ErrorOf([&] {
                (void)EvaluateAnnotation(DataOf({Clip("a", "x"), Clip("b", "y")}), TwoFeatures(),
                                         Options());
              }).what(),
              HasSubstr("no class is performed by two actors"));
}

// Class "a" is the first feature in the middle, or the second; class "b" is both at once.
std::vector<LabelledClip> ClipsOfTwoStyles() {
  std::vector<LabelledClip> clips;
  for (const char* actor : {"x", "y"}) {
    for (const int columns : {12, 13, 14}) {
      clips.push_back(Clip("a", actor, columns));
      LabelledClip& other = clips.emplace_back(Clip("b", actor, columns));
      other.class_name = clips.front().class_name;
      LabelledClip& both = clips.emplace_back(Clip("b", actor, columns));
      for (std::uint64_t& word : both.take.features.columns) word |= word >> 1U;
    }
  }
  for (LabelledClip& clip : clips) std::ranges::fill(clip.take.poses.values, 0.0F);
  return clips;
}

TEST(ClassLearning, LearnsOneTemplateOfEachStyle) {
  const std::vector<LabelledClip> clips = ClipsOfTwoStyles();
  const auto pointers = Pointers(clips);
  EXPECT_THAT(LearnClasses(pointers, TwoFeatures()), SizeIs(2));
  const auto templates = LearnClasses(pointers, TwoFeatures(), {.with_styles = true});
  ASSERT_THAT(templates, SizeIs(3));
  EXPECT_EQ(templates[0].name, "a");
  EXPECT_EQ(templates[1].name, "a");
  EXPECT_EQ(templates[2].name, "b");
  EXPECT_THAT(templates[0].clips, SizeIs(6));
  EXPECT_THAT(templates[1].clips, SizeIs(6));
}

// One template of both leaves open which of the features it is, so that b's clips fit as well.
TEST(Evaluate, FindsStylesWithTheirTemplatesAlone) {
  const EvaluationData data = DataOf(ClipsOfTwoStyles());
  const Evaluation evaluation =
      Evaluate(data, TwoFeatures(),
               {.methods = {*FindMethod("mt+"), *FindMethod("mt+styles"), *FindMethod("mt")}});
  const ClassResult& together = evaluation.methods[0].classes[0];
  const ClassResult& apart = evaluation.methods[1].classes[0];
  EXPECT_EQ(apart.mean.ap_strict, 1);
  EXPECT_EQ(apart.mean.at_own.f1, 1);
  EXPECT_LT(together.mean.ap_strict, 0.8);
  // What has no styles is not touched.
  EXPECT_EQ(evaluation.methods[1].classes[1].mean.ap_strict, 1);
}

TEST(ClassLearning, KeepsThePosesOfWhatLooksLikeTheClass) {
  const std::vector<LabelledClip> clips = {Clip("a", "x"), Clip("a", "y"), Clip("b", "x"),
                                           Clip("b", "y")};
  const auto pointers = Pointers(clips);
  // The same features as "a", the hand elsewhere.
  LabelledClip like = Clip("a", "z");
  for (float& value : like.take.poses.values) value *= 2;
  const std::vector<RecordingStreams> unlabelled(200, {like.take.features, &like.take.poses});
  const auto templates = LearnClasses(pointers, TwoFeatures(), {.unlabelled = unlabelled});
  const PoseModel& places = templates[0].contrast->places;
  ASSERT_EQ(places.lookalikes.size(), places.mean.size());
  const std::size_t middle = places.mean.size() / kPoseValues / 2 * kPoseValues;
  EXPECT_EQ(places.mean[middle], 1);
  EXPECT_EQ(places.lookalikes[middle], 2);
  EXPECT_EQ(places.lookalikes[0], 0);
  // Clips of other classes serve where there is nothing else; those of its own never do.
  const auto alone = LearnClasses(pointers, TwoFeatures());
  EXPECT_LE(alone[0].contrast->places.lookalikes[middle], 0);
  const std::vector<LabelledClip> only = {Clip("a", "x"), Clip("a", "y")};
  EXPECT_THAT(LearnClasses(Pointers(only), TwoFeatures())[0].contrast->places.lookalikes,
              IsEmpty());
}

TEST(ListOfClips, SaysWhichLineHasNoClass) {
  const auto error_of = [](std::string_view text) {
    return ErrorOf([&] { (void)ParseClipList(text, "clips.csv"); });
  };
  EXPECT_THAT(error_of("file,class\na.amc,x\nb.amc, \n").what(),
              HasSubstr("clips.csv:3: a clip without a class"));
  EXPECT_THAT(error_of("file,class\n,x\n").what(), HasSubstr("clips.csv:2: a clip without a file"));
  EXPECT_EQ(error_of("file,actor\na.amc,x\n").code(), ErrorCode::kMalformedFile);
}

TEST(LabelledClips, OfAFileThatIsListedAsTwoClassesAreAFailureBeside) {
  const TemporaryFolder folder;
  const auto file = folder.path() / "a.csm";
  WriteText(file, "no recording");
  const std::vector<ListedClip> listed = {
      {.name = "a.csm", .file = file, .class_name = "a", .line = 2},
      {.name = "a.csm", .file = file, .class_name = "a", .line = 3},
      {.name = "a.csm", .file = file, .class_name = "b", .line = 4}};
  const LabelledBatch batch = LoadLabelledClips(listed, LoadFeatureSet("bonn"), 30, {}, 1, {});
  EXPECT_THAT(batch.clips, IsEmpty());
  ASSERT_THAT(batch.failures, SizeIs(2));
  EXPECT_THAT(batch.failures[0].error.what(), HasSubstr("as 'a' in line 2 and as 'b' in line 4"));
}

}  // namespace
}  // namespace kinebase::test
