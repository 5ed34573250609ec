// Choosing feature set, profile and rate: options that `features`, `learn` and `search` share.
#pragma once

#include <CLI/CLI.hpp>
#include <filesystem>
#include <optional>
#include <string>

#include "kinebase/features/feature_set.h"
#include "kinebase/templates/motion_template.h"

namespace kinebase::cli {

struct FeatureOptions {
  std::string profile = "bonn";
  std::string feature_set;  // Empty: the profile's own.
  double rate_hz = 30;

  [[nodiscard]] Profile ParsedProfile() const { return *ParseProfile(profile); }

  // Errors  UsageError if the set has no such rate; those of LoadFeatureSet.
  [[nodiscard]] FeatureSet Load() const;
};

CLI::Option* AddProfileOption(CLI::App& command, std::string& profile, const std::string& text);
CLI::Option* AddFeatureSetOption(CLI::App& command, std::string& feature_set);
void AddRateOption(CLI::App& command, double& rate_hz);
// How much of what a template knows counts; empty: all.
void AddMethodOption(CLI::App& command, std::string& method);
// How sure hits must be, instead of a largest cost.
CLI::Option* AddConfidenceOption(CLI::App& command, std::optional<double>& confidence);

// Errors  InvalidArgument if the template in `file` does not know how sure its hits are.
void CheckKnowsConfidence(const MotionTemplate& motion_template, const std::filesystem::path& file);

// The feature set that the template in `file` needs: its own if built in, else the one that the
// user names. Errors  NotFound, naming --feature-set; Mismatch if it is another than the template
// was made with; InvalidArgument if it has not the template's rate.
[[nodiscard]] FeatureSet FeatureSetOfTemplate(const std::filesystem::path& file,
                                              const MotionTemplate& motion_template,
                                              const std::string& feature_set);

}  // namespace kinebase::cli
