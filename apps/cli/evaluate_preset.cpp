#include "cli/evaluate_preset.h"

#include <cmath>
#include <limits>

#include "cli/score_table.h"
#include "fmt/format.h"
#include "fmt/ranges.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/library/paper_tables.h"
#include "kinebase/pictures/delta_picture.h"
#include "kinebase/search/template_search.h"

namespace kinebase::cli {
namespace {

constexpr char kUnknown[] = "–";
constexpr std::size_t kTextColumns = 2;  // Before the figures.

std::string HeadingOf(PaperPreset preset) {
  switch (preset) {
    case PaperPreset::kTable1:
      return "Table 1: learning templates";
    case PaperPreset::kTable2:
      return "Table 2: hits and how many of them are right, at six thresholds";
    case PaperPreset::kTable3:
      return "Table 3: hits below 0.06 around keyframes";
    case PaperPreset::kTable4:
      return "Table 4: right hits in the top 5, 10 and 20, and how well they are separated";
    case PaperPreset::kTable5:
      return "Table 5: templates and fuzzy retrieval";
    case PaperPreset::kFigure7:
      return "Figure 7: one class in a sequence of three, quantised and not";
    case PaperPreset::kFigure8:
      return "Figure 8: three classes in a sequence of four";
  }
  return {};
}

bool IsFigure(PaperPreset preset) {
  return preset == PaperPreset::kFigure7 || preset == PaperPreset::kFigure8;
}

// Ours; the paper's figures are shown as they stand there.
std::string ShowOurs(std::string_view column, double value) {
  if (column.starts_with("seconds")) return fmt::format("{:.2g}", value);
  if (column == "highest_right" || column == "lowest_other") return fmt::format("{:.3f}", value);
  if (column == "recall" || column == "precision" || column == "separation") {
    return fmt::format("{:.2f}", value);
  }
  const bool is_length = column == "mean_length" || column == "minutes" || column == "percent";
  // Of what is counted, means over examples have parts.
  return fmt::format("{:.{}f}", value, is_length || value != std::round(value) ? 1 : 0);
}

std::string Cell(std::string_view column, const std::optional<double>& figure, bool is_ours) {
  if (!figure) return kUnknown;
  return is_ours ? ShowOurs(column, *figure) : ToShortestText(*figure);
}

// Hits and the right ones among them share a column.
bool IsRightOf(std::string_view column, std::string_view before) {
  return before.starts_with("hits_") && column.starts_with("right_");
}

// The cells of one side, the paper's or ours.
std::vector<std::string> FigureCells(const PaperTable& table, const PaperFigures& figures,
                                     bool is_ours) {
  std::vector<std::string> cells;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    const std::string cell = Cell(table.columns[i], figures[i], is_ours);
    if (i > 0 && IsRightOf(table.columns[i], table.columns[i - 1])) {
      cells.back() += " / " + cell;
    } else {
      cells.push_back(cell);
    }
  }
  return cells;
}

std::vector<std::string> Titles(const PaperTable& table) {
  std::vector<std::string> titles = {"class", "figures of"};
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    std::string title = table.columns[i];
    if (i > 0 && IsRightOf(title, table.columns[i - 1])) continue;
    if (title.starts_with("hits_")) title.replace(0, title.find('_') + 1, "τ ");
    std::ranges::replace(title, '_', ' ');
    titles.push_back(std::move(title));
  }
  return titles;
}

Rows RowsOf(const PaperTable& table) {
  Rows rows = {Titles(table)};
  const auto add = [&](std::string name, std::string of, const PaperFigures& figures, bool ours) {
    std::vector<std::string>& row = rows.emplace_back();
    row = {std::move(name), std::move(of)};
    const std::vector<std::string> cells = FigureCells(table, figures, ours);
    row.insert(row.end(), cells.begin(), cells.end());
  };
  for (const PaperRow& row : table.rows) {
    const std::string variant = row.variant.empty() ? "" : ", " + row.variant;
    std::string of = "paper";
    if (row.here.empty()) {
      of += "; not here";
    } else if (row.ours.empty()) {
      of += "; nothing to search here";
    }
    add(row.paper_class + variant, std::move(of), row.paper, false);
    if (row.ours.empty()) continue;
    add("", fmt::format("{}", fmt::join(row.here, " + ")), row.ours, true);
  }
  return rows;
}

Json FiguresToJson(const PaperTable& table, const PaperFigures& figures) {
  if (figures.empty()) return {};
  Json json = Json::object();
  for (std::size_t i = 0; i < figures.size(); ++i) {
    json[table.columns[i]] = figures[i] ? Json(*figures[i]) : Json();
  }
  return json;
}

Json ToJson(const PaperSequence& sequence) {
  Json parts = Json::array();
  for (const PaperSequence::Part& part : sequence.parts) {
    parts.push_back(
        {{"class", part.class_name}, {"first_column", part.first}, {"last_column", part.last}});
  }
  Json curves = Json::array();
  for (const PaperSequence::Curve& each : sequence.curves) {
    Json delta = Json::array();  // JSON has no infinity; it is null.
    for (const double cost : each.curve.delta) {
      delta.push_back(std::isfinite(cost) ? Json(cost) : Json());
    }
    curves.push_back({{"class", each.class_name}, {"variant", each.variant}, {"delta", delta}});
  }
  return {{"rate_hz", sequence.rate_hz}, {"parts", parts}, {"curves", curves}};
}

Json ToJson(PaperPreset preset, const PaperComparison& comparison) {
  Json rows = Json::array();
  for (const PaperRow& row : comparison.table.rows) {
    rows.push_back({{"class", row.paper_class},
                    {"variant", row.variant.empty() ? Json() : Json(row.variant)},
                    {"here", row.here},
                    {"paper", FiguresToJson(comparison.table, row.paper)},
                    {"ours", FiguresToJson(comparison.table, row.ours)}});
  }
  Json json = {{"preset", ToString(preset)}, {"rows", rows}, {"notes", comparison.notes}};
  if (comparison.sequence) json["sequence"] = ToJson(*comparison.sequence);
  return json;
}

// A column begins with its number divided by the rate.
TimelineBar BarOf(const PaperSequence& sequence, int first, int last) {
  return {first / sequence.rate_hz, (last + 1) / sequence.rate_hz};
}

Picture DescribeSequence(const std::string& title, const PaperSequence& sequence) {
  DeltaPanel panel{.title = title,
                   .duration_s = (sequence.parts.back().last + 1) / sequence.rate_hz,
                   .frame_rate_hz = sequence.rate_hz,
                   .rows = {},
                   .labels = {}};
  for (const PaperSequence::Curve& each : sequence.curves) {
    DeltaRow& row = panel.rows.emplace_back();
    row.name = each.variant == "quantised" ? each.class_name
                                           : fmt::format("{}, {}", each.class_name, each.variant);
    row.cost = each.curve.delta;
    row.rate_hz = sequence.rate_hz;
    row.tau = kDefaultTau;
    for (const Hit& hit : each.hits) row.hits.push_back(BarOf(sequence, hit.first, hit.last));
  }
  for (const PaperSequence::Part& part : sequence.parts) {
    auto label = std::ranges::find(panel.labels, part.class_name, &TimelineRow::name);
    if (label == panel.labels.end()) {
      label = panel.labels.insert(panel.labels.end(), {part.class_name, {}, {}});
    }
    label->truth.push_back(BarOf(sequence, part.first, part.last));
  }
  return DeltaCurvesPicture({std::move(panel)});
}

std::string NotesAsText(const std::vector<std::string>& notes, std::string_view mark) {
  std::string text;
  for (const std::string& note : notes) text += fmt::format("{}{}\n", mark, note);
  return text;
}

std::string AsDocument(const PaperComparison& comparison) {
  return AsMarkdown(RowsOf(comparison.table), kTextColumns) + '\n' +
         NotesAsText(comparison.notes, "- ");
}

void CheckOutputs(const EvaluateCommandOptions& options, PaperPreset preset) {
  if (!options.picture.empty() && !IsFigure(preset)) {
    throw UsageError("--picture is for figure7 and figure8; a table has nothing to draw");
  }
  const Overwrite overwrite = options.common.overwrite();
  if (!options.picture.empty()) CheckWritable(options.picture, overwrite);
  if (options.report.folder.empty()) return;
  std::vector<std::string> pictures;
  if (IsFigure(preset)) pictures.push_back(options.preset);
  CheckReport(options.report, pictures, overwrite);
}

void WriteOutputs(const EvaluateCommandOptions& options, PaperPreset preset, ReportText text,
                  const PaperComparison& comparison) {
  const std::string heading = HeadingOf(preset);
  std::optional<Picture> picture;
  if (comparison.sequence) picture = DescribeSequence(heading, *comparison.sequence);
  const Overwrite overwrite = options.common.overwrite();
  if (!options.report.folder.empty()) {
    text.methods_table = AsDocument(comparison);
    text.json = ToJson(preset, comparison);
    WriteReport(options.report, text, heading, options.preset, picture, overwrite);
    PrintWritten(options.common, options.report.folder);
  }
  if (!options.picture.empty()) {
    WritePicture(options.picture, picture->size, overwrite, picture->draw);
    PrintWritten(options.common, options.picture);
  }
}

void PrintComparison(const EvaluateCommandOptions& options, PaperPreset preset,
                     const PaperComparison& comparison) {
  if (options.common.json) {
    PrintJson(ToJson(preset, comparison));
  } else if (options.format == "markdown") {
    Print(AsDocument(comparison));
  } else {
    Print(HeadingOf(preset) + "\n\n" + AsText(RowsOf(comparison.table), kTextColumns) + '\n' +
          NotesAsText(comparison.notes, ""));
  }
}

}  // namespace

int RunPreset(const EvaluateCommandOptions& options, const CLI::App& command) {
  const Stopwatch watch;
  const PaperPreset preset = *ParsePaperPreset(options.preset);
  CheckOutputs(options, preset);
  PaperOptions paper{.profile = options.features.ParsedProfile(),
                     .threads = options.common.threads,
                     .progress = MakeProgress(options.common)};
  if (!options.paper_classes.empty()) paper.classes = PaperClasses::Read(options.paper_classes);
  const FeatureSet features = options.features.Load();
  EvaluationData data = LoadEvaluationData(
      {options.list, options.folders, options.distractors}, features, options.features.rate_hz,
      options.common.load, options.common.threads, paper.progress, PartsFor(preset));
  if (!options.possibly_relevant.empty()) {
    data.possibly_relevant = PossiblyRelevant::Read(options.possibly_relevant, options.labels);
  }
  for (const TakeFailure& failure : data.failures) PrintError(failure.error.what());
  if (data.clips.empty()) return kCouldNot;
  const PaperComparison comparison = CompareWithPaper(preset, data, features, paper);
  ReportText text{.command = CommandLine(command), .facts = DataFacts(data)};
  text.facts.emplace_back("seconds, reading included", fmt::format("{:.1f}", watch.seconds()));
  WriteOutputs(options, preset, std::move(text), comparison);
  PrintComparison(options, preset, comparison);
  return data.failures.empty() ? kDone : kPartFailed;
}

}  // namespace kinebase::cli
