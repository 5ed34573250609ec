#include "kinebase/library/paper_tables.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "kinebase/core/error.h"
#include "kinebase/library/hdm05.h"
#include "library/one_feature_takes.h"

namespace kinebase::test {
namespace {

using testing::Contains;
using testing::DoubleNear;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Optional;
using testing::SizeIs;

std::optional<double> Figure(const PaperTable& table, const PaperFigures& figures,
                             const std::string& column) {
  const auto found = std::ranges::find(table.columns, column);
  if (found == table.columns.end()) ADD_FAILURE() << "no column " << column;
  if (found == table.columns.end() || figures.empty()) return std::nullopt;
  return figures[static_cast<std::size_t>(found - table.columns.begin())];
}

const PaperRow& RowOf(const PaperTable& table, const std::string& paper_class,
                      const std::string& variant = "") {
  const auto found = std::ranges::find_if(table.rows, [&](const PaperRow& row) {
    return row.paper_class == paper_class && row.variant == variant;
  });
  EXPECT_NE(found, table.rows.end()) << paper_class << ' ' << variant;
  return *found;
}

double SumOf(const PaperTable& table, const std::string& column) {
  double sum = 0;
  for (const PaperRow& row : table.rows) sum += Figure(table, row.paper, column).value_or(0);
  return sum;
}

std::map<std::string, int> ClipsByHdm05() {
  std::map<std::string, int> clips;
  for (const Hdm05Class& each : Hdm05().classes) clips[each.name] = each.clip_count;
  return clips;
}

std::set<std::string> NamesOf(const std::map<std::string, int>& clips) {
  std::set<std::string> names;
  for (const auto& [name, count] : clips) names.insert(name);
  return names;
}

TEST(PaperTables, HaveAsManyRowsAsThePaper) {
  EXPECT_THAT(ReadPaperTable(PaperPreset::kTable1).rows, SizeIs(10));
  EXPECT_THAT(ReadPaperTable(PaperPreset::kTable2).rows, SizeIs(22));
  EXPECT_THAT(ReadPaperTable(PaperPreset::kTable3).rows, SizeIs(8 + 3));
  EXPECT_THAT(ReadPaperTable(PaperPreset::kTable4).rows, SizeIs(5 * 4));
  EXPECT_THAT(ReadPaperTable(PaperPreset::kTable5).rows, SizeIs(5 * 3));
  // Four cartwheels, jumping jacks and squats; the first quantised and not.
  EXPECT_THAT(ReadPaperTable(PaperPreset::kFigure7).rows, SizeIs(3 + 1));
  EXPECT_THAT(ReadPaperTable(PaperPreset::kFigure8).rows, SizeIs(4));
}

// What the paper's text repeats of its tables.
TEST(PaperTables, AgreeWithThePapersText) {
  const PaperTable learning = ReadPaperTable(PaperPreset::kTable1);
  const PaperFigures& cartwheel = RowOf(learning, "CartwheelLeft").paper;
  EXPECT_THAT(cartwheel, ElementsAre(21, 11, 105.3, 6, 17.0));
  EXPECT_THAT(RowOf(learning, "RotateRArmFwd3").paper, ElementsAre(16, 8, 83.6, 4, 3.9));
  const PaperTable hits = ReadPaperTable(PaperPreset::kTable2);
  const PaperFigures& claps = RowOf(hits, "ClapHandsAboveHead").paper;
  EXPECT_THAT(Figure(hits, claps, "hits_0.02"), Optional(7));
  EXPECT_THAT(Figure(hits, claps, "right_0.02"), Optional(7));
  EXPECT_THAT(Figure(hits, claps, "hits_0.04"), Optional(16));
  EXPECT_THAT(Figure(hits, claps, "right_0.04"), Optional(8));
  EXPECT_EQ(Figure(hits, claps, "right_0.06"), std::nullopt);  // Lost.
  const PaperFigures& grabs = RowOf(hits, "GrabHighRHand").paper;
  EXPECT_THAT(Figure(hits, grabs, "hits_0.04"), Optional(49));
  EXPECT_THAT(Figure(hits, grabs, "right_0.04"), Optional(12));
  const PaperTable keyframes = ReadPaperTable(PaperPreset::kTable3);
  EXPECT_THAT(RowOf(keyframes, "CartwheelLeft", "automatic").paper,
              ElementsAre(2, 2.8, 1.3, 0.02, 24, 21, 20, 0.83));
}

TEST(PaperTables, AgreeWithEachOther) {
  const PaperTable learning = ReadPaperTable(PaperPreset::kTable1);
  const PaperTable hits = ReadPaperTable(PaperPreset::kTable2);
  EXPECT_EQ(SumOf(learning, "size"), 280);
  EXPECT_EQ(SumOf(hits, "clips"), 282);
  int in_both = 0;
  for (const PaperRow& row : learning.rows) {
    const double size = *Figure(learning, row.paper, "size");
    const double learned_from = *Figure(learning, row.paper, "learned_from");
    EXPECT_EQ(learned_from, std::ceil(size / 2)) << row.paper_class;
    for (const PaperRow& other : hits.rows) {
      if (other.paper_class != row.paper_class) continue;
      ++in_both;
      EXPECT_THAT(Figure(hits, other.paper, "clips"), Optional(size - learned_from));
    }
  }
  EXPECT_EQ(in_both, 8);
}

TEST(PaperTables, HaveWhatCanBe) {
  const PaperTable hits = ReadPaperTable(PaperPreset::kTable2);
  for (const PaperRow& row : hits.rows) {
    double before = 0;
    for (const char* tau : {"0.01", "0.02", "0.04", "0.06", "0.08", "0.1"}) {
      const double found = *Figure(hits, row.paper, std::string("hits_") + tau);
      EXPECT_GE(found, before) << row.paper_class << ' ' << tau;
      before = found;
      const double right = Figure(hits, row.paper, std::string("right_") + tau).value_or(0);
      EXPECT_LE(right, std::min(found, *Figure(hits, row.paper, "clips")));
    }
  }
  const PaperTable keyframes = ReadPaperTable(PaperPreset::kTable3);
  for (const PaperRow& row : keyframes.rows) {
    EXPECT_LE(*Figure(keyframes, row.paper, "right"), *Figure(keyframes, row.paper, "hits"));
    EXPECT_LE(*Figure(keyframes, row.paper, "right"), *Figure(keyframes, row.paper, "clips"));
    const double minutes = *Figure(keyframes, row.paper, "minutes");
    EXPECT_THAT(Figure(keyframes, row.paper, "percent"),
                Optional(DoubleNear(minutes / 210 * 100, 0.15)));
  }
  const PaperTable top = ReadPaperTable(PaperPreset::kTable4);
  for (const PaperRow& row : top.rows) {
    EXPECT_LE(*Figure(top, row.paper, "top_5"), *Figure(top, row.paper, "top_10"));
    EXPECT_LE(*Figure(top, row.paper, "top_10"), *Figure(top, row.paper, "top_20"));
    EXPECT_LE(*Figure(top, row.paper, "top_20"), *Figure(top, row.paper, "clips"));
  }
}

TEST(PaperClasses, AreKnownToHdm05InAsManyClips) {
  const std::map<std::string, int> clips = ClipsByHdm05();
  const PaperClasses classes = PaperClasses::BuiltIn();
  for (const PaperPreset preset :
       {PaperPreset::kTable1, PaperPreset::kTable2, PaperPreset::kTable3, PaperPreset::kTable4,
        PaperPreset::kTable5, PaperPreset::kFigure7, PaperPreset::kFigure8}) {
    const PaperTable table = ReadPaperTable(preset);
    for (const PaperRow& row : table.rows) {
      const auto found = classes.Find(row.paper_class, NamesOf(clips));
      ASSERT_THAT(found.names, Not(IsEmpty())) << row.paper_class;
      // The one class that HDM05 has in another number says so.
      if (row.paper_class == "WalkSideRight3") {
        EXPECT_THAT(found.note, HasSubstr("13"));
      }
      if (!found.note.empty()) continue;
      int size = 0;
      int searched = 0;
      for (const std::string& name : found.names) {
        size += clips.at(name);
        searched += clips.at(name) / 2;
      }
      if (preset == PaperPreset::kTable1) {
        EXPECT_THAT(Figure(table, row.paper, "size"), Optional(size)) << row.paper_class;
      }
      if (preset == PaperPreset::kTable2) {
        EXPECT_THAT(Figure(table, row.paper, "clips"), Optional(searched)) << row.paper_class;
      }
    }
  }
}

TEST(PaperClasses, AreFoundByTheFirstRowWhoseNamesAreAllHere) {
  const PaperClasses classes = PaperClasses::Parse(
      "class,hdm05,note\nSquat,one two,\nSquat,three,another\nSquat,four,a third\n", "mine.csv");
  EXPECT_THAT(classes.Find("Squat", {"one", "two", "three"}).names, ElementsAre("one", "two"));
  const auto other = classes.Find("Squat", {"one", "three", "four"});
  EXPECT_THAT(other.names, ElementsAre("three"));
  EXPECT_EQ(other.note, "another");
  EXPECT_THAT(classes.Find("Squat", {"one"}).names, IsEmpty());
  EXPECT_THAT(classes.Find("HopRLeg", {"one", "two"}).names, IsEmpty());
}

TEST(PaperClasses, MayDoWithoutNotesButNotWithoutNames) {
  EXPECT_THAT(
      PaperClasses::Parse("class,hdm05\nSquat,one\n", "mine.csv").Find("Squat", {"one"}).names,
      ElementsAre("one"));
  for (const char* wrong : {"Squat,", "Sqat,one", ",one"}) {
    try {
      (void)PaperClasses::Parse(std::string("class,hdm05\nSquat,one\n") + wrong + "\n", "mine.csv");
      FAIL() << wrong;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::kMalformedFile);
      EXPECT_THAT(error.what(), HasSubstr("mine.csv:3"));
    }
  }
  EXPECT_THROW((void)PaperClasses::Parse("class,name\nSquat,one\n", "mine.csv"), Error);
}

TEST(PaperPresets, HaveNames) {
  for (const std::string_view name : PaperPresetNames()) {
    ASSERT_NE(ParsePaperPreset(name), std::nullopt);
    EXPECT_EQ(ToString(*ParsePaperPreset(name)), name);
  }
  EXPECT_EQ(ParsePaperPreset("table6"), std::nullopt);
}

// ----------------------------------------------------------------------------------------------
// Clips of one feature, whose hits can be counted on the fingers.

constexpr int kColumns = 7;  // Of a clip.

FeatureSet OneFeature() {
  FeatureSet set{.name = "one", .hash = 1};
  set.features.resize(1);
  set.features[0].group = "upper";
  return set;
}

JointStream Still(JointStreamKind kind, int columns) {
  JointStream stream{.kind = kind, .rate_hz = 30, .joint_count = 1};
  stream.values.assign(static_cast<std::size_t>(columns) * stream.numbers_per_column(), 0.5F);
  return stream;
}

// Clips that show "0, then 1 up to the last column, then 0"; those of `still` show nothing.
void AddClips(EvaluationData& data, const std::string& name, int count, bool still = false,
              int columns = kColumns) {
  for (int i = 0; i < count; ++i) {
    LabelledClip& clip = data.clips.emplace_back();
    clip.take = still ? OneFeatureTake(columns, {}) : OneFeatureTake(columns, {{1, columns - 2}});
    clip.take.path = name + std::to_string(i) + ".amc";
    clip.take.rotations = Still(JointStreamKind::kRotations, columns);
    clip.take.positions = Still(JointStreamKind::kPositions, columns);
    clip.class_name = name;
    clip.actor = i % 4 < 2 ? "a" : "b";
  }
}

// A take that shows the motion twice.
TakeFeatures Distractor() {
  constexpr int kLength = 40;
  TakeFeatures take = OneFeatureTake(kLength, {{5, 9}, {25, 29}});
  take.path = "other.amc";
  take.rotations = Still(JointStreamKind::kRotations, kLength);
  take.positions = Still(JointStreamKind::kPositions, kLength);
  return take;
}

// Four squats, four clips of nothing, a distractor with two squats.
EvaluationData Squats() {
  EvaluationData data;
  AddClips(data, "squat1Reps", 4);
  AddClips(data, "standing", 4, true);
  data.distractors.push_back(Distractor());
  return data;
}

PaperTable Compare(PaperPreset preset, const EvaluationData& data) {
  return CompareWithPaper(preset, data, OneFeature()).table;
}

TEST(CompareWithPaper, SaysHowClassesWereLearned) {
  EvaluationData data;
  AddClips(data, "squat1Reps", 1);
  AddClips(data, "squat1Reps", 1, false, 50);  // Not learned from.
  AddClips(data, "squat1Reps", 1, false, 9);
  const PaperTable table = Compare(PaperPreset::kTable1, data);
  const PaperRow& squat = RowOf(table, "Squat");
  EXPECT_THAT(squat.here, ElementsAre("squat1Reps"));
  EXPECT_THAT(Figure(table, squat.ours, "size"), Optional(3));
  EXPECT_THAT(Figure(table, squat.ours, "learned_from"), Optional(2));
  EXPECT_THAT(Figure(table, squat.ours, "mean_length"), Optional(8));
  EXPECT_THAT(Figure(table, squat.ours, "seconds"), Optional(testing::Gt(0)));
  EXPECT_THAT(RowOf(table, "LieDownFloor").here, IsEmpty());
  EXPECT_THAT(RowOf(table, "LieDownFloor").ours, IsEmpty());
  // Equal clips agree after one round.
  const PaperTable equal = Compare(PaperPreset::kTable1, Squats());
  EXPECT_THAT(Figure(equal, RowOf(equal, "Squat").ours, "rounds"), Optional(1));
}

TEST(CompareWithPaper, CountsHitsInWhatWasNotLearnedFrom) {
  const PaperTable table = Compare(PaperPreset::kTable2, Squats());
  const PaperFigures& squat = RowOf(table, "Squat").ours;
  EXPECT_THAT(Figure(table, squat, "clips"), Optional(2));
  EXPECT_THAT(Figure(table, squat, "columns"), Optional(kColumns));
  for (const char* tau : {"0.01", "0.02", "0.04", "0.06", "0.08", "0.1"}) {
    // Two clips, and twice in the distractor. The next best lack a column: 1/7.
    EXPECT_THAT(Figure(table, squat, std::string("hits_") + tau), Optional(4)) << tau;
    EXPECT_THAT(Figure(table, squat, std::string("right_") + tau), Optional(2)) << tau;
  }
}

TEST(CompareWithPaper, LeavesOutWhatMayShowTheClass) {
  EvaluationData data = Squats();
  data.possibly_relevant =
      PossiblyRelevant::Parse("class,trial,label\nsquat1Reps,other,*\n", "relevant.csv",
                              "trial,label,first_frame_1based,last_frame_1based\n", "labels.csv");
  const PaperTable hits = Compare(PaperPreset::kTable2, data);
  EXPECT_THAT(Figure(hits, RowOf(hits, "Squat").ours, "hits_0.06"), Optional(2));
  // Classes go by the paper's names there.
  AddClips(data, "hopBothLegs1hops", 4, true);
  data.possibly_relevant.AlsoAs("squat1Reps", "hopBothLegs1hops");
  const PaperTable fuzzy = Compare(PaperPreset::kTable5, data);
  EXPECT_THAT(Figure(fuzzy, RowOf(fuzzy, "HopBothLegs", "mt at 0.06").ours, "recall"), Optional(1));
}

TEST(CompareWithPaper, SearchesAroundKeyframes) {
  const PaperTable table = Compare(PaperPreset::kTable3, Squats());
  const PaperFigures& squat = RowOf(table, "Squat", "automatic").ours;
  EXPECT_THAT(Figure(table, squat, "keyframes"), Optional(1));
  EXPECT_THAT(Figure(table, squat, "clips"), Optional(4));
  EXPECT_THAT(Figure(table, squat, "hits"), Optional(6));
  EXPECT_THAT(Figure(table, squat, "right"), Optional(4));
  // All four squats and the distractor; around a motion there are more than 10 columns either way.
  const double columns = 4 * kColumns + 40;
  EXPECT_THAT(Figure(table, squat, "minutes"), Optional(DoubleNear(columns / 30 / 60, 1e-12)));
  EXPECT_THAT(Figure(table, squat, "percent"),
              Optional(DoubleNear(100 * columns / (columns + 4 * kColumns), 1e-9)));
}

TEST(CompareWithPaper, PutsExamplesBesideTemplates) {
  EvaluationData data;
  AddClips(data, "squat1Reps", 50);
  AddClips(data, "standing", 4, true);
  const PaperComparison comparison = CompareWithPaper(PaperPreset::kTable4, data, OneFeature(), {});
  const PaperTable& table = comparison.table;
  for (const char* method : {"mt", "rf"}) {
    const PaperFigures& squat = RowOf(table, "Squat", method).ours;
    EXPECT_THAT(Figure(table, squat, "clips"), Optional(10)) << method;  // Half of 20.
    EXPECT_THAT(Figure(table, squat, "top_5"), Optional(DoubleNear(5, 1e-9))) << method;
    EXPECT_THAT(Figure(table, squat, "top_10"), Optional(DoubleNear(10, 1e-9))) << method;
    EXPECT_THAT(Figure(table, squat, "top_20"), Optional(DoubleNear(10, 1e-9))) << method;
  }
  EXPECT_THAT(RowOf(table, "Squat", "q").ours, Not(IsEmpty()));
  EXPECT_THAT(RowOf(table, "Squat", "3d").ours, Not(IsEmpty()));
  EXPECT_THAT(comparison.notes, Contains(HasSubstr("12 clips of 2 classes")));
}

TEST(CompareWithPaper, PutsFuzzyRetrievalBesideTemplates) {
  EvaluationData data = Squats();
  for (LabelledClip& clip : data.clips) {
    if (clip.class_name == "squat1Reps") clip.class_name = "hopBothLegs1hops";
  }
  const PaperTable table = Compare(PaperPreset::kTable5, data);
  for (const char* method : {"mt at 0.02", "mt at 0.06"}) {
    const PaperFigures& hop = RowOf(table, "HopBothLegs", method).ours;
    EXPECT_THAT(Figure(table, hop, "recall"), Optional(1)) << method;
    EXPECT_THAT(Figure(table, hop, "precision"), Optional(0.5)) << method;
  }
  // Fuzzy hits are whole segments: the two in the distractor overlap in the pause between them, and
  // one of them stays.
  const PaperFigures& fuzzy = RowOf(table, "HopBothLegs", "fuzzy").ours;
  EXPECT_THAT(Figure(table, fuzzy, "recall"), Optional(1));
  EXPECT_THAT(Figure(table, fuzzy, "precision"), Optional(DoubleNear(2.0 / 3, 1e-12)));
}

TEST(CompareWithPaper, ShowsASequenceAndFillsPlaces) {
  EvaluationData data;
  AddClips(data, "cartwheelLHandStart1Reps", 8);
  AddClips(data, "jumpingJack1Reps", 6, true);
  AddClips(data, "standing", 12, true);
  const PaperComparison comparison =
      CompareWithPaper(PaperPreset::kFigure7, data, OneFeature(), {});
  EXPECT_THAT(comparison.notes, Contains("Squat is not here; standing has its place"));
  ASSERT_TRUE(comparison.sequence);
  const PaperSequence& sequence = *comparison.sequence;
  ASSERT_THAT(sequence.parts, SizeIs(4 + 3 + 4));
  EXPECT_EQ(sequence.parts[1].first, kColumns);
  EXPECT_EQ(sequence.parts[1].last, 2 * kColumns - 1);
  EXPECT_EQ(sequence.parts.back().class_name, "standing");
  ASSERT_THAT(sequence.curves, SizeIs(2));
  for (const PaperSequence::Curve& each : sequence.curves) {
    EXPECT_THAT(each.curve.delta, SizeIs((4 + 3 + 4) * kColumns));
    EXPECT_THAT(each.hits, SizeIs(4)) << each.variant;
    for (int i = 1; i <= 4; ++i) {
      EXPECT_EQ(each.curve.delta[static_cast<std::size_t>(i * kColumns) - 1], 0) << each.variant;
    }
  }
  const PaperTable& table = comparison.table;
  for (const char* variant : {"quantised", "not quantised"}) {
    const PaperFigures& wheel = RowOf(table, "CartwheelLeft", variant).ours;
    EXPECT_THAT(Figure(table, wheel, "clips"), Optional(4));
    EXPECT_THAT(Figure(table, wheel, "best_right"), Optional(4));
    EXPECT_THAT(Figure(table, wheel, "highest_right"), Optional(0));
    EXPECT_THAT(Figure(table, wheel, "lowest_other"), Optional(testing::Ge(1.0 / kColumns - 1e-9)));
  }
}

TEST(CompareWithPaper, RefusesListsThatHaveNothingForIt) {
  EvaluationData data;
  AddClips(data, "standing", 1, true);
  try {
    (void)Compare(PaperPreset::kTable1, data);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kInvalidArgument);
    EXPECT_THAT(error.what(), HasSubstr("CartwheelLeft, ElbowToKnee"));
  }
  try {
    (void)Compare(PaperPreset::kFigure8, data);
    FAIL();
  } catch (const Error& error) {
    EXPECT_THAT(error.what(), HasSubstr("no class has two clips"));
  }
}

TEST(CompareWithPaper, CanBeCancelled) {
  const EvaluationData data = Squats();
  PaperOptions options;
  options.progress = [](std::string_view, std::size_t done, std::size_t) { return done < 2; };
  try {
    (void)CompareWithPaper(PaperPreset::kTable2, data, OneFeature(), options);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::kCancelled);
  }
}

}  // namespace
}  // namespace kinebase::test
