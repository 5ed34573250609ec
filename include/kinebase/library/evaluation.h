// How well methods find motion classes in actors they have not seen.
//
// Protocol "leave one actor out": for each class and actor learn from the clips of the others and
// search all clips of the actor, of whatever class, and takes of other motion (distractors). A hit
// is right if it lies in a clip of the class that no better hit has claimed; every other hit is a
// false alarm. "Lenient" leaves out hits in stretches of distractors that may well show the class.
// Protocol "half": every other clip of a class trains, the rest is searched; it shares takes and
// people between the halves and flatters, and is for comparison with Müller & Röder, SCA 2006.
//
// Read library/class_learning.h first. docs/quality.md has the figures.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "kinebase/library/annotation_accuracy.h"
#include "kinebase/library/class_learning.h"

namespace kinebase {

// Stretches of distractors that may show a class after all.
class PossiblyRelevant {
 public:
  // table   Columns class, trial, label: a trial is a file's stem, "*" any of them; "*" as a label
  //         is the whole trial.
  // labels  Columns trial, label, first_frame_1based, last_frame_1based.
  // Errors  MalformedFile.
  static PossiblyRelevant Read(const std::filesystem::path& table,
                               const std::filesystem::path& labels);
  static PossiblyRelevant Parse(std::string_view table_text, const std::filesystem::path& table,
                                std::string_view labels_text, const std::filesystem::path& labels);

  [[nodiscard]] bool MayShow(const std::string& class_name, const std::string& trial,
                             double frame) const;
  // The same of a hit, whose middle decides.
  [[nodiscard]] bool MayShow(const std::string& class_name, const TakeFeatures& take,
                             const Hit& hit) const;

  // What may show a class may show another from here on, as one class has several names.
  void AlsoAs(const std::string& class_name, const std::string& other_name);

 private:
  struct Segment {
    std::string label;
    double first = 0;
    double last = 0;
  };
  std::map<std::string, std::vector<Segment>> segments_;                              // By trial.
  std::map<std::string, std::vector<std::pair<std::string, std::string>>> relevant_;  // By class.
};

struct EvaluationData {
  std::vector<LabelledClip> clips;
  std::vector<TakeFeatures> distractors;
  PossiblyRelevant possibly_relevant;
  std::vector<TakeFailure> failures;  // What could not be read; the rest is evaluated.

  [[nodiscard]] std::set<std::string> ClassNames() const;
  [[nodiscard]] std::set<std::string> Actors() const;
};

// What templates are compared with: one example of a motion, or templates that are searched for in
// other ways. docs/design/baselines.md.
enum class BaselineKind {
  kUnquantized,  // Plain templates with all their values.
  kKeyframes,    // Plain templates, where two keyframes of their own choice are shown.
  kFuzzy,        // The order of a plain template's features of one group.
  kFeatures,     // RF: the features of an example.
  kPositions,    // 3D: where its joints are.
  kRotations,    // Q: how its joints are turned.
};

struct Baseline {
  std::string_view name;
  BaselineKind kind = BaselineKind::kFeatures;
};

// "mt-unquantized", "keyframes", "fuzzy", "rf", "3d", "q".
[[nodiscard]] std::span<const Baseline> Baselines();
[[nodiscard]] const Baseline* FindBaseline(std::string_view name);

// What takes must have to be evaluated by them.
[[nodiscard]] TakeParts PartsFor(std::span<const Baseline> baselines);

enum class Protocol { kLeaveOneActorOut, kHalf };  // Of Evaluate.

struct EvaluateOptions {
  Protocol protocol = Protocol::kLeaveOneActorOut;
  std::vector<Method> methods;
  std::vector<Baseline> baselines;  // After the methods; not in protocol annotate.
  std::vector<double> taus = {0.02, 0.04, 0.06, 0.1};
  std::size_t most_hits = 500;
  Profile profile = Profile::kBonn;
  // Protocol "annotate": thresholds from what other motion costs (ThresholdFromBackground), instead
  // of from training clips alone.
  bool background_thresholds = false;
  int threads = 0;
  ProgressCallback progress;
};

// A hit as it counts.
struct JudgedHit {
  double cost = 0;
  double matching = 0;  // Δ; the cost may count more.
  bool right = false;
  bool excused = false;  // In a stretch that may show the class.
  double confidence = 0;
};

struct TauScores {
  double tau = 0;
  double precision = 0;  // Lenient.
  double recall = 0;
  double f1 = 0;
};

struct Scores {
  double ap_strict = 0;
  double ap_lenient = 0;
  double r_precision = 0;
  double recall_in_5 = 0;  // Of the first 5, 10, 20 hits, lenient.
  double recall_in_10 = 0;
  double recall_in_20 = 0;
  double classified = 0;  // Share of clips that their own class's template or example fits best.
  // Median of Δ over the whole stream, in medians of what right hits among the first 10 cost
  // (Müller & Röder, SCA 2006, Sect. 5.5). Infinite if they cost nothing; 0 if none is right, or Δ
  // is not known everywhere (keyframes, fuzzy). Of several rankings the median of what is known.
  double separation = 0;
  std::vector<TauScores> at;  // At each τ asked for,
  TauScores at_own;           // and at the class's own, chosen from training clips only.
};

// The measures of one ranking.
// hits      Best first.
// relevant  Clips of the class in the stream; at least 1.
[[nodiscard]] Scores ScoreRanking(std::span<const JudgedHit> hits, std::size_t relevant,
                                  std::span<const double> taus, double own_tau);

struct ClassResult {
  std::string class_name;
  std::map<std::string, Scores> by_actor;  // By the actor left out; "" in protocol half.
  Scores mean;
  // Best first, and how many clips of the class there are. By actor; where an example is looked
  // for, by actor and the example's name, as each of them gives a ranking.
  std::map<std::string, std::vector<JudgedHit>> hits;
  std::map<std::string, std::size_t> relevant;
};

// What a clip was taken for: the class whose template fits best in it.
struct ClassifiedClip {
  std::filesystem::path file;
  std::string actor;
  std::string class_name;  // What it shows.
  std::string taken_for;   // Empty where no template fits.
};

struct MethodResult {
  std::string_view name;       // Of a method or a baseline.
  bool has_tau = true;         // Its classes have thresholds of their own,
  bool has_confidence = true;  // and its hits a confidence.
  std::vector<ClassResult> classes;
  Scores macro;                       // Mean over classes.
  std::vector<ClassifiedClip> clips;  // All that were searched.
};

// How far confidences are from what they promise: hits in ten bins of confidence.
struct ReliabilityBin {
  std::size_t hits = 0;
  double confidence = 0;  // Mean.
  double right = 0;       // Share.
};
// Without excused hits.
[[nodiscard]] std::vector<ReliabilityBin> MeasureReliability(const MethodResult& result);
// Mean distance of confidence and share, weighted by hits, over bins with at least 30 of them.
[[nodiscard]] double CalibrationError(std::span<const ReliabilityBin> bins);

struct Evaluation {
  std::vector<MethodResult> methods;
  double stream_s = 0;  // Of all distractors.
};

// What an evaluation reads.
struct EvaluationFiles {
  std::filesystem::path list;                      // Clips with columns file, class, actor.
  std::vector<std::filesystem::path> folders;      // Of the list's files, beside its own.
  std::vector<std::filesystem::path> distractors;  // Files or folders.
};

// Errors  Those of ReadClipList and FindMotionFiles; Cancelled.
[[nodiscard]] EvaluationData LoadEvaluationData(const EvaluationFiles& files,
                                                const FeatureSet& features, double rate_hz,
                                                const LoadOptions& load, int threads,
                                                const ProgressCallback& progress,
                                                const TakeParts& parts = {.poses = true});

// A class that only one actor performs (in protocol half: that has one clip) is nothing to learn
// from for whoever would look for it: its results are empty, and it is in no mean. Its clips are
// searched, and learned from as other motion, all the same.
//
// Errors  InvalidArgument: fewer than two actors, or no class that can be evaluated; Cancelled.
// Cost    A learning and a search for each class, actor and method.
[[nodiscard]] Evaluation Evaluate(const EvaluationData& data, const FeatureSet& features,
                                  const EvaluateOptions& options);

struct AnnotateEvaluation {
  std::string_view method;
  AnnotationAccuracy accuracy;                         // Of all takes together.
  std::map<std::string, AnnotationAccuracy> by_actor;  // By the actor left out.
};

// Protocol "annotate": long takes of all clips of the actor who is left out, in seeded random
// order, with 2 to 10 s of distractors between them; three takes for each half of the distractors,
// the other half being the library to learn with, which thresholds may be
// chosen from as well. Clips of a class that nobody else performs are
// left out, and an actor who has no others.
//
// Errors  InvalidArgument: fewer than two actors or distractors, or no class that two actors
//         perform; Cancelled.
[[nodiscard]] std::vector<AnnotateEvaluation> EvaluateAnnotation(const EvaluationData& data,
                                                                 const FeatureSet& features,
                                                                 const EvaluateOptions& options);

}  // namespace kinebase
