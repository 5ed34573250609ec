// The protocol "annotate": long takes of actors that no template was learned from.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <optional>

#include "kinebase/core/csv.h"
#include "kinebase/core/mapped_file.h"
#include "kinebase/library/annotation.h"
#include "kinebase/library/annotation_accuracy.h"
#include "kinebase/library/evaluation.h"
#include "kinebase/library/long_take.h"
#include "kinebase/templates/learning.h"
#include "support/test_data.h"

namespace kinebase {
namespace {

struct Clip {
  ClipOfClass labelled;
  std::string actor;
};

struct Recordings {
  std::vector<Clip> clips;
  std::vector<FeatureMatrix> others;  // CMU, every other take for the threshold, the rest between.
  int class_count = 0;
};

Recordings LoadRecordings(const FeatureSet& features) {
  const std::filesystem::path root = test::TestData("data");
  const auto list = root / "hdm05" / "clips.csv";
  const CsvTable table = ParseCsv(MappedFile(list).text(), list);
  std::map<std::string, std::pair<std::string, std::string>> rows;  // file → class, actor
  std::map<std::string, int> classes;
  for (const auto& row : table.rows) {
    rows[row[table.Column("file")]] = {row[table.Column("class")], row[table.Column("actor")]};
    classes.try_emplace(row[table.Column("class")], static_cast<int>(classes.size()));
  }
  Recordings recordings{.class_count = static_cast<int>(classes.size())};
  const std::vector<std::filesystem::path> folders = {root / "hdm05" / "cut_amc", root / "cmu"};
  for (const auto& file : FindMotionFiles(folders)) {
    if (file.extension() != ".amc") continue;
    FeatureMatrix matrix = LoadTakeFeatures({.file = file}, features, 30, {}).features;
    const auto row = rows.find(file.filename().string());
    if (row == rows.end()) {
      recordings.others.push_back(std::move(matrix));
    } else {
      const auto& [class_name, actor] = row->second;
      recordings.clips.push_back({{std::move(matrix), classes.at(class_name)}, actor});
    }
  }
  return recordings;
}

EvaluationData LoadData(const FeatureSet& features) {
  const std::filesystem::path root = test::TestData("data");
  std::vector<std::filesystem::path> others = FindMotionFiles(std::vector{root / "cmu"});
  std::erase_if(others, [](const auto& file) { return file.extension() != ".amc"; });
  return LoadEvaluationData({root / "hdm05" / "clips.csv", {}, others}, features, 30, {}, 0, {});
}

// From all clips of the class but the actor's.
QuantizedTemplate LearnWithout(const Recordings& recordings, int motion_class,
                               const std::string& actor) {
  std::vector<TemplateMatrix> performances;
  for (const Clip& clip : recordings.clips) {
    if (clip.actor == actor || clip.labelled.motion_class != motion_class) continue;
    performances.push_back(ToTemplateMatrix(clip.labelled.features));
  }
  return Quantize(LearnTemplate(performances).matrix, 0.1, Profile::kBonn);
}

// What the threshold is chosen from: takes of others, and training clips of other classes.
std::vector<FeatureMatrix> Background(const Recordings& recordings, int motion_class,
                                      const std::string& actor, std::size_t half) {
  std::vector<FeatureMatrix> background;
  for (std::size_t i = half; i < recordings.others.size(); i += 2) {
    background.push_back(recordings.others[i]);
  }
  for (const Clip& clip : recordings.clips) {
    if (clip.actor == actor || clip.labelled.motion_class == motion_class) continue;
    background.push_back(clip.labelled.features);
  }
  return background;
}

JudgedRecording Judge(const LongTake& take, std::span<const AnnotationTemplate> templates) {
  std::vector<AnnotationCandidate> candidates;
  for (const AnnotationTemplate& one : templates) {
    const auto found = FindCandidates(one, take.features);
    candidates.insert(candidates.end(), found.begin(), found.end());
  }
  JudgedRecording judged{.length = take.features.column_count()};
  for (const auto& segment : take.truth) {
    judged.truth.push_back({segment.motion_class, segment.first, segment.last});
  }
  for (const AnnotationCandidate& segment : ChooseSegments(candidates)) {
    judged.found.push_back({segment.motion_class, segment.first, segment.last});
  }
  return judged;
}

// For --gtest_output=xml:FILE: the figures of docs/annotation.md.
void Record(const std::string& what, const AccuracyCounts& counts) {
  ::testing::Test::RecordProperty(what + "_precision", std::to_string(counts.precision()));
  ::testing::Test::RecordProperty(what + "_recall", std::to_string(counts.recall()));
  ::testing::Test::RecordProperty(what + "_f1", std::to_string(counts.f1()));
}

// .7 of what the second best of them costs at its best.
double ThresholdFrom(const QuantizedTemplate& motion_template,
                     const std::vector<FeatureMatrix>& background) {
  std::vector<double> least;
  for (const FeatureMatrix& recording : background) {
    const DeltaCurve curve = ComputeDelta(motion_template, recording.columns);
    if (!curve.delta.empty()) least.push_back(*std::ranges::min_element(curve.delta));
  }
  std::ranges::nth_element(least, least.begin() + 1);
  return 0.7 * least[1];
}

// Three long takes of the actor for each half of the other takes: one half tells the thresholds,
// the other stands between the clips. Or one threshold for all classes.
std::vector<JudgedRecording> AnnotateActor(const Recordings& recordings, const std::string& actor,
                                           std::optional<double> tau_of_all) {
  std::vector<ClipOfClass> clips;
  for (const Clip& clip : recordings.clips) {
    if (clip.actor == actor) clips.push_back(clip.labelled);
  }
  std::vector<AnnotationTemplate> templates;
  templates.reserve(static_cast<std::size_t>(recordings.class_count));
  for (int i = 0; i < recordings.class_count; ++i) {
    templates.push_back({.motion_class = i, .quantized = LearnWithout(recordings, i, actor)});
  }
  std::vector<JudgedRecording> judged;
  for (const std::size_t half : {0U, 1U}) {
    for (AnnotationTemplate& one : templates) {
      const auto background = Background(recordings, one.motion_class, actor, half);
      one.tau = tau_of_all ? *tau_of_all : ThresholdFrom(one.quantized, background);
    }
    std::vector<FeatureMatrix> fillers;
    for (std::size_t i = 1 - half; i < recordings.others.size(); i += 2) {
      fillers.push_back(recordings.others[i]);
    }
    for (const std::uint64_t seed : {1U, 2U, 3U}) {
      judged.push_back(Judge(MakeLongTake(clips, fillers, seed), templates));
    }
  }
  return judged;
}

AccuracyCounts FramesOf(const std::vector<JudgedRecording>& judged, int class_count) {
  return AnnotationAccuracy::Micro(MeasureAnnotation(judged, class_count).frames);
}

TEST(AnnotationProtocol, FindsTheMotionsOfActorsNeverSeen) {
  KINEBASE_NEEDS_TEST_DATA();
  const FeatureSet features = LoadFeatureSet("bonn");
  const Recordings recordings = LoadRecordings(features);
  ASSERT_EQ(recordings.clips.size(), 146U);
  std::vector<JudgedRecording> judged;
  std::vector<JudgedRecording> with_one_tau;
  for (const std::string actor : {"bd", "bk", "dg"}) {
    const auto own = AnnotateActor(recordings, actor, {});
    Record(actor, FramesOf(own, recordings.class_count));
    judged.insert(judged.end(), own.begin(), own.end());
    const auto fixed = AnnotateActor(recordings, actor, kDefaultTau);
    with_one_tau.insert(with_one_tau.end(), fixed.begin(), fixed.end());
  }
  const AnnotationAccuracy accuracy = MeasureAnnotation(judged, recordings.class_count);
  const AccuracyCounts frames = AnnotationAccuracy::Micro(accuracy.frames);
  const AccuracyCounts segments = AnnotationAccuracy::Micro(accuracy.segments);
  const AccuracyCounts fixed = FramesOf(with_one_tau, recordings.class_count);
  Record("frames", frames);
  Record("segments", segments);
  Record("frames_with_one_tau", fixed);
  EXPECT_GE(frames.f1(), 0.8);
  EXPECT_GE(segments.f1(), 0.84);
  EXPECT_GT(frames.f1(), fixed.f1() + 0.03);  // Thresholds of their own are worth their while.

  // The library's own protocol, on the same takes.
  const EvaluationData data = LoadData(features);
  const std::vector<Method> methods = {*FindMethod("mt"), *FindMethod("mt+")};
  const auto evaluated =
      EvaluateAnnotation(data, features, {.methods = methods, .background_thresholds = true});
  EXPECT_EQ(AnnotationAccuracy::Micro(evaluated[0].accuracy.frames), frames);
  EXPECT_EQ(AnnotationAccuracy::Micro(evaluated[0].accuracy.segments), segments);
  EXPECT_GE(AnnotationAccuracy::Micro(evaluated[1].accuracy.frames).f1(), 0.87);
  EXPECT_GE(AnnotationAccuracy::Micro(evaluated[1].accuracy.segments).f1(), 0.93);
}

}  // namespace
}  // namespace kinebase
