#include "cli/evaluate_report.h"

#include <algorithm>

#include "fmt/format.h"
#include "fmt/ranges.h"
#include "kinebase/library/evaluation_curves.h"
#include "kinebase/pictures/evaluation_picture.h"

namespace kinebase::cli {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostPathsShown = 4;
constexpr char kDocument[] = "report.md";
constexpr char kJson[] = "evaluation.json";

struct ReportFile {
  std::string name;
  std::string contents;
};

// As a shell reads it.
std::string ShellWord(const std::string& text) {
  constexpr std::string_view kPlain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_@%+=:,./-…";
  if (text.find_first_not_of(kPlain) == std::string::npos) return text;
  std::string quoted = "'";
  for (const char each : text) quoted += each == '\'' ? "'\\''" : std::string(1, each);
  return quoted + "'";
}

std::string ShownPath(const std::string& text) {
  const fs::path path = text;
  if (!path.is_absolute()) return text;
  const fs::path name = path.has_filename() ? path.filename() : path.parent_path().filename();
  return "…/" + name.string();
}

bool TakesPaths(const CLI::Option& option) {
  const std::string type = option.get_type_name();
  return type == "FILE" || type == "FOLDER" || type == "PATH";
}

std::vector<std::string> ShownValues(const CLI::Option& option) {
  std::vector<std::string> values = option.results();
  if (!TakesPaths(option)) return values;
  std::ranges::transform(values, values.begin(), ShownPath);
  if (values.size() <= kMostPathsShown) return values;
  return {values.front(), "…", values.back()};
}

std::string PictureName(const std::string& what, const ReportOptions& options) {
  return what + '.' + options.picture_format;
}

std::string ConfusionName(std::string_view method) { return fmt::format("confusion-{}", method); }

std::string Embed(const std::string& what, const std::string& name) {
  return fmt::format("![{}]({})\n\n", what, name);
}

// Title, command and figures that all reports begin with.
std::string DocumentHead(const ReportText& text, const std::string& heading = "Methods") {
  std::string document = "# How well motions are found\n\n```sh\n" + text.command + "\n```\n\n";
  document += "| measured on | |\n|---|---|\n";
  for (const auto& [name, value] : text.facts) {
    document += fmt::format("| {} | {} |\n", name, value);
  }
  return document + "\n## " + heading + "\n\n" + text.methods_table + '\n';
}

PrecisionPanel PanelOf(const Evaluation& evaluation, std::size_t class_index) {
  PrecisionPanel panel{.title = evaluation.methods.front().classes[class_index].class_name,
                       .curves = {}};
  for (const MethodResult& result : evaluation.methods) {
    std::vector<double> precision = MeanPrecision(result.classes[class_index]);
    // A class that nobody was tested on.
    if (precision.empty()) return {};
    panel.curves.push_back({std::string(result.name), std::move(precision)});
  }
  return panel;
}

// Nothing where no class could be tested.
std::optional<Picture> DescribePrecision(const Evaluation& evaluation) {
  PrecisionPanel whole{.title = "All classes", .curves = {}};
  for (const MethodResult& result : evaluation.methods) {
    std::vector<double> precision = MacroPrecision(result);
    if (precision.empty()) return std::nullopt;
    whole.curves.push_back(
        {fmt::format("{}, AP {:.3f}", result.name, result.macro.ap_lenient), std::move(precision)});
  }
  std::vector<PrecisionPanel> parts;
  for (std::size_t i = 0; i < evaluation.methods.front().classes.size(); ++i) {
    PrecisionPanel part = PanelOf(evaluation, i);
    if (!part.curves.empty()) parts.push_back(std::move(part));
  }
  return PrecisionPicture(std::move(whole), std::move(parts));
}

Picture DescribeConfusion(const MethodResult& result) {
  Confusion confusion = CountConfusion(result);
  ConfusionCounts shown{.title = fmt::format("{}: {} of {} clips recognised", result.name,
                                             confusion.right(), confusion.all()),
                        .counted = "clips",
                        .classes = std::move(confusion.classes),
                        .counts = std::move(confusion.counts)};
  const bool any_for_none =
      std::ranges::any_of(shown.counts, [](const auto& row) { return row.back() > 0; });
  if (!any_for_none) {
    for (auto& row : shown.counts) row.pop_back();
  }
  return ConfusionPicture(std::move(shown));
}

Picture DescribeConfusion(const AnnotateEvaluation& result,
                          const std::vector<std::string>& classes) {
  ConfusionCounts shown{.title = fmt::format("{}: frames of long takes", result.method),
                        .counted = "frames",
                        .classes = classes,
                        .counts = result.accuracy.confusion};
  shown.classes.emplace_back("none of them");
  return ConfusionPicture(std::move(shown));
}

Picture DescribeReliability(const Evaluation& evaluation) {
  std::vector<ReliabilityPanel> panels;
  for (const MethodResult& result : evaluation.methods) {
    if (!result.has_confidence) continue;
    const std::vector<ReliabilityBin> bins = MeasureReliability(result);
    ReliabilityPanel& panel = panels.emplace_back();
    panel.title = fmt::format("{}: calibration error {:.3f}", result.name, CalibrationError(bins));
    for (const ReliabilityBin& bin : bins) {
      panel.groups.push_back({bin.hits, bin.confidence, bin.right});
    }
  }
  return ReliabilityPicture(std::move(panels));
}

std::string Encode(const Picture& picture, const ReportOptions& options) {
  return EncodePicture(options.format(), picture.size, picture.draw);
}

void WriteAll(const ReportOptions& options, const std::vector<ReportFile>& files,
              Overwrite overwrite) {
  std::vector<FileContents> contents;
  contents.reserve(files.size());
  for (const ReportFile& file : files) {
    contents.push_back({options.folder / file.name, file.contents});
  }
  WriteFiles(contents, overwrite);
}

ReportFile JsonFile(const ReportText& text) {
  return {kJson, text.json.dump(2, ' ', false, Json::error_handler_t::replace) + '\n'};
}

}  // namespace

std::string CommandLine(const CLI::App& command) {
  std::string line = "kinebase " + command.get_name();
  for (const CLI::Option* option : command.get_options()) {
    const bool says_how = option->check_lname("force") || option->check_lname("quiet") ||
                          option->check_lname("json") || option->check_lname("threads");
    if (option->count() == 0 || says_how || option->get_lnames().empty()) continue;
    line += " --" + option->get_lnames().front();
    if (option->get_expected_max() == 0) continue;  // A flag.
    const std::vector<std::string> values = ShownValues(*option);
    if (option->get_delimiter() != '\0') {
      line += ' ' + ShellWord(fmt::format("{}", fmt::join(values, ",")));
      continue;
    }
    for (const std::string& value : values) line += ' ' + ShellWord(value);
  }
  return line;
}

std::vector<std::pair<std::string, std::string>> DataFacts(const EvaluationData& data) {
  double distractors_s = 0;
  for (const TakeFeatures& take : data.distractors) {
    distractors_s += static_cast<double>(take.frame_count) / take.rate_hz;
  }
  double clips_s = 0;
  for (const LabelledClip& clip : data.clips) {
    clips_s += static_cast<double>(clip.take.frame_count) / clip.take.rate_hz;
  }
  const auto files = [](std::size_t count, double seconds) {
    return fmt::format("{} ({:.1f} minutes)", count, seconds / 60);
  };
  std::vector<std::pair<std::string, std::string>> facts = {
      {"classes", std::to_string(data.ClassNames().size())},
      {"actors", std::to_string(data.Actors().size())},
      {"clips", files(data.clips.size(), clips_s)},
      {"distractors", files(data.distractors.size(), distractors_s)}};
  if (!data.failures.empty()) {
    facts.emplace_back("could not be read", std::to_string(data.failures.size()));
  }
  return facts;
}

void CheckReport(const ReportOptions& options, bool annotates, std::span<const std::string> methods,
                 Overwrite overwrite) {
  std::vector<std::string> names;
  if (!annotates) names = {"precision", "reliability"};
  for (const std::string& method : methods) names.push_back(ConfusionName(method));
  CheckReport(options, names, overwrite);
}

void CheckReport(const ReportOptions& options, std::span<const std::string> pictures,
                 Overwrite overwrite) {
  std::error_code ignored;
  if (fs::exists(options.folder, ignored) && !fs::is_directory(options.folder, ignored)) {
    throw Error(ErrorCode::kAlreadyExists, "is no folder; --report takes the name of one",
                {options.folder});
  }
  std::vector<std::string> names = {kDocument, kJson};
  for (const std::string& picture : pictures) names.push_back(PictureName(picture, options));
  for (const std::string& name : names) CheckWritable(options.folder / name, overwrite);
}

void WriteReport(const ReportOptions& options, const ReportText& text, const Evaluation& evaluation,
                 Overwrite overwrite) {
  std::vector<ReportFile> files = {JsonFile(text)};
  std::string document = DocumentHead(text);
  const auto add = [&](const std::string& what, const std::string& name, const Picture& picture) {
    document += Embed(what, name);
    files.push_back({name, Encode(picture, options)});
  };
  if (const auto precision = DescribePrecision(evaluation)) {
    document +=
        "## Precision over recall\n\nFor each recall the highest precision with that recall or "
        "more, mean over actors and, above, over classes; hits that may show the class after all "
        "are left out.\n\n";
    add("Precision over recall", PictureName("precision", options), *precision);
  }
  document += "## Classes\n\n" + text.classes_table + '\n';
  document +=
      "## What clips are taken for\n\nThe class whose template, or example, fits a clip best.\n\n";
  for (const MethodResult& result : evaluation.methods) {
    add(fmt::format("Confusion of {}", result.name),
        PictureName(ConfusionName(result.name), options), DescribeConfusion(result));
  }
  if (std::ranges::any_of(evaluation.methods, &MethodResult::has_confidence)) {
    document += fmt::format(
        "## Confidence\n\nHow many of the hits of a confidence are right; the diagonal is what it "
        "promises. Groups of fewer than {} hits are faint and do not count for the calibration "
        "error.\n\n",
        kFewHits);
    add("Reliability of confidences", PictureName("reliability", options),
        DescribeReliability(evaluation));
  }
  document.pop_back();
  files.push_back({kDocument, std::move(document)});
  WriteAll(options, files, overwrite);
}

void WriteReport(const ReportOptions& options, const ReportText& text,
                 std::span<const AnnotateEvaluation> results,
                 const std::vector<std::string>& classes, Overwrite overwrite) {
  std::vector<ReportFile> files = {JsonFile(text)};
  std::string document = DocumentHead(text);
  document += "## What frames are taken for\n\n";
  for (const AnnotateEvaluation& result : results) {
    const std::string name = PictureName(ConfusionName(result.method), options);
    document += Embed(fmt::format("Confusion of {}", result.method), name);
    files.push_back({name, Encode(DescribeConfusion(result, classes), options)});
  }
  document.pop_back();
  files.push_back({kDocument, std::move(document)});
  WriteAll(options, files, overwrite);
}

void WriteReport(const ReportOptions& options, const ReportText& text, const std::string& heading,
                 const std::string& name, const std::optional<Picture>& picture,
                 Overwrite overwrite) {
  std::vector<ReportFile> files = {JsonFile(text)};
  std::string document = DocumentHead(text, heading);
  if (picture) {
    const std::string file = PictureName(name, options);
    document += Embed(heading, file);
    files.push_back({file, Encode(*picture, options)});
  }
  document.pop_back();
  files.push_back({kDocument, std::move(document)});
  WriteAll(options, files, overwrite);
}

Json ConfusionToJson(const MethodResult& result) {
  const Confusion confusion = CountConfusion(result);
  return {{"classes", confusion.classes}, {"clips", confusion.counts}};
}

Json MistakenToJson(const MethodResult& result) {
  Json list = Json::array();
  for (const ClassifiedClip& clip : result.clips) {
    if (clip.taken_for == clip.class_name) continue;
    list.push_back({{"file", clip.file.string()},
                    {"actor", clip.actor},
                    {"class", clip.class_name},
                    {"taken_for", clip.taken_for.empty() ? Json() : Json(clip.taken_for)}});
  }
  return list;
}

}  // namespace kinebase::cli
