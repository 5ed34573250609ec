// Templates of several classes that know each other: learned together from labelled clips, with
// what sets each off from the others, and a calibrated confidence.
//
// Read templates/contrast.h, templates/calibration.h and search/ranking.h first.
// docs/design/contrast.md has the method.
#pragma once

#include <map>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kinebase/library/takes.h"
#include "kinebase/search/ranking.h"
#include "kinebase/templates/calibration.h"
#include "kinebase/templates/contrast.h"

namespace kinebase {

struct LabelledClip {
  TakeFeatures take;  // With poses.
  std::string class_name;
  std::string actor;
};

// Which ingredients of retrieval are on.
struct Method {
  std::string_view name;    // "mt", "mt+" …
  bool contrast = false;    // Entry weights from a background.
  bool places = false;      // Poses count too,
  bool lookalikes = false;  // beside those of what looks like the class,
  bool rivals = false;      // and hits are ordered by what other classes' templates say as well.
  bool styles = false;      // Several templates a class, where its clips fall into groups.

  [[nodiscard]] RankOptions Ranking() const {
    return {.places = places, .lookalikes = lookalikes, .rivals = rivals};
  }
};

// "mt", which is the paper's, and "mt+", which is all; the ingredients added one by one:
// "mt+weights", "mt+places", "mt+lookalikes". "mt+styles" is mt+ with styles.
[[nodiscard]] std::span<const Method> RetrievalMethods();
[[nodiscard]] const Method* FindMethod(std::string_view name);

// The templates as the method sees them: with or without what sets their class off.
[[nodiscard]] std::vector<MotionTemplate> ForMethod(const Method& method,
                                                    std::span<const MotionTemplate> templates);

// Clips with what they show, and those that could not be read or are nowhere.
struct LabelledBatch {
  std::vector<LabelledClip> clips;
  std::vector<TakeFailure> failures;
};

// Reads listed clips, in parallel. A file that is listed twice comes once; one
// that is listed as two classes is a failure beside, and the first counts.
// Errors  Cancelled.
[[nodiscard]] LabelledBatch LoadLabelledClips(std::span<const ListedClip> listed,
                                              const FeatureSet& features, double rate_hz,
                                              const LoadOptions& load, int threads,
                                              const ProgressCallback& progress,
                                              const TakeParts& parts = {.poses = true});

struct ClassLearningOptions {
  Profile learning = Profile::kBonn;
  Profile matching = Profile::kBonn;
  int max_rounds = 10;
  bool with_contrast = true;
  bool with_styles = false;  // Several templates a class, where templates/styles.h finds them.
  // Recordings of motion in general, without labels, whose poses count for the background; best
  // those that will be searched.
  std::span<const RecordingStreams> unlabelled;
  int threads = 0;
  ProgressCallback progress;
};

// The template of a class as the paper has it, without what sets it off from other motion.
//
// clips    At least one.
// options  Those of learning, and threads.
// Errors   InvalidArgument: no clips, or of different features.
// Cost     Of LearnTemplate.
[[nodiscard]] MotionTemplate LearnClass(const std::string& class_name,
                                        std::span<const LabelledClip* const> clips,
                                        const FeatureSet& features,
                                        const ClassLearningOptions& options = {});

// One template for each class of the clips, by name; with styles, one for each style of a class,
// next to each other and of the same name. The background is all clips, of all classes, and what is
// not labelled; where there is one class alone, how often features are one is measured on that,
// too.
//
// Walking agrees with sneaking in every feature; what tells them apart is a little in many joints.
// So a template with a contrast also keeps the mean poses of its hundred best hits in the clips of
// other classes and in what is not labelled. Some of the latter may be right, but few of so many.
//
// Errors  InvalidArgument: no clips, other features than the set's; Cancelled.
// Cost    Of LearnTemplate for each class.
[[nodiscard]] std::vector<MotionTemplate> LearnClasses(std::span<const LabelledClip* const> clips,
                                                       const FeatureSet& features,
                                                       const ClassLearningOptions& options = {});

// What a class's hits in labelled clips cost.
struct ClassEvidence {
  std::vector<KnownHit> unseen;    // In clips of actors that the template was not learned from,
  std::vector<KnownHit> seen;      // and in all clips, its own among them.
  std::vector<double> unlabelled;  // The best in each recording without labels.
};
using Evidence = std::map<std::string, ClassEvidence>;  // By class.

// Searches each actor's clips with templates learned from the others', and all clips with
// `templates`, which were learned from all. With one actor the two halves of each class's clips
// take the place of actors. Where nothing is left to learn a class from (one clip, one actor who
// performs it), nothing unseen is known of it.
//
// templates  As LearnClasses gives them by these options, with contrasts if a method asks for that.
// methods    The result is for each of them; whether they ask for styles is for the options to say.
// Errors     As LearnClasses.
// Cost       Of LearnClasses for each actor.
[[nodiscard]] std::vector<Evidence> GatherEvidence(std::span<const LabelledClip* const> clips,
                                                   std::span<const MotionTemplate> templates,
                                                   const FeatureSet& features,
                                                   std::span<const Method> methods,
                                                   const ClassLearningOptions& options = {});

// Right is the best hit in each clip of the class; all others are wrong.
// recordings  Hits' recordings are indices of these clips.
[[nodiscard]] std::vector<KnownHit> JudgeAgainstClips(std::span<const RankedHit> hits,
                                                      std::string_view class_name,
                                                      std::span<const LabelledClip* const> clips);

// Gives each template its threshold and confidence, by its name, from training clips alone. Styles
// of a class have one threshold.
//
// A right hit of somebody new costs more than those in the clips that were learned from, and less
// than those in clips that were held back, when there was less to learn from: half way between the
// two medians. The threshold lies half way from there to the best wrong hit in any clip. At the
// threshold the confidence is ½. Of a class that is learned alone, wrong is the median of the
// recordings without labels. Where nothing unseen is known of a class, those that were learned from
// decide alone, and the threshold is low. A class without right or wrong hits, or whose wrong
// hits cost no more than its right ones, keeps what it has.
void Calibrate(const Evidence& evidence, std::span<MotionTemplate> templates);

// What each method searches with: templates as LearnClasses, GatherEvidence and Calibrate make
// them. options.with_styles  Each method decides it. Errors, cost         As GatherEvidence, twice
// where methods with and without styles are asked for.
[[nodiscard]] std::vector<std::vector<MotionTemplate>> LearnForMethods(
    std::span<const LabelledClip* const> clips, const FeatureSet& features,
    std::span<const Method> methods, const ClassLearningOptions& options = {});

}  // namespace kinebase
