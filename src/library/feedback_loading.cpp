// The takes that marks and clips are about.
#include <algorithm>
#include <map>

#include "fmt/format.h"
#include "kinebase/library/feedback.h"
#include "library/stretch_overlap.h"

namespace kinebase {
namespace {

namespace fs = std::filesystem;

// A mark whose take has been found.
struct FoundMark {
  TemplateMark mark;
  fs::path file;
  Place place;  // Empty file: one that the template had.

  [[nodiscard]] bool is_new() const { return !place.file.empty(); }
  [[nodiscard]] FrameRange frames() const { return {mark.first_frame, mark.last_frame}; }
  [[nodiscard]] TakeStretch stretch() const {
    return {.file = file, .first_frame = mark.first_frame, .last_frame = mark.last_frame};
  }
};

bool AreSame(const FoundMark& a, const FoundMark& b) {
  if (!internal::AreSameStretch(a.frames(), b.frames())) return false;
  std::error_code ignored;
  return a.file == b.file || fs::equivalent(a.file, b.file, ignored);
}

[[noreturn]] void FailWithConflict(const FoundMark& mark, const FoundMark& earlier) {
  throw Error(ErrorCode::kInvalidArgument,
              fmt::format("{}:{}-{} is marked {}, and {}:{}-{} {}; they are the same stretch, so "
                          "keep one of them",
                          mark.mark.file, mark.mark.first_frame, mark.mark.last_frame,
                          ToString(mark.mark.verdict), earlier.mark.file, earlier.mark.first_frame,
                          earlier.mark.last_frame, ToString(earlier.mark.verdict)),
              mark.place);
}

// The newest mark of each stretch.
std::vector<FoundMark> WithoutRepetitions(const std::vector<FoundMark>& marks) {
  std::vector<FoundMark> kept;
  for (const FoundMark& mark : marks) {
    const auto same =
        std::ranges::find_if(kept, [&](const FoundMark& other) { return AreSame(mark, other); });
    if (same == kept.end()) {
      kept.push_back(mark);
      continue;
    }
    const bool is_conflict = mark.mark.verdict != same->mark.verdict;
    if (is_conflict && same->is_new() && mark.is_new()) FailWithConflict(mark, *same);
    if (is_conflict || !same->is_new()) *same = mark;
  }
  return kept;
}

// The template's own marks, then the new ones; those that the template has and whose takes are
// nowhere are `unusable`.
std::vector<FoundMark> FindMarks(const MotionTemplate& motion_template,
                                 std::span<const ListedMark> marks,
                                 std::span<const fs::path> places,
                                 std::vector<TemplateMark>& unusable) {
  std::vector<FoundMark> all;
  all.reserve(motion_template.marks.size() + marks.size());
  for (const TemplateMark& mark : motion_template.marks) all.push_back({mark, {}, {}});
  for (const ListedMark& listed : marks) all.push_back({listed.mark, {}, listed.place});
  std::vector<fs::path> names;
  names.reserve(all.size());
  for (const FoundMark& mark : all) names.emplace_back(mark.mark.file);
  const std::vector<fs::path> files = FindNamedFiles(names, places);
  std::vector<FoundMark> found;
  for (std::size_t i = 0; i < all.size(); ++i) {
    all[i].file = files[i];
    if (!files[i].empty()) {
      found.push_back(all[i]);
    } else if (all[i].is_new()) {
      throw Error(
          ErrorCode::kNotFound,
          fmt::format("the take {} is not there; name its folder with --in", all[i].mark.file),
          all[i].place);
    } else {
      unusable.push_back(all[i].mark);
    }
  }
  return WithoutRepetitions(found);
}

TakeBatch LoadAll(std::span<const TakeStretch> stretches, const MotionTemplate& motion_template,
                  const FeatureSet& features, const FeedbackOptions& options) {
  return LoadManyTakeFeatures(stretches, features, motion_template.matrix.rate_hz, options.load,
                              options.threads, options.progress,
                              {.poses = motion_template.contrast.has_value()});
}

void LoadClips(const MotionTemplate& motion_template, std::span<const fs::path> places,
               const FeatureSet& features, const FeedbackOptions& options, Feedback& feedback) {
  std::vector<fs::path> names;
  names.reserve(motion_template.clips.size());
  for (const TemplateClip& clip : motion_template.clips) names.emplace_back(clip.file);
  const std::vector<fs::path> files = FindNamedFiles(names, places);
  std::vector<TakeStretch> stretches;
  for (std::size_t i = 0; i < files.size(); ++i) {
    const TemplateClip& clip = motion_template.clips[i];
    if (files[i].empty()) {
      feedback.lost.push_back(clip.file);
    } else {
      stretches.push_back({files[i], clip.first_frame, clip.last_frame});
    }
  }
  if (!feedback.lost.empty()) return;
  TakeBatch batch = LoadAll(stretches, motion_template, features, options);
  for (const TakeFailure& failure : batch.failures) {
    feedback.lost.push_back(failure.path.filename().string());
  }
  if (feedback.lost.empty()) feedback.clips = std::move(batch.takes);
}

// Throws what is wrong with the first that cannot be read.
std::vector<TakeFeatures> LoadOrFail(std::span<const TakeStretch> stretches,
                                     const MotionTemplate& motion_template,
                                     const FeatureSet& features, const FeedbackOptions& options) {
  TakeBatch batch = LoadAll(stretches, motion_template, features, options);
  if (!batch.failures.empty()) throw batch.failures.front().error;
  return std::move(batch.takes);
}

}  // namespace

Feedback LoadFeedback(const MotionTemplate& motion_template, std::span<const ListedMark> marks,
                      const FeatureSet& features, const FeedbackOptions& options) {
  CheckFeatureSet(motion_template, features);
  if (marks.empty()) {
    throw Error(ErrorCode::kInvalidArgument, "no hit is marked right or wrong");
  }
  Feedback feedback;
  const std::vector<FoundMark> found =
      FindMarks(motion_template, marks, options.folders, feedback.unusable);
  std::vector<TakeStretch> stretches;
  std::vector<TakeStretch> takes;
  std::map<fs::path, std::size_t> numbers;
  for (const FoundMark& mark : found) {
    stretches.push_back(mark.stretch());
    if (numbers.emplace(mark.file, takes.size()).second) takes.push_back({.file = mark.file});
  }
  feedback.takes = LoadOrFail(takes, motion_template, features, options);
  std::vector<TakeFeatures> judged = LoadOrFail(stretches, motion_template, features, options);
  for (std::size_t i = 0; i < found.size(); ++i) {
    feedback.judged.push_back({found[i].mark, numbers.at(found[i].file), std::move(judged[i])});
  }
  LoadClips(motion_template, options.folders, features, options, feedback);
  return feedback;
}

}  // namespace kinebase
