#include "cli/feature_options.h"

#include <algorithm>

#include "cli/arguments.h"
#include "cli/console.h"
#include "fmt/format.h"
#include "kinebase/core/error.h"
#include "kinebase/features/feature_extraction.h"

namespace kinebase::cli {
namespace {

// Nothing is surer than certain, and everything at least impossible: neither is a threshold.
constexpr double kLeastConfidence = 0.001;
constexpr double kMostConfidence = 0.999;

}  // namespace

FeatureSet FeatureOptions::Load() const {
  FeatureSet features = LoadFeatureSet(feature_set.empty() ? profile : feature_set);
  try {
    CheckColumnRate(features, rate_hz);
  } catch (const Error& error) {
    throw UsageError(fmt::format("--rate: {}", error.what()));
  }
  return features;
}

CLI::Option* AddProfileOption(CLI::App& command, std::string& profile, const std::string& text) {
  return command.add_option("--profile", profile, text)
      ->check(OneOf({"bonn", "paper"}))
      ->type_name("bonn|paper");
}

CLI::Option* AddFeatureSetOption(CLI::App& command, std::string& feature_set) {
  return command
      .add_option("--feature-set", feature_set, "Feature set: bonn, paper or a file of your own")
      ->type_name("NAME|FILE");
}

void AddRateOption(CLI::App& command, double& rate_hz) {
  command
      .add_option("--rate", rate_hz, "Columns a second; must divide the feature set's rate, 120")
      ->check(PositiveNumber())
      ->type_name("HZ")
      ->capture_default_str();
}

void AddMethodOption(CLI::App& command, std::string& method) {
  command
      .add_option("--method", method,
                  "mt, as in the paper; mt+, with all that a template learned so knows (default: "
                  "the latter where it can)")
      ->check(OneOf({"mt", "mt+"}))
      ->type_name("mt|mt+");
}

CLI::Option* AddConfidenceOption(CLI::App& command, std::optional<double>& confidence) {
  return command
      .add_option("--confidence", confidence,
                  "How sure a hit must be, from 0.001 to 0.999, of templates learned with mt+; "
                  "0.5 is what their thresholds mean")
      ->check(NumberBetween(kLeastConfidence, kMostConfidence))
      ->type_name("SHARE");
}

void CheckKnowsConfidence(const MotionTemplate& motion_template,
                          const std::filesystem::path& file) {
  if (motion_template.calibration && motion_template.calibration->slope > 0) return;
  throw Error(ErrorCode::kInvalidArgument,
              "does not know how sure its hits are; learn it with --method mt+, or give --tau "
              "instead of --confidence",
              {file});
}

FeatureSet FeatureSetOfTemplate(const std::filesystem::path& file,
                                const MotionTemplate& motion_template,
                                const std::string& feature_set) {
  const auto built_in = BuiltInFeatureSets();
  const bool is_built_in =
      std::ranges::find(built_in, motion_template.feature_set) != built_in.end();
  if (feature_set.empty() && !is_built_in) {
    throw Error(ErrorCode::kNotFound,
                fmt::format("template '{}' needs the feature set '{}': name its file with "
                            "--feature-set",
                            motion_template.name, motion_template.feature_set),
                {file});
  }
  FeatureSet features =
      LoadFeatureSet(feature_set.empty() ? motion_template.feature_set : feature_set);
  try {
    CheckFeatureSet(motion_template, features);
    CheckColumnRate(features, motion_template.matrix.rate_hz);
  } catch (const Error& error) {
    throw Error(error.code(), error.message(), {file});
  }
  return features;
}

}  // namespace kinebase::cli
