// Templates learn from what people say of their hits: right or wrong.
//
// Read library/class_learning.h first. docs/design/feedback.md has the method and what it gains.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "kinebase/core/error.h"
#include "kinebase/core/progress.h"
#include "kinebase/library/takes.h"
#include "kinebase/templates/motion_template.h"

namespace kinebase {

// A mark as it stands in a table of hits.
struct ListedMark {
  TemplateMark mark;
  std::string template_name;  // Whose hit it is; empty where the table does not tell.
  Place place;                // In the table.
};

// Marks of a table of hits: CSV with the columns file, first_frame, last_frame and verdict, or JSON
// as `kinebase search --json` gives it, with a "verdict" in some of its hits. Verdicts are "right"
// and "wrong"; hits with an empty one or none are passed over. A file whose first character is '{'
// is JSON.
// Errors  NotFound, IoFailure; MalformedFile with the line, or the number of the hit.
[[nodiscard]] std::vector<ListedMark> ReadMarks(const std::filesystem::path& table);

// A mark with the motion that it is about.
struct JudgedStretch {
  TemplateMark mark;
  std::size_t take = 0;  // Index in Feedback::takes.
  TakeFeatures stretch;  // Of that take, by itself.
};

// All that a template is updated with.
struct Feedback {
  std::vector<TakeFeatures> clips;     // [template's clip]; empty unless all could be had.
  std::vector<std::string> lost;       // Those of its clips that are nowhere or cannot be read.
  std::vector<TakeFeatures> takes;     // Whole, each once.
  std::vector<JudgedStretch> judged;   // The template's own marks, then the new ones.
  std::vector<TemplateMark> unusable;  // Of the template's own; their takes are nowhere.
};

struct FeedbackOptions {
  std::vector<std::filesystem::path> folders;  // To look for takes in, or files; earlier ones win.
  LoadOptions load;
  int threads = 0;
  ProgressCallback progress;
};

// Reads what a template was learned from and what was said of its hits. A new mark takes the place
// of one that the template has of the same stretch: two stretches of a take are the same if what
// they share is at least half of both together.
//
// marks   New ones; at least one. Those of the template are added.
// Errors  InvalidArgument: no marks, right and wrong marks of the same stretch, frames that a take
//         does not have; NotFound: the take of a new mark is nowhere; those of LoadTakeFeatures.
[[nodiscard]] Feedback LoadFeedback(const MotionTemplate& motion_template,
                                    std::span<const ListedMark> marks, const FeatureSet& features,
                                    const FeedbackOptions& options);

// How right hits came into the matrix.
enum class MatrixUpdate {
  kRelearned,    // Learned again from the clips and right hits.
  kAveraged,     // Averaged in, as the clips could not be had,
  kAveragedOwn,  // or as the matrix is not what they make: somebody changed it.
};

struct TemplateUpdate {
  MotionTemplate updated;
  MatrixUpdate matrix = MatrixUpdate::kRelearned;
  int clips_added = 0;
  int clips_dropped = 0;  // As their motion is marked wrong.
  int right = 0;          // Marks of each kind that counted.
  int wrong = 0;
  bool contradictory = false;      // No threshold tells right marks from wrong ones.
  bool keyframes_dropped = false;  // They were of other columns.
};

struct UpdateOptions {
  int max_rounds = 10;
  int threads = 0;
  ProgressCallback progress;
};

// Right hits that the template was not learned from become clips, wrong ones stop being clips, and
// the matrix is learned again if anything changed. With a contrast wrong hits are counterexamples.
// The threshold lies half way from right to wrong marks under the new template, but never
// leaves out a right mark that is cheaper than every wrong one; where right marks alone are known
// it only rises, where wrong ones alone are it only falls. A confidence is ½ there.
//
// feedback  As LoadFeedback gives it, with poses if the template has a contrast.
// Errors    InvalidArgument: nothing was judged; a mirrored template; a contrast without its
//           background; all clips are marked wrong; Cancelled.
// Cost      Of LearnTemplate, and a search of each marked stretch's surroundings.
[[nodiscard]] TemplateUpdate UpdateTemplate(const MotionTemplate& motion_template,
                                            const Feedback& feedback,
                                            const UpdateOptions& options = {});

}  // namespace kinebase
