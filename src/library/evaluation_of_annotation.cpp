// Protocol "annotate" of library/evaluation.h.

#include <array>

#include "fmt/format.h"
#include "kinebase/core/error.h"
#include "kinebase/core/parallel.h"
#include "kinebase/library/annotation.h"
#include "kinebase/library/evaluation.h"
#include "kinebase/library/long_take.h"

namespace kinebase {
namespace {

constexpr std::array<std::uint64_t, 3> kSeeds = {1, 2, 3};

// What one left-out actor's takes are made of, and learned with.
struct Parts {
  std::vector<const LabelledClip*> train;
  std::vector<ClipOfClass> clips;
  std::vector<const PoseStream*> clip_poses;
  std::vector<FeatureMatrix> fillers;
  std::vector<const PoseStream*> filler_poses;
  std::vector<RecordingStreams> unlabelled;
};

int NumberOf(const std::set<std::string>& classes, const std::string& name) {
  return static_cast<int>(std::distance(classes.begin(), classes.find(name)));
}

Parts PartsFor(const EvaluationData& data, const std::string& actor, std::size_t half) {
  const std::set<std::string> classes = data.ClassNames();
  Parts parts;
  std::set<std::string_view> learned;
  for (const LabelledClip& clip : data.clips) {
    if (clip.actor == actor) continue;
    parts.train.push_back(&clip);
    learned.insert(clip.class_name);
  }
  for (const LabelledClip& clip : data.clips) {
    if (clip.actor != actor || !learned.contains(clip.class_name)) continue;
    parts.clips.push_back({clip.take.features, NumberOf(classes, clip.class_name)});
    parts.clip_poses.push_back(&clip.take.poses);
  }
  for (std::size_t i = 0; i < data.distractors.size(); ++i) {
    const TakeFeatures& take = data.distractors[i];
    if (i % 2 == half) {
      parts.unlabelled.push_back({take.features, &take.poses});
    } else {
      parts.fillers.push_back(take.features);
      parts.filler_poses.push_back(&take.poses);
    }
  }
  return parts;
}

JudgedRecording Annotate(const LongTake& take, const PoseStream& poses,
                         std::span<const MotionTemplate> templates, std::span<const int> classes,
                         const Method& method) {
  JudgedRecording judged{.length = take.features.column_count()};
  for (const LongTake::Segment& segment : take.truth) {
    judged.truth.push_back({segment.motion_class, segment.first, segment.last});
  }
  const auto candidates =
      FindCandidates(templates, classes, {take.features, &poses}, method.Ranking());
  for (const AnnotationCandidate& segment : ChooseSegments(candidates)) {
    judged.found.push_back({segment.motion_class, segment.first, segment.last});
  }
  return judged;
}

// From the library and what the actors that are learned from do otherwise.
void ChooseThresholds(const Parts& parts, const RankOptions& ranking,
                      std::vector<MotionTemplate>& templates) {
  for (MotionTemplate& each : templates) {
    std::vector<RecordingStreams> background = parts.unlabelled;
    for (const LabelledClip* clip : parts.train) {
      if (clip->class_name == each.name) continue;
      background.push_back({clip->take.features, &clip->take.poses});
    }
    const auto tau = ThresholdFromBackground(each, background, ranking);
    if (tau) each.tau = tau;
  }
}

// [method][take]
std::vector<std::vector<JudgedRecording>> AnnotateActor(const EvaluationData& data,
                                                        const std::string& actor, std::size_t half,
                                                        const FeatureSet& features,
                                                        const EvaluateOptions& options) {
  const Parts parts = PartsFor(data, actor, half);
  if (parts.clips.empty()) return {};
  const ClassLearningOptions learning{.learning = options.profile,
                                      .matching = options.profile,
                                      .unlabelled = parts.unlabelled,
                                      .threads = options.threads};
  std::vector<std::vector<MotionTemplate>> learned =
      LearnForMethods(parts.train, features, options.methods, learning);
  const std::set<std::string> names = data.ClassNames();
  std::vector<std::vector<JudgedRecording>> judged(options.methods.size());
  for (std::size_t m = 0; m < options.methods.size(); ++m) {
    std::vector<MotionTemplate> templates = std::move(learned[m]);
    if (options.background_thresholds) {
      RankOptions ranking = options.methods[m].Ranking();
      ranking.threads = options.threads;
      ChooseThresholds(parts, ranking, templates);
    }
    std::vector<int> classes;
    classes.reserve(templates.size());
    for (const MotionTemplate& each : templates) classes.push_back(NumberOf(names, each.name));
    judged[m].resize(kSeeds.size());
    ParallelFor(kSeeds.size(), options.threads, [&](std::size_t i) {
      const LongTake take = MakeLongTake(parts.clips, parts.fillers, kSeeds[i]);
      judged[m][i] = Annotate(take, JoinPoses(take, parts.clip_poses, parts.filler_poses),
                              templates, classes, options.methods[m]);
    });
  }
  return judged;
}

}  // namespace

std::vector<AnnotateEvaluation> EvaluateAnnotation(const EvaluationData& data,
                                                   const FeatureSet& features,
                                                   const EvaluateOptions& options) {
  const std::set<std::string> actors = data.Actors();
  if (actors.size() < 2 || data.distractors.size() < 2) {
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("annotation is measured on two or more actors and distractors; there "
                            "are {} and {}",
                            actors.size(), data.distractors.size()));
  }
  const auto class_count = static_cast<int>(data.ClassNames().size());
  std::vector<std::map<std::string, std::vector<JudgedRecording>>> judged(options.methods.size());
  std::size_t done = 0;
  for (const std::string& actor : actors) {
    for (const std::size_t half : {0U, 1U}) {
      if (options.progress && !options.progress("annotating", done++, 2 * actors.size())) {
        throw Error(ErrorCode::kCancelled, "the evaluation was cancelled");
      }
      const auto of_actor = AnnotateActor(data, actor, half, features, options);
      for (std::size_t m = 0; m < of_actor.size(); ++m) {
        std::vector<JudgedRecording>& all = judged[m][actor];
        all.insert(all.end(), of_actor[m].begin(), of_actor[m].end());
      }
    }
  }
  if (!judged.empty() && judged.front().empty()) {
    throw Error(ErrorCode::kInvalidArgument,
                "no class is performed by two actors: there is nothing to learn from when one is "
                "left out");
  }
  std::vector<AnnotateEvaluation> results;
  for (std::size_t m = 0; m < options.methods.size(); ++m) {
    AnnotateEvaluation& result = results.emplace_back();
    result.method = options.methods[m].name;
    std::vector<JudgedRecording> all;
    for (const auto& [actor, of_actor] : judged[m]) {
      result.by_actor[actor] = MeasureAnnotation(of_actor, class_count);
      all.insert(all.end(), of_actor.begin(), of_actor.end());
    }
    result.accuracy = MeasureAnnotation(all, class_count);
  }
  return results;
}

}  // namespace kinebase
