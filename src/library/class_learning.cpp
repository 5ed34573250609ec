#include "kinebase/library/class_learning.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "fmt/format.h"
#include "kinebase/core/error.h"
#include "kinebase/templates/calibration.h"
#include "kinebase/templates/learning.h"
#include "kinebase/templates/styles.h"
#include "library/every_other.h"
#include "library/lookalikes.h"
#include "library/threshold_rule.h"

namespace kinebase {
namespace {

constexpr std::array<Method, 6> kMethods = {
    Method{.name = "mt"},
    Method{.name = "mt+weights", .contrast = true},
    Method{.name = "mt+places", .contrast = true, .places = true},
    Method{.name = "mt+lookalikes", .contrast = true, .places = true, .lookalikes = true},
    Method{.name = "mt+", .contrast = true, .places = true, .lookalikes = true, .rivals = true},
    Method{.name = "mt+styles",
           .contrast = true,
           .places = true,
           .lookalikes = true,
           .rivals = true,
           .styles = true},
};

using Clips = std::vector<const LabelledClip*>;

// Clips of a class by style; all of them where styles are not asked for.
std::vector<Clips> StylesOf(const Clips& clips, const ClassLearningOptions& options) {
  if (!options.with_styles) return {clips};
  std::vector<TemplateMatrix> performances;
  for (const LabelledClip* clip : clips) {
    performances.push_back(ToTemplateMatrix(clip->take.features));
  }
  const std::vector<int> style_of = FindStyles(performances, options.learning);
  std::vector<Clips> styles(static_cast<std::size_t>(std::ranges::max(style_of)) + 1);
  for (std::size_t i = 0; i < clips.size(); ++i) {
    styles[static_cast<std::size_t>(style_of[i])].push_back(clips[i]);
  }
  return styles;
}

std::set<std::string> NamesOf(std::span<const MotionTemplate> templates) {
  std::set<std::string> names;
  for (const MotionTemplate& each : templates) names.insert(each.name);
  return names;
}

std::vector<RecordingStreams> RecordingsOf(std::span<const LabelledClip* const> clips) {
  std::vector<RecordingStreams> recordings;
  for (const LabelledClip* clip : clips) {
    recordings.push_back({.features = clip->take.features, .poses = &clip->take.poses});
  }
  return recordings;
}

void Gather(std::span<const MotionTemplate> templates, std::span<const LabelledClip* const> clips,
            std::span<const Method> methods, int threads,
            std::vector<KnownHit> ClassEvidence::*part, std::vector<Evidence>& evidence) {
  const std::vector<RecordingStreams> recordings = RecordingsOf(clips);
  for (std::size_t m = 0; m < methods.size(); ++m) {
    RankOptions ranking = methods[m].Ranking();
    ranking.threads = threads;
    const auto hits = RankHits(ForMethod(methods[m], templates), recordings, ranking);
    for (const std::string& name : NamesOf(templates)) {
      std::vector<KnownHit>& known = evidence[m][name].*part;
      const std::vector<KnownHit> judged =
          JudgeAgainstClips(HitsOfClass(name, templates, hits), name, clips);
      known.insert(known.end(), judged.begin(), judged.end());
    }
  }
}

void GatherUnlabelled(std::span<const MotionTemplate> templates, std::span<const Method> methods,
                      const ClassLearningOptions& options, std::vector<Evidence>& evidence) {
  for (std::size_t m = 0; m < methods.size(); ++m) {
    RankOptions ranking = methods[m].Ranking();
    ranking.most_hits = std::numeric_limits<std::size_t>::max();
    ranking.threads = options.threads;
    const auto hits = RankHits(ForMethod(methods[m], templates), options.unlabelled, ranking);
    for (const std::string& name : NamesOf(templates)) {
      std::set<int> seen;  // Hits come best first.
      for (const RankedHit& ranked : HitsOfClass(name, templates, hits)) {
        if (!seen.insert(ranked.hit.recording).second) continue;
        evidence[m][name].unlabelled.push_back(ranked.hit.cost);
      }
    }
  }
}

// What right hits usually cost, and what the best wrong one does.
struct CostRange {
  double right = 0;
  double wrong = 0;
};

std::optional<double> MedianOfRight(std::span<const KnownHit> hits) {
  std::vector<double> costs;
  for (const KnownHit& hit : hits) {
    if (hit.right) costs.push_back(hit.cost);
  }
  return internal::Median(std::move(costs));
}

std::optional<CostRange> UsualCosts(const ClassEvidence& evidence) {
  const auto seen = MedianOfRight(evidence.seen);
  if (!seen) return std::nullopt;
  CostRange range{.right = (*seen + MedianOfRight(evidence.unseen).value_or(*seen)) / 2,
                  .wrong = std::numeric_limits<double>::infinity()};
  for (const auto* hits : {&evidence.seen, &evidence.unseen}) {
    for (const KnownHit& hit : *hits) {
      if (!hit.right) range.wrong = std::min(range.wrong, hit.cost);
    }
  }
  if (std::isinf(range.wrong))
    range.wrong = internal::Median(evidence.unlabelled).value_or(range.wrong);
  // A class that is usually mistaken, or one of which nothing is known.
  if (!(range.wrong > range.right) || std::isinf(range.wrong)) return std::nullopt;
  return range;
}

// What takes the place of actors, for each clip.
std::vector<std::string> GroupsOf(std::span<const LabelledClip* const> clips) {
  std::vector<std::string> groups;
  std::set<std::string> actors;
  for (const LabelledClip* clip : clips) {
    groups.push_back(clip->actor);
    actors.insert(clip->actor);
  }
  if (actors.size() > 1) return groups;
  internal::EveryOther every_other;
  for (std::size_t i = 0; i < clips.size(); ++i) {
    groups[i] = every_other.Takes(clips[i]->class_name) ? "even" : "odd";
  }
  return groups;
}

}  // namespace

std::span<const Method> RetrievalMethods() { return kMethods; }

const Method* FindMethod(std::string_view name) {
  const auto* const found = std::ranges::find(kMethods, name, &Method::name);
  return found == kMethods.end() ? nullptr : found;
}

std::vector<MotionTemplate> ForMethod(const Method& method,
                                      std::span<const MotionTemplate> templates) {
  std::vector<MotionTemplate> seen(templates.begin(), templates.end());
  if (method.contrast) return seen;
  for (MotionTemplate& each : seen) each.contrast.reset();
  return seen;
}

LabelledBatch LoadLabelledClips(std::span<const ListedClip> listed, const FeatureSet& features,
                                double rate_hz, const LoadOptions& load, int threads,
                                const ProgressCallback& progress, const TakeParts& parts) {
  LabelledBatch batch;
  std::map<std::filesystem::path, const ListedClip*> by_file;
  std::vector<TakeStretch> stretches;
  for (const ListedClip& clip : listed) {
    if (clip.file.empty()) {
      batch.failures.push_back(
          {clip.name,
           Error(ErrorCode::kNotFound, "is not below the list's folder; name its folder with --in",
                 {.file = clip.name})});
      continue;
    }
    const auto [entry, is_new] = by_file.emplace(clip.file, &clip);
    if (is_new) {
      stretches.push_back({.file = clip.file});
    } else if (entry->second->class_name != clip.class_name) {
      batch.failures.push_back(
          {clip.name, Error(ErrorCode::kMalformedFile,
                            fmt::format("is listed as '{}' in line {} and as '{}' in line {}; the "
                                        "first counts",
                                        entry->second->class_name, entry->second->line,
                                        clip.class_name, clip.line),
                            {.file = clip.name})});
    }
  }
  TakeBatch takes =
      LoadManyTakeFeatures(stretches, features, rate_hz, load, threads, progress, parts);
  batch.failures.insert(batch.failures.end(), takes.failures.begin(), takes.failures.end());
  for (TakeFeatures& take : takes.takes) {
    const ListedClip& clip = *by_file.at(take.path);
    batch.clips.push_back({std::move(take), clip.class_name, clip.actor});
  }
  return batch;
}

MotionTemplate LearnClass(const std::string& class_name, std::span<const LabelledClip* const> clips,
                          const FeatureSet& features, const ClassLearningOptions& options) {
  std::vector<TemplateMatrix> performances;
  std::vector<TemplateClip> sources;
  performances.reserve(clips.size());
  sources.reserve(clips.size());
  for (const LabelledClip* clip : clips) {
    performances.push_back(ToTemplateMatrix(clip->take.features));
    sources.push_back({.file = clip->take.path.filename().string(),
                       .first_frame = clip->take.stretch.first_frame,
                       .last_frame = clip->take.stretch.last_frame});
  }
  const LearnedMatrix learned = LearnTemplate(
      performances,
      {.profile = options.learning, .max_rounds = options.max_rounds, .threads = options.threads});
  return {.name = class_name,
          .learning = options.learning,
          .matching = options.matching,
          .feature_set = features.name,
          .feature_set_hash = features.hash,
          .matrix = learned.matrix,
          .clips = std::move(sources),
          .rounds = static_cast<int>(learned.largest_costs.size())};
}

std::vector<MotionTemplate> LearnClasses(std::span<const LabelledClip* const> clips,
                                         const FeatureSet& features,
                                         const ClassLearningOptions& options) {
  std::map<std::string, Clips> by_class;
  for (const LabelledClip* clip : clips) by_class[clip->class_name].push_back(clip);
  if (by_class.empty()) throw Error(ErrorCode::kInvalidArgument, "no clips to learn from");
  Background background;
  if (options.with_contrast) {
    std::vector<RecordingStreams> labelled = RecordingsOf(clips);
    if (by_class.size() == 1) {
      labelled.insert(labelled.end(), options.unlabelled.begin(), options.unlabelled.end());
      background = MeasureBackground(labelled);
    } else {
      background = MeasureBackground(labelled, options.unlabelled);
    }
  }
  std::vector<MotionTemplate> templates;
  std::size_t learned_classes = 0;
  for (const auto& [name, of_class] : by_class) {
    if (options.progress && !options.progress("learning", learned_classes++, by_class.size())) {
      throw Error(ErrorCode::kCancelled, "learning was cancelled");
    }
    for (const Clips& style : StylesOf(of_class, options)) {
      MotionTemplate& learned = templates.emplace_back(LearnClass(name, style, features, options));
      if (!options.with_contrast) continue;
      learned.contrast = MeasureContrast(learned, RecordingsOf(style), background);
    }
  }
  if (options.with_contrast) {
    internal::FindLookalikes(clips, options.unlabelled, options.threads, templates);
  }
  return templates;
}

std::vector<KnownHit> JudgeAgainstClips(std::span<const RankedHit> hits,
                                        std::string_view class_name,
                                        std::span<const LabelledClip* const> clips) {
  std::vector<KnownHit> known;
  std::set<int> claimed;
  for (const RankedHit& ranked : hits) {
    const LabelledClip& clip = *clips[static_cast<std::size_t>(ranked.hit.recording)];
    const bool right = clip.class_name == class_name && claimed.insert(ranked.hit.recording).second;
    known.push_back({.cost = ranked.hit.cost, .right = right});
  }
  return known;
}

std::vector<Evidence> GatherEvidence(std::span<const LabelledClip* const> clips,
                                     std::span<const MotionTemplate> templates,
                                     const FeatureSet& features, std::span<const Method> methods,
                                     const ClassLearningOptions& options) {
  std::vector<Evidence> evidence(methods.size());
  Gather(templates, clips, methods, options.threads, &ClassEvidence::seen, evidence);
  if (NamesOf(templates).size() == 1) GatherUnlabelled(templates, methods, options, evidence);
  const std::vector<std::string> groups = GroupsOf(clips);
  for (const std::string& group : std::set<std::string>(groups.begin(), groups.end())) {
    Clips train;
    Clips test;
    for (std::size_t i = 0; i < clips.size(); ++i) {
      (groups[i] == group ? test : train).push_back(clips[i]);
    }
    if (train.empty()) continue;
    Gather(LearnClasses(train, features, options), test, methods, options.threads,
           &ClassEvidence::unseen, evidence);
  }
  return evidence;
}

void Calibrate(const Evidence& evidence, std::span<MotionTemplate> templates) {
  for (MotionTemplate& each : templates) {
    const auto of_class = evidence.find(each.name);
    if (of_class == evidence.end()) continue;
    const std::optional<CostRange> range = UsualCosts(of_class->second);
    if (!range) continue;
    each.tau = internal::ThresholdBetween(range->right, range->wrong);
    each.tau_origin = "half way from right to wrong hits in the training clips";
    each.calibration = HalfAt(*each.tau, internal::kSteepness / (range->wrong - range->right));
  }
}

std::vector<std::vector<MotionTemplate>> LearnForMethods(std::span<const LabelledClip* const> clips,
                                                         const FeatureSet& features,
                                                         std::span<const Method> methods,
                                                         const ClassLearningOptions& options) {
  std::vector<std::vector<MotionTemplate>> learned(methods.size());
  for (const bool with_styles : {false, true}) {
    std::vector<Method> chosen;
    std::vector<std::size_t> places;
    for (std::size_t m = 0; m < methods.size(); ++m) {
      if (methods[m].styles != with_styles) continue;
      chosen.push_back(methods[m]);
      places.push_back(m);
    }
    if (chosen.empty()) continue;
    ClassLearningOptions learning = options;
    learning.with_styles = with_styles;
    const std::vector<MotionTemplate> templates = LearnClasses(clips, features, learning);
    const auto evidence = GatherEvidence(clips, templates, features, chosen, learning);
    for (std::size_t i = 0; i < chosen.size(); ++i) {
      learned[places[i]] = ForMethod(chosen[i], templates);
      Calibrate(evidence[i], learned[places[i]]);
    }
  }
  return learned;
}

}  // namespace kinebase
