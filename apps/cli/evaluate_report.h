// What `evaluate` found, as a folder: a document with its tables and pictures, and its JSON.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "cli/console.h"
#include "kinebase/library/evaluation.h"
#include "kinebase/pictures/canvas.h"

namespace kinebase::cli {

struct ReportOptions {
  std::filesystem::path folder;  // Empty: no report.
  std::string picture_format = "svg";

  [[nodiscard]] PictureFormat format() const {
    return picture_format == "png" ? PictureFormat::kPng : PictureFormat::kSvg;
  }
};

struct ReportText {
  std::string command;                                     // That made the report.
  std::vector<std::pair<std::string, std::string>> facts;  // Name and value.
  std::string methods_table;                               // Markdown.
  std::string classes_table;                               // May be empty.
  Json json;
};

// The command with the options that were given. Of paths from the root only the last part is shown,
// and of many paths the first and the last: the document is to be shown to others.
[[nodiscard]] std::string CommandLine(const CLI::App& command);

// Files, length and whatever else says how much was measured.
[[nodiscard]] std::vector<std::pair<std::string, std::string>> DataFacts(
    const EvaluationData& data);

// Asked before long work begins.
// Errors  AlreadyExists, IoFailure: a file of the report is there, or the folder is none.
void CheckReport(const ReportOptions& options, bool annotates, std::span<const std::string> methods,
                 Overwrite overwrite);

// The same of a report with these pictures, named without extension.
void CheckReport(const ReportOptions& options, std::span<const std::string> pictures,
                 Overwrite overwrite);

// All files, or none.
// Errors  Those of WriteFiles.
void WriteReport(const ReportOptions& options, const ReportText& text, const Evaluation& evaluation,
                 Overwrite overwrite);
void WriteReport(const ReportOptions& options, const ReportText& text,
                 std::span<const AnnotateEvaluation> results,
                 const std::vector<std::string>& classes, Overwrite overwrite);

// One table under a heading, and perhaps a picture: the file `name` and its extension.
void WriteReport(const ReportOptions& options, const ReportText& text, const std::string& heading,
                 const std::string& name, const std::optional<Picture>& picture,
                 Overwrite overwrite);

// [class][taken for] and what was mistaken.
[[nodiscard]] Json ConfusionToJson(const MethodResult& result);
[[nodiscard]] Json MistakenToJson(const MethodResult& result);

}  // namespace kinebase::cli
