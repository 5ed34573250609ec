// Which experiment a preset is, and what all of them share.

#include <algorithm>
#include <map>

#include "fmt/format.h"
#include "fmt/ranges.h"
#include "kinebase/core/error.h"
#include "library/every_other.h"
#include "library/paper_experiments.h"

namespace kinebase {
namespace internal {

MotionTemplate LearnFrom(std::span<const LabelledClip* const> clips, const PaperInput& input) {
  return LearnClass(clips.front()->class_name, clips, input.features,
                    {.learning = input.options.profile,
                     .matching = input.options.profile,
                     .threads = input.options.threads});
}

void SetFigure(const PaperTable& table, PaperRow& row, std::string_view column, double figure) {
  row.ours.resize(table.columns.size());
  const auto found = std::ranges::find(table.columns, column);
  if (found == table.columns.end()) {
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("the paper's table has no column {}; there are {}", column,
                            fmt::join(table.columns, ", ")));
  }
  row.ours[static_cast<std::size_t>(found - table.columns.begin())] = figure;
}

std::vector<const LabelledClip*> ClipsOf(const std::set<std::string>& names, bool learned_from,
                                         const PaperInput& input) {
  std::vector<const LabelledClip*> clips;
  for (std::size_t i = 0; i < input.data.clips.size(); ++i) {
    const LabelledClip& clip = input.data.clips[i];
    if (names.contains(clip.class_name) && input.learned_from[i] == learned_from) {
      clips.push_back(&clip);
    }
  }
  return clips;
}

void ReportRow(const PaperInput& input, std::size_t done, std::size_t total) {
  if (input.options.progress && !input.options.progress("comparing", done, total)) {
    throw Error(ErrorCode::kCancelled, "the comparison was cancelled");
  }
}

namespace {

std::vector<bool> FirstHalf(const EvaluationData& data) {
  std::vector<bool> learned_from;
  learned_from.reserve(data.clips.size());
  internal::EveryOther every_other;
  for (const LabelledClip& clip : data.clips) {
    learned_from.push_back(every_other.Takes(clip.class_name));
  }
  return learned_from;
}

// What the table is about is nowhere in the list.
void CheckAnyHere(PaperPreset preset, const PaperInput& input, const PaperTable& table) {
  std::set<std::string> wanted;
  for (const PaperRow& row : table.rows) {
    if (!input.options.classes.Find(row.paper_class, input.class_names).names.empty()) return;
    wanted.insert(row.paper_class);
  }
  throw Error(ErrorCode::kInvalidArgument,
              fmt::format("the list of clips has none of the classes of {} ({}); a table with "
                          "columns class and hdm05 can say what they are called in it",
                          ToString(preset), fmt::join(wanted, ", ")));
}

// In which ways the classes that are here are not quite the paper's.
void AddNotesOfClasses(const PaperInput& input, PaperComparison& comparison) {
  std::set<std::string> noted;
  for (const PaperRow& row : comparison.table.rows) {
    if (!row.here.empty() && noted.insert(row.paper_class).second) {
      const auto found = input.options.classes.Find(row.paper_class, input.class_names);
      if (!found.note.empty() && found.names == row.here) {
        comparison.notes.push_back(fmt::format("{} is {} here: {}", row.paper_class,
                                               fmt::join(row.here, " and "), found.note));
      }
    }
    if (row.note.empty()) continue;
    const std::string variant = row.variant.empty() ? "" : ", " + row.variant;
    comparison.notes.push_back(fmt::format("{}{}: {}", row.paper_class, variant, row.note));
  }
}

void RunPreset(PaperPreset preset, const PaperInput& input, PaperComparison& comparison) {
  switch (preset) {
    case PaperPreset::kTable1:
      return RunTable1(input, comparison);
    case PaperPreset::kTable2:
      return RunTable2(input, comparison);
    case PaperPreset::kTable3:
      return RunTable3(input, comparison);
    case PaperPreset::kTable4:
      return RunTable4(input, comparison);
    case PaperPreset::kTable5:
      return RunTable5(input, comparison);
    case PaperPreset::kFigure7:
    case PaperPreset::kFigure8:
      return RunFigure(input, comparison);
  }
}

}  // namespace
}  // namespace internal

PaperComparison CompareWithPaper(PaperPreset preset, const EvaluationData& data,
                                 const FeatureSet& features, const PaperOptions& options) {
  const internal::PaperInput input{.data = data,
                                   .features = features,
                                   .options = options,
                                   .class_names = data.ClassNames(),
                                   .learned_from = internal::FirstHalf(data)};
  PaperComparison comparison{.table = ReadPaperTable(preset), .notes = {}, .sequence = {}};
  const bool is_figure = preset == PaperPreset::kFigure7 || preset == PaperPreset::kFigure8;
  // Whatever class is here can stand in a figure.
  if (!is_figure) internal::CheckAnyHere(preset, input, comparison.table);
  for (PaperRow& row : comparison.table.rows) {
    row.here = options.classes.Find(row.paper_class, input.class_names).names;
  }
  internal::RunPreset(preset, input, comparison);
  internal::AddNotesOfClasses(input, comparison);
  return comparison;
}

}  // namespace kinebase
