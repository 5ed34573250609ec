#include "kinebase/library/evaluation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "fmt/format.h"
#include "kinebase/core/csv.h"
#include "kinebase/core/mapped_file.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/search/template_search.h"

namespace kinebase {
namespace {

namespace fs = std::filesystem;

// What is learned from and what is searched, as indices of clips.
struct Fold {
  std::string actor;  // Left out; empty in protocol half.
  std::vector<std::size_t> train;
  std::vector<std::size_t> test;
};

std::vector<Fold> MakeFolds(const EvaluationData& data, Protocol protocol) {
  std::vector<Fold> folds;
  if (protocol == Protocol::kHalf) {
    Fold& fold = folds.emplace_back();
    std::map<std::string, int> seen;  // By class.
    for (std::size_t i = 0; i < data.clips.size(); ++i) {
      const bool trains = seen[data.clips[i].class_name]++ % 2 == 0;
      (trains ? fold.train : fold.test).push_back(i);
    }
    return folds;
  }
  for (const std::string& actor : data.Actors()) {
    Fold& fold = folds.emplace_back(Fold{.actor = actor});
    for (std::size_t i = 0; i < data.clips.size(); ++i) {
      (data.clips[i].actor == actor ? fold.test : fold.train).push_back(i);
    }
  }
  return folds;
}

std::vector<const LabelledClip*> ClipsOf(const EvaluationData& data,
                                         std::span<const std::size_t> indices) {
  std::vector<const LabelledClip*> clips;
  for (const std::size_t i : indices) clips.push_back(&data.clips[i]);
  return clips;
}

// What a fold searches: first its clips, then the distractors.
struct Stream {
  std::vector<RecordingStreams> recordings;
  std::vector<const LabelledClip*> clips;        // [recording]; null for distractors,
  std::vector<const TakeFeatures*> distractors;  // which are here.
};

Stream MakeStream(const EvaluationData& data, const Fold& fold) {
  Stream stream;
  const auto add = [&](const TakeFeatures& take, const LabelledClip* clip) {
    stream.recordings.push_back({.features = &take.features, .poses = &take.poses});
    stream.clips.push_back(clip);
    stream.distractors.push_back(clip == nullptr ? &take : nullptr);
  };
  for (const std::size_t i : fold.test) add(data.clips[i].take, &data.clips[i]);
  for (const TakeFeatures& take : data.distractors) add(take, nullptr);
  return stream;
}

std::vector<JudgedHit> Judge(std::span<const RankedHit> hits, const std::string& class_name,
                             const Stream& stream, const PossiblyRelevant& possibly_relevant) {
  std::set<int> claimed;
  std::vector<JudgedHit> judged;
  for (const RankedHit& ranked : hits) {
    const auto recording = static_cast<std::size_t>(ranked.hit.recording);
    JudgedHit& result = judged.emplace_back(JudgedHit{.cost = ranked.hit.cost});
    if (const LabelledClip* clip = stream.clips[recording]) {
      result.right = clip->class_name == class_name && claimed.insert(ranked.hit.recording).second;
      continue;
    }
    const TakeFeatures& take = *stream.distractors[recording];
    const FrameRange frames = FramesOfColumns(
        ranked.hit.first, ranked.hit.last, take.features.rate_hz, take.rate_hz, take.frame_count);
    const double middle = static_cast<double>(frames.first + frames.last) / 2 + 1;
    result.excused = possibly_relevant.MayShow(class_name, take.path.stem().string(), middle);
  }
  return judged;
}

double AveragePrecision(std::span<const JudgedHit> hits, std::size_t relevant, bool lenient) {
  double rank = 0;
  double found = 0;
  double sum = 0;
  for (const JudgedHit& hit : hits) {
    if (lenient && hit.excused) continue;
    ++rank;
    if (hit.right) sum += ++found / rank;
  }
  return sum / static_cast<double>(relevant);
}

TauScores ScoreAt(std::span<const JudgedHit> hits, std::size_t relevant, double tau) {
  double right = 0;
  double wrong = 0;
  for (const JudgedHit& hit : hits) {
    if (hit.cost > tau || hit.excused) continue;
    (hit.right ? right : wrong) += 1;
  }
  TauScores scores{.tau = tau, .recall = right / static_cast<double>(relevant)};
  // Nothing found is nothing wrong.
  scores.precision = right + wrong > 0 ? right / (right + wrong) : 1;
  const double sum = scores.precision + scores.recall;
  scores.f1 = sum > 0 ? 2 * scores.precision * scores.recall / sum : 0;
  return scores;
}

double RecallInTop(std::span<const JudgedHit> hits, std::size_t relevant, std::size_t top) {
  std::size_t rank = 0;
  double right = 0;
  for (const JudgedHit& hit : hits) {
    if (hit.excused) continue;
    if (rank++ == top) break;
    if (hit.right) ++right;
  }
  return right / static_cast<double>(relevant);
}

// Calls f with each measure of two sets of scores.
template <typename F>
void ForEachMeasure(Scores& a, const Scores& b, const F& f) {
  f(a.ap_strict, b.ap_strict);
  f(a.ap_lenient, b.ap_lenient);
  f(a.r_precision, b.r_precision);
  f(a.recall_in_5, b.recall_in_5);
  f(a.recall_in_10, b.recall_in_10);
  f(a.recall_in_20, b.recall_in_20);
  f(a.classified, b.classified);
  f(a.at_own.tau, b.at_own.tau);
  f(a.at_own.precision, b.at_own.precision);
  f(a.at_own.recall, b.at_own.recall);
  f(a.at_own.f1, b.at_own.f1);
  for (std::size_t i = 0; i < b.at.size(); ++i) {
    if (a.at.size() == i) a.at.push_back({.tau = b.at[i].tau});
    f(a.at[i].precision, b.at[i].precision);
    f(a.at[i].recall, b.at[i].recall);
    f(a.at[i].f1, b.at[i].f1);
  }
}

Scores MeanOf(std::span<const Scores> all) {
  Scores mean;
  for (const Scores& scores : all) {
    ForEachMeasure(mean, scores, [&](double& sum, double value) {
      sum += value / static_cast<double>(all.size());
    });
  }
  return mean;
}

// For each clip of the stream the class whose template fits best in it: the least cost, or where
// templates are calibrated in this, the most confidence.
std::vector<std::string> ClassifyClips(std::span<const MotionTemplate> templates,
                                       std::span<const std::vector<RankedHit>> hits,
                                       const Stream& stream, bool by_confidence) {
  std::vector<std::string> best(stream.recordings.size());
  std::vector<double> cost(stream.recordings.size(), std::numeric_limits<double>::infinity());
  for (std::size_t t = 0; t < templates.size(); ++t) {
    for (const RankedHit& ranked : hits[t]) {
      const auto recording = static_cast<std::size_t>(ranked.hit.recording);
      const std::optional<Calibration>& fit = templates[t].calibration;
      const double unlikely =
          by_confidence && fit ? fit->slope * ranked.hit.cost + fit->offset : ranked.hit.cost;
      if (unlikely >= cost[recording]) continue;
      cost[recording] = unlikely;
      best[recording] = templates[t].name;
    }
  }
  return best;
}

void AddClassified(const Stream& stream, std::span<const std::string> classified,
                   std::vector<ClassifiedClip>& clips) {
  for (std::size_t i = 0; i < stream.clips.size(); ++i) {
    const LabelledClip* clip = stream.clips[i];
    if (clip == nullptr) continue;
    clips.push_back({clip->take.path, clip->actor, clip->class_name, classified[i]});
  }
}

class Evaluator {
 public:
  Evaluator(const EvaluationData& data, const FeatureSet& features, const EvaluateOptions& options)
      : data_(data), features_(features), options_(options) {}

  Evaluation Run() {
    Evaluation evaluation;
    for (const Method& method : options_.methods) evaluation.methods.push_back({.method = method});
    for (MethodResult& result : evaluation.methods) {
      for (const std::string& name : data_.ClassNames()) {
        result.classes.push_back({.class_name = name});
      }
    }
    const std::vector<Fold> folds = MakeFolds(data_, options_.protocol);
    for (std::size_t i = 0; i < folds.size(); ++i) {
      Report(i, folds.size());
      RunFold(folds[i], evaluation);
    }
    Report(folds.size(), folds.size());
    CheckResults(evaluation);
    for (MethodResult& result : evaluation.methods) Summarize(result);
    for (const TakeFeatures& take : data_.distractors) {
      evaluation.stream_s += static_cast<double>(take.frame_count) / take.rate_hz;
    }
    return evaluation;
  }

 private:
  void Report(std::size_t done, std::size_t total) const {
    if (options_.progress && !options_.progress("evaluating", done, total)) {
      throw Error(ErrorCode::kCancelled, "the evaluation was cancelled");
    }
  }

  void RunFold(const Fold& fold, Evaluation& evaluation) const {
    if (fold.train.empty() || fold.test.empty()) return;
    const std::vector<const LabelledClip*> train = ClipsOf(data_, fold.train);
    const Stream stream = MakeStream(data_, fold);
    const ClassLearningOptions learning{.learning = options_.profile,
                                        .matching = options_.profile,
                                        .unlabelled = stream.recordings,
                                        .threads = options_.threads};
    const std::vector<MotionTemplate> learned = LearnClasses(train, features_, learning);
    const std::vector<Evidence> evidence =
        GatherEvidence(train, learned, features_, options_.methods, learning);
    for (std::size_t m = 0; m < options_.methods.size(); ++m) {
      const Method& method = options_.methods[m];
      std::vector<MotionTemplate> templates = ForMethod(method, learned);
      Calibrate(evidence[m], templates);
      RankOptions ranking = method.Ranking();
      ranking.most_hits = std::numeric_limits<std::size_t>::max();
      ranking.threads = options_.threads;
      const auto hits = RankHits(templates, stream.recordings, ranking);
      ScoreFold(fold, stream, templates, hits, evaluation.methods[m]);
    }
  }

  void ScoreFold(const Fold& fold, const Stream& stream, std::span<const MotionTemplate> templates,
                 std::span<const std::vector<RankedHit>> hits, MethodResult& result) const {
    const std::vector<std::string> classified =
        ClassifyClips(templates, hits, stream, result.method.contrast);
    AddClassified(stream, classified, result.clips);
    for (ClassResult& class_result : result.classes) {
      const auto found =
          std::ranges::find(templates, class_result.class_name, &MotionTemplate::name);
      std::size_t relevant = 0;
      double recognised = 0;
      for (std::size_t i = 0; i < stream.clips.size(); ++i) {
        if (stream.clips[i] == nullptr) continue;
        if (stream.clips[i]->class_name != class_result.class_name) continue;
        ++relevant;
        if (classified[i] == class_result.class_name) ++recognised;
      }
      // Nothing to find, or nobody to learn from.
      if (relevant == 0 || found == templates.end()) continue;
      const auto& ranked = hits[static_cast<std::size_t>(found - templates.begin())];
      const std::size_t most = std::min(options_.most_hits, ranked.size());
      std::vector<JudgedHit> judged = Judge(std::span(ranked).first(most), class_result.class_name,
                                            stream, data_.possibly_relevant);
      if (found->calibration) {
        for (JudgedHit& hit : judged) hit.confidence = Confidence(*found->calibration, hit.cost);
      }
      Scores scores =
          ScoreRanking(judged, relevant, options_.taus, found->tau.value_or(kDefaultTau));
      scores.classified = recognised / static_cast<double>(relevant);
      class_result.by_actor[fold.actor] = scores;
      class_result.hits[fold.actor] = std::move(judged);
      class_result.relevant[fold.actor] = relevant;
    }
  }

  // All classes have one actor, or one clip.
  void CheckResults(const Evaluation& evaluation) const {
    if (evaluation.methods.empty()) return;
    for (const MethodResult& result : evaluation.methods) {
      for (const ClassResult& each : result.classes) {
        if (!each.by_actor.empty()) return;
      }
    }
    throw Error(ErrorCode::kInvalidArgument,
                options_.protocol == Protocol::kHalf
                    ? "no class has two clips: nothing is left to search for"
                    : "no class is performed by two actors: there is nothing to learn from when "
                      "one is left out");
  }

  static void Summarize(MethodResult& result) {
    std::vector<Scores> means;
    for (ClassResult& each : result.classes) {
      std::vector<Scores> scores;
      scores.reserve(each.by_actor.size());
      for (const auto& [actor, of_actor] : each.by_actor) scores.push_back(of_actor);
      each.mean = MeanOf(scores);
      if (!scores.empty()) means.push_back(each.mean);
    }
    result.macro = MeanOf(means);
  }

  const EvaluationData& data_;
  const FeatureSet& features_;
  const EvaluateOptions& options_;
};

}  // namespace

PossiblyRelevant PossiblyRelevant::Read(const fs::path& table, const fs::path& labels) {
  return Parse(MappedFile(table).text(), table, MappedFile(labels).text(), labels);
}

PossiblyRelevant PossiblyRelevant::Parse(std::string_view table_text, const fs::path& table,
                                         std::string_view labels_text, const fs::path& labels) {
  PossiblyRelevant result;
  const CsvTable relevant = ParseCsv(table_text, table);
  const std::size_t class_column = relevant.Column("class");
  const std::size_t trial_column = relevant.Column("trial");
  const std::size_t label_column = relevant.Column("label");
  for (const auto& row : relevant.rows) {
    result.relevant_[row[class_column]].emplace_back(row[trial_column], row[label_column]);
  }
  const CsvTable segments = ParseCsv(labels_text, labels);
  const std::size_t trial = segments.Column("trial");
  const std::size_t label = segments.Column("label");
  const std::size_t first = segments.Column("first_frame_1based");
  const std::size_t last = segments.Column("last_frame_1based");
  for (std::size_t i = 0; i < segments.rows.size(); ++i) {
    const auto& row = segments.rows[i];
    const auto from = ParseDouble(row[first]);
    const auto to = ParseDouble(row[last]);
    if (!from || !to) {
      throw Error(ErrorCode::kMalformedFile, "frames must be numbers", {labels, segments.lines[i]});
    }
    result.segments_[row[trial]].push_back({row[label], *from, *to});
  }
  return result;
}

bool PossiblyRelevant::MayShow(const std::string& class_name, const std::string& trial,
                               double frame) const {
  const auto relevant = relevant_.find(class_name);
  if (relevant == relevant_.end()) return false;
  for (const auto& [wanted_trial, wanted_label] : relevant->second) {
    if (wanted_trial != "*" && wanted_trial != trial) continue;
    if (wanted_label == "*") return true;
    const auto segments = segments_.find(trial);
    if (segments == segments_.end()) continue;
    for (const Segment& segment : segments->second) {
      if (segment.label == wanted_label && segment.first <= frame && frame <= segment.last) {
        return true;
      }
    }
  }
  return false;
}

std::set<std::string> EvaluationData::ClassNames() const {
  std::set<std::string> names;
  for (const LabelledClip& clip : clips) names.insert(clip.class_name);
  return names;
}

std::set<std::string> EvaluationData::Actors() const {
  std::set<std::string> names;
  for (const LabelledClip& clip : clips) names.insert(clip.actor);
  return names;
}

Scores ScoreRanking(std::span<const JudgedHit> hits, std::size_t relevant,
                    std::span<const double> taus, double own_tau) {
  Scores scores{.ap_strict = AveragePrecision(hits, relevant, false),
                .ap_lenient = AveragePrecision(hits, relevant, true),
                .recall_in_5 = RecallInTop(hits, relevant, 5),
                .recall_in_10 = RecallInTop(hits, relevant, 10),
                .recall_in_20 = RecallInTop(hits, relevant, 20)};
  const auto top = hits.first(std::min(relevant, hits.size()));
  scores.r_precision = static_cast<double>(std::ranges::count(top, true, &JudgedHit::right)) /
                       static_cast<double>(relevant);
  for (const double tau : taus) scores.at.push_back(ScoreAt(hits, relevant, tau));
  scores.at_own = ScoreAt(hits, relevant, own_tau);
  return scores;
}

std::vector<ReliabilityBin> MeasureReliability(const MethodResult& result) {
  constexpr std::size_t kBins = 10;
  std::vector<ReliabilityBin> bins(kBins);
  for (const ClassResult& of_class : result.classes) {
    for (const auto& [actor, hits] : of_class.hits) {
      for (const JudgedHit& hit : hits) {
        if (hit.excused) continue;
        const auto bin = static_cast<std::size_t>(hit.confidence * kBins);
        ReliabilityBin& to = bins[std::min(bin, kBins - 1)];
        ++to.hits;
        to.confidence += hit.confidence;
        if (hit.right) ++to.right;
      }
    }
  }
  for (ReliabilityBin& bin : bins) {
    if (bin.hits == 0) continue;
    bin.confidence /= static_cast<double>(bin.hits);
    bin.right /= static_cast<double>(bin.hits);
  }
  return bins;
}

double CalibrationError(std::span<const ReliabilityBin> bins) {
  constexpr std::size_t kFewest = 30;
  double hits = 0;
  double error = 0;
  for (const ReliabilityBin& bin : bins) {
    if (bin.hits < kFewest) continue;
    hits += static_cast<double>(bin.hits);
    error += static_cast<double>(bin.hits) * std::abs(bin.confidence - bin.right);
  }
  return hits > 0 ? error / hits : 0;
}

EvaluationData LoadEvaluationData(const fs::path& list, std::span<const fs::path> folders,
                                  std::span<const fs::path> distractors, const FeatureSet& features,
                                  double rate_hz, const LoadOptions& load, int threads,
                                  const ProgressCallback& progress) {
  LabelledBatch labelled =
      LoadLabelledClips(ReadClipList(list, folders), features, rate_hz, load, threads, progress);
  EvaluationData data{.clips = std::move(labelled.clips), .failures = std::move(labelled.failures)};
  if (distractors.empty()) return data;
  std::vector<TakeStretch> stretches;
  for (fs::path& file : FindMotionFiles(distractors))
    stretches.push_back({.file = std::move(file)});
  TakeBatch others =
      LoadManyTakeFeatures(stretches, features, rate_hz, load, threads, progress, true);
  data.distractors = std::move(others.takes);
  data.failures.insert(data.failures.end(), others.failures.begin(), others.failures.end());
  return data;
}

Evaluation Evaluate(const EvaluationData& data, const FeatureSet& features,
                    const EvaluateOptions& options) {
  if (options.protocol == Protocol::kLeaveOneActorOut && data.Actors().size() < 2) {
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("leaving one actor out needs two or more; the list has {}",
                            data.Actors().size()));
  }
  return Evaluator(data, features, options).Run();
}

}  // namespace kinebase
