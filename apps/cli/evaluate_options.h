// What `evaluate` was asked for.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "cli/console.h"
#include "cli/evaluate_report.h"
#include "cli/feature_options.h"

namespace kinebase::cli {

struct EvaluateCommandOptions {
  CommonOptions common;
  FeatureOptions features;
  std::filesystem::path list;
  std::vector<std::filesystem::path> folders;
  std::vector<std::filesystem::path> distractors;
  std::filesystem::path possibly_relevant;
  std::filesystem::path labels;
  std::string protocol = "leave-one-actor-out";
  std::string thresholds = "training";
  std::vector<std::string> methods = {"mt", "mt+"};
  std::string format = "text";
  ReportOptions report;
  std::string preset;  // Of the paper; empty: none.
  std::filesystem::path paper_classes;
  std::filesystem::path picture;
};

}  // namespace kinebase::cli
