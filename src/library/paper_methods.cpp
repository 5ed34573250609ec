// Tables 4 and 5: templates beside examples and fuzzy retrieval.

#include <algorithm>
#include <map>

#include "fmt/format.h"
#include "library/every_other.h"
#include "library/paper_experiments.h"

namespace kinebase::internal {
namespace {

// A class has as many in the paper's Table 4, half of which are learned from.
constexpr std::size_t kClipsOfTable4 = 20;

constexpr std::array<std::string_view, 3> kExamples = {"rf", "q", "3d"};
constexpr std::array<std::string_view, 1> kFuzzy = {"fuzzy"};

std::vector<Baseline> BaselinesOf(std::span<const std::string_view> names) {
  std::vector<Baseline> baselines;
  baselines.reserve(names.size());
  for (const std::string_view name : names) baselines.push_back(*FindBaseline(name));
  return baselines;
}

// Those of a class evenly spread over the list, if there are more than `most`.
std::vector<LabelledClip> ThinOut(const std::vector<LabelledClip>& clips, std::size_t most) {
  std::map<std::string, std::size_t> count;
  for (const LabelledClip& clip : clips) ++count[clip.class_name];
  std::map<std::string, std::size_t> seen;
  std::vector<LabelledClip> kept;
  for (const LabelledClip& clip : clips) {
    const std::size_t of = count[clip.class_name];
    const std::size_t i = seen[clip.class_name]++;
    // The share of `most` that was reached with this clip rises by one.
    if (of <= most || i * most / of != (i + 1) * most / of) kept.push_back(clip);
  }
  return kept;
}

// Clips by the name of the first of the table's classes that they stand for, if there is one:
// Evaluate knows one name a class.
void NameAsInPaper(const PaperTable& table, std::vector<LabelledClip>& clips) {
  for (LabelledClip& clip : clips) {
    const auto row = std::ranges::find_if(
        table.rows, [&](const PaperRow& each) { return each.here.contains(clip.class_name); });
    if (row != table.rows.end()) clip.class_name = row->paper_class;
  }
}

// What may show a class of the list may show the paper's.
EvaluationData DataFor(const PaperInput& input, const PaperTable& table, std::size_t most) {
  EvaluationData data{.clips = ThinOut(input.data.clips, most),
                      .distractors = input.data.distractors,
                      .possibly_relevant = input.data.possibly_relevant,
                      .failures = {}};
  for (const PaperRow& row : table.rows) {
    for (const std::string& name : row.here) {
      data.possibly_relevant.AlsoAs(name, row.paper_class);
    }
  }
  NameAsInPaper(table, data.clips);
  return data;
}

// Evaluate looks for every class of its clips. Those that the table has not are only to be
// searched: of them what is not learned from becomes other motion.
void LookForTableOnly(const PaperTable& table, EvaluationData& data) {
  internal::EveryOther every_other;
  std::vector<LabelledClip> kept;
  for (LabelledClip& clip : data.clips) {
    if (std::ranges::find(table.rows, clip.class_name, &PaperRow::paper_class) !=
        table.rows.end()) {
      kept.push_back(std::move(clip));
    } else if (!every_other.Takes(clip.class_name)) {
      data.distractors.push_back(std::move(clip.take));
    }
  }
  data.clips = std::move(kept);
}

Evaluation EvaluateHalves(const PaperInput& input, const EvaluationData& data,
                          std::span<const std::string_view> baselines, std::vector<double> taus) {
  return Evaluate(data, input.features,
                  {.protocol = Protocol::kHalf,
                   .methods = {*FindMethod("mt")},
                   .baselines = BaselinesOf(baselines),
                   .taus = std::move(taus),
                   .profile = input.options.profile,
                   .threads = input.options.threads,
                   .progress = input.options.progress});
}

// Null where the class could not be evaluated: with one clip nothing is left to search for.
const ClassResult* ResultOf(const Evaluation& evaluation, std::string_view method,
                            std::string_view class_name) {
  const auto result = std::ranges::find(evaluation.methods, method, &MethodResult::name);
  if (result == evaluation.methods.end()) return nullptr;
  const auto found = std::ranges::find(result->classes, class_name, &ClassResult::class_name);
  return found == result->classes.end() || found->by_actor.empty() ? nullptr : &*found;
}

std::string DescribeSearched(const EvaluationData& data) {
  std::map<std::string, std::size_t> count;
  for (const LabelledClip& clip : data.clips) ++count[clip.class_name];
  std::size_t searched = 0;
  for (const auto& [name, clips] : count) searched += clips / 2;
  return fmt::format("searched are {} clips of {} classes and {} distractors", searched,
                     count.size(), data.distractors.size());
}

void SetRowOfTable4(const PaperTable& table, const ClassResult& result, PaperRow& row) {
  const auto clips = static_cast<double>(result.relevant.begin()->second);
  SetFigure(table, row, "clips", clips);
  SetFigure(table, row, "top_5", clips * result.mean.recall_in_5);
  SetFigure(table, row, "top_10", clips * result.mean.recall_in_10);
  SetFigure(table, row, "top_20", clips * result.mean.recall_in_20);
  if (result.mean.separation > 0) SetFigure(table, row, "separation", result.mean.separation);
}

}  // namespace

void RunTable4(const PaperInput& input, PaperComparison& comparison) {
  PaperTable& table = comparison.table;
  EvaluationData data = DataFor(input, table, kClipsOfTable4);
  comparison.notes.push_back(DescribeSearched(data) +
                             "; the paper searched 100 clips of 10 classes, 3.8 minutes");
  LookForTableOnly(table, data);
  const Evaluation evaluation = EvaluateHalves(input, data, kExamples, {});
  for (PaperRow& row : table.rows) {
    const ClassResult* result = ResultOf(evaluation, row.variant, row.paper_class);
    if (result != nullptr) SetRowOfTable4(table, *result, row);
  }
  comparison.notes.emplace_back(
      "rf, q and 3d are means over an example of each actor; the paper does not say which it took");
}

void RunTable5(const PaperInput& input, PaperComparison& comparison) {
  constexpr double kStrict = 0.02;
  constexpr double kLoose = 0.06;
  PaperTable& table = comparison.table;
  const EvaluationData data = DataFor(input, table, input.data.clips.size());
  const Evaluation evaluation = EvaluateHalves(input, data, kFuzzy, {kStrict, kLoose});
  for (PaperRow& row : table.rows) {
    const bool is_fuzzy = row.variant == "fuzzy";
    const ClassResult* result = ResultOf(evaluation, is_fuzzy ? "fuzzy" : "mt", row.paper_class);
    if (result == nullptr) continue;
    const Scores& mean = result->mean;
    const TauScores& scores = is_fuzzy                      ? mean.at_own
                              : row.variant == "mt at 0.02" ? mean.at[0]
                                                            : mean.at[1];
    SetFigure(table, row, "recall", scores.recall);
    SetFigure(table, row, "precision", scores.precision);
  }
  comparison.notes.push_back(
      DescribeSearched(data) +
      "; the paper searched all 1457 clips of 64 classes, also those that it had learned from");
  comparison.notes.emplace_back(
      "fuzzy: the group of features and the number of faults that find the clips best that are "
      "learned from; the paper's authors chose features by hand");
}

}  // namespace kinebase::internal

namespace kinebase {

TakeParts PartsFor(PaperPreset preset) {
  if (preset == PaperPreset::kTable4) return PartsFor(internal::BaselinesOf(internal::kExamples));
  if (preset == PaperPreset::kTable5) return PartsFor(internal::BaselinesOf(internal::kFuzzy));
  return {};
}

}  // namespace kinebase
