#include "kinebase/library/feedback.h"

#include <algorithm>
#include <limits>
#include <optional>

#include "fmt/format.h"
#include "kinebase/search/ranking.h"
#include "kinebase/templates/contrast.h"
#include "kinebase/templates/learning.h"
#include "library/feedback_threshold.h"
#include "library/stretch_overlap.h"
#include "library/take_frames.h"

namespace kinebase {
namespace {

using Takes = std::vector<const TakeFeatures*>;

FrameRange FramesOf(const TemplateMark& mark) { return {mark.first_frame, mark.last_frame}; }

// Of the take's file, 1-based.
FrameRange FramesOf(const TemplateClip& clip, std::int64_t frames_of_take) {
  if (clip.first_frame == 0) return {1, frames_of_take};
  return {clip.first_frame, clip.last_frame};
}

RecordingStreams StreamsOf(const TakeFeatures& take) { return {take.features, &take.poses}; }

std::vector<RecordingStreams> StreamsOf(const Takes& takes) {
  std::vector<RecordingStreams> streams;
  for (const TakeFeatures* take : takes) streams.push_back(StreamsOf(*take));
  return streams;
}

// Which clips the new template has, as indices, and which marked stretches become clips.
struct ClipChoice {
  std::vector<std::size_t> kept;
  std::vector<const JudgedStretch*> added;
};

// Clips go by the names of their files; whole ones are as long as the mark's take.
ClipChoice ChooseClips(const MotionTemplate& motion_template, const Feedback& feedback) {
  const auto same_file = [](const TemplateClip& clip, const TakeFeatures& take) {
    return std::filesystem::path(clip.file).filename() == take.path.filename();
  };
  ClipChoice choice;
  for (std::size_t i = 0; i < motion_template.clips.size(); ++i) {
    const TemplateClip& clip = motion_template.clips[i];
    const bool is_wrong = std::ranges::any_of(feedback.judged, [&](const JudgedStretch& judged) {
      const TakeFeatures& take = feedback.takes[judged.take];
      return judged.mark.verdict == Verdict::kWrong && same_file(clip, take) &&
             internal::AreSameStretch(FramesOf(judged.mark), FramesOf(clip, take.frame_count));
    });
    if (!is_wrong) choice.kept.push_back(i);
  }
  for (const JudgedStretch& judged : feedback.judged) {
    const TakeFeatures& take = feedback.takes[judged.take];
    const bool is_known = std::ranges::any_of(choice.kept, [&](std::size_t i) {
      const TemplateClip& clip = motion_template.clips[i];
      return same_file(clip, take) &&
             internal::LiesIn(FramesOf(judged.mark), FramesOf(clip, take.frame_count));
    });
    if (judged.mark.verdict == Verdict::kRight && !is_known) choice.added.push_back(&judged);
  }
  return choice;
}

LearnedMatrix Learn(const Takes& takes, const MotionTemplate& motion_template,
                    const UpdateOptions& options) {
  std::vector<TemplateMatrix> performances;
  performances.reserve(takes.size());
  for (const TakeFeatures* take : takes) performances.push_back(ToTemplateMatrix(take->features));
  return LearnTemplate(performances, {.profile = motion_template.learning,
                                      .max_rounds = options.max_rounds,
                                      .threads = options.threads,
                                      .progress = options.progress});
}

// Whether the clips make this matrix: nobody has edited it since it was learned.
MatrixUpdate HowToUpdate(const MotionTemplate& motion_template, const Feedback& feedback,
                         const UpdateOptions& options) {
  if (!feedback.lost.empty()) return MatrixUpdate::kAveraged;
  if (feedback.clips.empty()) return MatrixUpdate::kAveragedOwn;
  Takes clips;
  for (const TakeFeatures& clip : feedback.clips) clips.push_back(&clip);
  const bool is_as_learned =
      Learn(clips, motion_template, options).matrix == motion_template.matrix;
  return is_as_learned ? MatrixUpdate::kRelearned : MatrixUpdate::kAveragedOwn;
}

// The matrix stands for so many performances, and for more from now on; columns keep their weights.
TemplateMatrix AverageIn(const TemplateMatrix& matrix, std::size_t performances, const Takes& more,
                         Profile profile) {
  TemplateMatrix average = matrix;
  for (double& value : average.values) value *= static_cast<double>(performances);
  for (const TakeFeatures* take : more) {
    const TemplateMatrix other = ToTemplateMatrix(take->features);
    const TemplateMatrix warped =
        WarpToReference(other, Align(matrix, other, profile), matrix.column_count());
    for (std::size_t i = 0; i < average.values.size(); ++i) average.values[i] += warped.values[i];
  }
  for (double& value : average.values) value /= static_cast<double>(performances + more.size());
  return average;
}

// The least that a match costs which covers the stretch by and large; nothing where none does.
//
// A few stretches' lengths to either side are searched, as a path may begin or end there.
std::optional<double> CostOf(const MotionTemplate& motion_template, const TakeFeatures& take,
                             const FrameRange& frames) {
  const double columns_per_frame = take.features.rate_hz / take.rate_hz;
  const std::int64_t margin = 2 * internal::LengthOf(frames);
  const auto column_of = [&](std::int64_t frame) {
    const auto column = static_cast<int>(static_cast<double>(frame - 1) * columns_per_frame);
    return std::clamp(column, 0, take.features.column_count() - 1);
  };
  const int first = column_of(frames.first - margin);
  const int count = column_of(frames.last + margin) - first + 1;
  FeatureMatrix features = take.features;
  features.columns = {take.features.columns.begin() + first,
                      take.features.columns.begin() + first + count};
  PoseStream poses{.rate_hz = take.poses.rate_hz};
  if (!take.poses.values.empty()) {
    const auto begin = take.poses.values.begin() + std::ptrdiff_t{first} * kPoseValues;
    poses.values = {begin, begin + std::ptrdiff_t{count} * kPoseValues};
  }
  const RecordingStreams recording{features, &poses};
  const auto ends = RankHits(std::span(&motion_template, 1), std::span(&recording, 1),
                             {.rivals = false,
                              .every_end = true,
                              .most_hits = std::numeric_limits<std::size_t>::max(),
                              .threads = 1});
  std::optional<double> best;
  for (const RankedHit& end : ends.front()) {
    const FrameRange found =
        internal::FramesOfHit(take, end.hit.first + first, end.hit.last + first);
    const bool covers = internal::AreSameStretch({found.first + 1, found.last + 1}, frames);
    if (covers && (!best || end.hit.cost < *best)) best = end.hit.cost;
  }
  return best;
}

void AppendIfAny(const std::optional<double>& cost, std::vector<double>& costs) {
  if (cost) costs.push_back(*cost);
}

internal::MarkedCosts CostsOf(const MotionTemplate& before, const MotionTemplate& updated,
                              const Feedback& feedback, const ClipChoice& choice) {
  internal::MarkedCosts costs;
  for (const JudgedStretch& judged : feedback.judged) {
    const bool is_right = judged.mark.verdict == Verdict::kRight;
    AppendIfAny(CostOf(updated, feedback.takes[judged.take], FramesOf(judged.mark)),
                is_right ? costs.right : costs.wrong);
  }
  for (const JudgedStretch* judged : choice.added) {
    AppendIfAny(CostOf(before, feedback.takes[judged->take], FramesOf(judged->mark)), costs.unseen);
  }
  if (feedback.clips.empty()) return costs;
  for (const std::size_t i : choice.kept) {
    const TakeFeatures& clip = feedback.clips[i];
    AppendIfAny(CostOf(updated, clip, {1, clip.frame_count}), costs.clips);
  }
  return costs;
}

void CheckUpdate(const MotionTemplate& motion_template, const Feedback& feedback) {
  if (feedback.judged.empty()) {
    throw Error(ErrorCode::kInvalidArgument, "no hit is marked right or wrong");
  }
  if (motion_template.name.ends_with(" mirrored")) {
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("template '{}' is mirrored, its clips are not; update the one that it "
                            "was made of, and mirror that",
                            motion_template.name));
  }
  if (motion_template.contrast && !motion_template.contrast->background) {
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("template '{}' does not say what it was set off from, as its file is "
                            "of an earlier version; learn it again with --method mt+",
                            motion_template.name));
  }
}

// The performances that a matrix which was learned again stands for.
Takes PerformancesOf(const Feedback& feedback, const ClipChoice& choice) {
  Takes performances;
  for (const std::size_t i : choice.kept) performances.push_back(&feedback.clips[i]);
  for (const JudgedStretch* judged : choice.added) performances.push_back(&judged->stretch);
  return performances;
}

void UpdateMatrix(const MotionTemplate& before, const Feedback& feedback, const ClipChoice& choice,
                  const UpdateOptions& options, TemplateUpdate& update) {
  if (choice.added.empty() && choice.kept.size() == before.clips.size()) return;
  MotionTemplate& updated = update.updated;
  if (update.matrix == MatrixUpdate::kRelearned) {
    const Takes performances = PerformancesOf(feedback, choice);
    if (performances.empty()) {
      throw Error(ErrorCode::kInvalidArgument,
                  fmt::format("all that template '{}' was learned from is marked wrong; learn "
                              "another one",
                              before.name));
    }
    LearnedMatrix learned = Learn(performances, before, options);
    updated.matrix = std::move(learned.matrix);
    updated.rounds = static_cast<int>(learned.largest_costs.size());
  } else {
    Takes more;
    for (const JudgedStretch* judged : choice.added) more.push_back(&judged->stretch);
    updated.matrix = AverageIn(before.matrix, std::max<std::size_t>(before.clips.size(), 1), more,
                               before.learning);
  }
  if (update.matrix == MatrixUpdate::kRelearned && !updated.keyframes.empty()) {
    updated.keyframes.clear();
    update.keyframes_dropped = true;
  }
}

// The poses of look-alikes in the columns of the new matrix: the recordings that they were found in
// are not at hand.
std::vector<float> CarryLookalikes(const MotionTemplate& before, const TemplateMatrix& matrix) {
  const std::vector<float>& old = before.contrast->places.lookalikes;
  if (old.empty()) return {};
  const auto columns = static_cast<std::size_t>(matrix.column_count());
  std::vector<float> carried(columns * kPoseValues);
  std::vector<float> counts(columns);
  for (const AlignedColumns& cell : Align(matrix, before.matrix, before.learning).path) {
    const std::size_t to = static_cast<std::size_t>(cell.reference) * kPoseValues;
    const std::size_t from = static_cast<std::size_t>(cell.other) * kPoseValues;
    for (std::size_t i = 0; i < kPoseValues; ++i) carried[to + i] += old[from + i];
    ++counts[static_cast<std::size_t>(cell.reference)];
  }
  for (std::size_t i = 0; i < carried.size(); ++i) carried[i] /= counts[i / kPoseValues];
  return carried;
}

void UpdateContrast(const MotionTemplate& before, const Feedback& feedback,
                    const ClipChoice& choice, TemplateUpdate& update) {
  MotionTemplate& updated = update.updated;
  if (!updated.contrast) return;
  const Background background = *updated.contrast->background;
  Takes wrong;
  for (const JudgedStretch& judged : feedback.judged) {
    if (judged.mark.verdict == Verdict::kWrong) wrong.push_back(&judged.stretch);
  }
  const std::vector<RecordingStreams> counterexamples = StreamsOf(wrong);
  if (update.matrix == MatrixUpdate::kRelearned) {
    updated.contrast = MeasureContrast(updated, StreamsOf(PerformancesOf(feedback, choice)),
                                       background, counterexamples);
    updated.contrast->places.lookalikes = CarryLookalikes(before, updated.matrix);
  } else {
    updated.contrast->entry_weights = MeasureEntryWeights(
        updated, std::max<std::size_t>(updated.clips.size(), 1), background, counterexamples);
  }
}

void UpdateClips(const MotionTemplate& before, const Feedback& feedback, const ClipChoice& choice,
                 TemplateUpdate& update) {
  std::vector<TemplateClip> clips;
  clips.reserve(choice.kept.size() + choice.added.size());
  for (const std::size_t i : choice.kept) clips.push_back(before.clips[i]);
  for (const JudgedStretch* judged : choice.added) {
    clips.push_back({.file = feedback.takes[judged->take].path.filename().string(),
                     .first_frame = judged->mark.first_frame,
                     .last_frame = judged->mark.last_frame});
  }
  update.clips_added = static_cast<int>(choice.added.size());
  update.clips_dropped = static_cast<int>(before.clips.size() - choice.kept.size());
  update.updated.clips = std::move(clips);
  update.updated.marks = feedback.unusable;
  for (const JudgedStretch& judged : feedback.judged) update.updated.marks.push_back(judged.mark);
}

}  // namespace

TemplateUpdate UpdateTemplate(const MotionTemplate& motion_template, const Feedback& feedback,
                              const UpdateOptions& options) {
  CheckUpdate(motion_template, feedback);
  TemplateUpdate update{.updated = motion_template,
                        .matrix = HowToUpdate(motion_template, feedback, options)};
  ClipChoice choice = ChooseClips(motion_template, feedback);
  if (update.matrix != MatrixUpdate::kRelearned) {
    // What has been averaged in cannot be taken out again.
    choice.kept.clear();
    for (std::size_t i = 0; i < motion_template.clips.size(); ++i) choice.kept.push_back(i);
  }
  UpdateMatrix(motion_template, feedback, choice, options, update);
  UpdateClips(motion_template, feedback, choice, update);
  UpdateContrast(motion_template, feedback, choice, update);
  const internal::MarkedCosts costs = CostsOf(motion_template, update.updated, feedback, choice);
  update.right = static_cast<int>(costs.right.size());
  update.wrong = static_cast<int>(costs.wrong.size());
  update.contradictory = internal::SetThreshold(costs, update.updated);
  return update;
}

}  // namespace kinebase
