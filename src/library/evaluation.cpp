#include "kinebase/library/evaluation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "fmt/format.h"
#include "kinebase/core/csv.h"
#include "kinebase/core/mapped_file.h"
#include "kinebase/core/parallel.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/search/template_search.h"
#include "library/class_ranking.h"
#include "library/every_other.h"

namespace kinebase {
namespace {

namespace fs = std::filesystem;
using internal::ClassRanking;

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
    internal::EveryOther every_other;
    for (std::size_t i = 0; i < data.clips.size(); ++i) {
      (every_other.Takes(data.clips[i].class_name) ? fold.train : fold.test).push_back(i);
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
  std::vector<const TakeFeatures*> takes;
  std::vector<RecordingStreams> recordings;  // What is searched of them.
  std::vector<const LabelledClip*> clips;    // [take]; null for distractors.
};

Stream MakeStream(const EvaluationData& data, const Fold& fold) {
  Stream stream;
  const auto add = [&](const TakeFeatures& take, const LabelledClip* clip) {
    stream.takes.push_back(&take);
    stream.recordings.push_back({.features = take.features, .poses = &take.poses});
    stream.clips.push_back(clip);
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
    JudgedHit& result =
        judged.emplace_back(JudgedHit{.cost = ranked.hit.cost, .matching = ranked.matching});
    if (const LabelledClip* clip = stream.clips[recording]) {
      result.right = clip->class_name == class_name && claimed.insert(ranked.hit.recording).second;
      continue;
    }
    result.excused = possibly_relevant.MayShow(class_name, *stream.takes[recording], ranked.hit);
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
  std::vector<double> separations;
  for (const Scores& scores : all) {
    ForEachMeasure(mean, scores, [&](double& sum, double value) {
      sum += value / static_cast<double>(all.size());
    });
    if (scores.separation > 0) separations.push_back(scores.separation);
  }
  // A single right hit that costs nothing makes a quotient infinite.
  mean.separation = internal::Median(std::move(separations)).value_or(0);
  return mean;
}

// For each clip of the stream the class whose template or example fits best in it: the least cost,
// or where all are calibrated in this, the most confidence.
std::vector<std::string> ClassifyClips(std::span<const ClassRanking> rankings, const Stream& stream,
                                       bool by_confidence) {
  const bool is_comparable =
      by_confidence && std::ranges::all_of(rankings, [](const ClassRanking& ranking) {
        return ranking.calibration.has_value();
      });
  std::vector<std::string> best(stream.takes.size());
  std::vector<double> cost(stream.takes.size(), std::numeric_limits<double>::infinity());
  for (const ClassRanking& ranking : rankings) {
    for (const RankedHit& ranked : ranking.hits) {
      const auto recording = static_cast<std::size_t>(ranked.hit.recording);
      const std::optional<Calibration>& fit = ranking.calibration;
      const double unlikely =
          is_comparable ? fit->slope * ranked.hit.cost + fit->offset : ranked.hit.cost;
      if (unlikely >= cost[recording]) continue;
      cost[recording] = unlikely;
      best[recording] = ranking.class_name;
    }
  }
  return best;
}

// How far right hits stand out. Müller & Röder, SCA 2006, Sect. 5.5.
double Separation(std::span<const JudgedHit> hits, double usual_delta) {
  constexpr std::size_t kTop = 10;
  std::vector<double> costs;
  std::size_t rank = 0;
  for (const JudgedHit& hit : hits) {
    if (hit.excused) continue;
    if (rank++ == kTop) break;
    if (hit.right) costs.push_back(hit.matching);
  }
  const std::optional<double> usual_cost = internal::Median(std::move(costs));
  return usual_delta > 0 && usual_cost ? usual_delta / *usual_cost : 0;
}

// Δ of a class over the whole stream: that of its best template in each column.
double UsualDeltaOf(std::string_view class_name, std::span<const MotionTemplate> templates,
                    const Stream& stream, int threads) {
  std::vector<DeltaCurve> curves(stream.takes.size());
  for (const MotionTemplate& each : templates) {
    if (each.name != class_name) continue;
    const QuantizedTemplate quantized = Quantize(each);
    ParallelFor(curves.size(), threads, "searching", {}, [&](std::size_t i) {
      const DeltaCurve curve = ComputeDelta(quantized, stream.takes[i]->features.columns);
      std::vector<double>& best = curves[i].delta;
      best.resize(curve.delta.size(), std::numeric_limits<double>::infinity());
      std::ranges::transform(best, curve.delta, best.begin(),
                             [](double a, double b) { return std::min(a, b); });
    });
  }
  return internal::UsualDelta(curves);
}

// A ranking for each class that templates stand for.
std::vector<ClassRanking> RankTemplates(const Method& method,
                                        std::span<const MotionTemplate> templates,
                                        const Stream& stream, int threads) {
  RankOptions options = method.Ranking();
  options.most_hits = std::numeric_limits<std::size_t>::max();
  options.threads = threads;
  const auto hits = RankHits(templates, stream.recordings, options);
  std::vector<ClassRanking> rankings;
  for (const MotionTemplate& each : templates) {
    if (std::ranges::find(rankings, each.name, &ClassRanking::class_name) != rankings.end()) {
      continue;  // Another style of a class that is there.
    }
    rankings.push_back({.class_name = each.name,
                        .example = {},
                        .hits = HitsOfClass(each.name, templates, hits),
                        .usual_delta = UsualDeltaOf(each.name, templates, stream, threads),
                        .tau = each.tau,
                        .calibration = each.calibration});
  }
  return rankings;
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
    for (const Method& method : options_.methods)
      evaluation.methods.push_back({.name = method.name});
    for (const Baseline& baseline : options_.baselines) {
      evaluation.methods.push_back({.name = baseline.name,
                                    .has_tau = baseline.kind == BaselineKind::kFuzzy,
                                    .has_confidence = false});
    }
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
    // Other motion to learn with; nothing of the actor who is left out.
    const std::span<const RecordingStreams> library =
        std::span(stream.recordings).subspan(fold.test.size());
    const std::vector<std::vector<MotionTemplate>> learned =
        LearnForMethods(train, features_, options_.methods,
                        {.learning = options_.profile,
                         .matching = options_.profile,
                         .with_contrast = AnyWithContrast(),
                         .unlabelled = library,
                         .threads = options_.threads});
    for (std::size_t m = 0; m < options_.methods.size(); ++m) {
      const Method& method = options_.methods[m];
      ScoreFold(fold, stream, RankTemplates(method, learned[m], stream, options_.threads),
                method.contrast, evaluation.methods[m]);
    }
    if (options_.baselines.empty()) return;
    const std::vector<MotionTemplate> plain = LearnClasses(train, features_,
                                                           {.learning = options_.profile,
                                                            .matching = options_.profile,
                                                            .with_contrast = false,
                                                            .threads = options_.threads});
    for (std::size_t b = 0; b < options_.baselines.size(); ++b) {
      const auto rankings =
          internal::RankByBaseline(options_.baselines[b], {.train = train,
                                                           .learned = plain,
                                                           .stream = stream.takes,
                                                           .features = features_,
                                                           .matching = options_.profile,
                                                           .threads = options_.threads});
      ScoreFold(fold, stream, rankings, false, evaluation.methods[options_.methods.size() + b]);
    }
  }

  void ScoreFold(const Fold& fold, const Stream& stream, std::span<const ClassRanking> rankings,
                 bool by_confidence, MethodResult& result) const {
    const std::vector<std::string> classified = ClassifyClips(rankings, stream, by_confidence);
    AddClassified(stream, classified, result.clips);
    for (ClassResult& class_result : result.classes) {
      std::size_t relevant = 0;
      double recognised = 0;
      for (std::size_t i = 0; i < stream.clips.size(); ++i) {
        if (stream.clips[i] == nullptr) continue;
        if (stream.clips[i]->class_name != class_result.class_name) continue;
        ++relevant;
        if (classified[i] == class_result.class_name) ++recognised;
      }
      if (relevant == 0) continue;  // Nothing to find.
      std::vector<Scores> all;
      for (const ClassRanking& ranking : rankings) {
        if (ranking.class_name != class_result.class_name) continue;
        all.push_back(ScoreOne(fold, stream, ranking, relevant, class_result));
      }
      if (all.empty()) continue;  // Nobody to learn from.
      Scores& scores = class_result.by_actor[fold.actor] = MeanOf(all);
      scores.classified = recognised / static_cast<double>(relevant);
    }
  }

  Scores ScoreOne(const Fold& fold, const Stream& stream, const ClassRanking& ranking,
                  std::size_t relevant, ClassResult& class_result) const {
    const std::size_t most = std::min(options_.most_hits, ranking.hits.size());
    std::vector<JudgedHit> judged = Judge(std::span(ranking.hits).first(most), ranking.class_name,
                                          stream, data_.possibly_relevant);
    if (ranking.calibration) {
      for (JudgedHit& hit : judged) hit.confidence = Confidence(*ranking.calibration, hit.cost);
    }
    Scores scores =
        ScoreRanking(judged, relevant, options_.taus, ranking.tau.value_or(kDefaultTau));
    scores.separation = Separation(judged, ranking.usual_delta);
    const std::string key =
        ranking.example.empty()
            ? fold.actor
            : fmt::format("{}/{}", fold.actor, fs::path(ranking.example).filename().string());
    class_result.hits[key] = std::move(judged);
    class_result.relevant[key] = relevant;
    return scores;
  }

  [[nodiscard]] bool AnyWithContrast() const {
    return std::ranges::any_of(options_.methods, &Method::contrast);
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

bool PossiblyRelevant::MayShow(const std::string& class_name, const TakeFeatures& take,
                               const Hit& hit) const {
  const FrameRange frames =
      FramesOfColumns(hit.first, hit.last, take.features.rate_hz, take.rate_hz, take.frame_count);
  const double middle = static_cast<double>(frames.first + frames.last) / 2 + 1;
  return MayShow(class_name, take.path.stem().string(), middle);
}

void PossiblyRelevant::AlsoAs(const std::string& class_name, const std::string& other_name) {
  const auto relevant = relevant_.find(class_name);
  if (relevant == relevant_.end() || class_name == other_name) return;
  auto& other = relevant_[other_name];
  other.insert(other.end(), relevant->second.begin(), relevant->second.end());
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

EvaluationData LoadEvaluationData(const EvaluationFiles& files, const FeatureSet& features,
                                  double rate_hz, const LoadOptions& load, int threads,
                                  const ProgressCallback& progress, const TakeParts& parts) {
  LabelledBatch labelled = LoadLabelledClips(ReadClipList(files.list, files.folders), features,
                                             rate_hz, load, threads, progress, parts);
  EvaluationData data{.clips = std::move(labelled.clips), .failures = std::move(labelled.failures)};
  if (data.clips.empty() && data.failures.empty()) {
    throw Error(ErrorCode::kInvalidArgument, "lists no clips", {files.list});
  }
  if (files.distractors.empty()) return data;
  std::vector<TakeStretch> stretches;
  for (fs::path& file : FindMotionFiles(files.distractors))
    stretches.push_back({.file = std::move(file)});
  TakeBatch others =
      LoadManyTakeFeatures(stretches, features, rate_hz, load, threads, progress, parts);
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
