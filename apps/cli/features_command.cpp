// kinebase features: the feature matrix of a recording, as CSV or as a picture.

#include <memory>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/console.h"
#include "cli/feature_options.h"
#include "fmt/format.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/library/takes.h"
#include "kinebase/pictures/template_picture.h"

namespace kinebase::cli {
namespace {

struct FeaturesOptions {
  CommonOptions common;
  FeatureOptions features;
  std::string motion;
  std::filesystem::path output;
};

std::string ToCsv(const TakeFeatures& take, const FeatureSet& features) {
  std::string text = "frame";
  for (const Feature& feature : features.features) text += ',' + CsvField(feature.id);
  for (int column = 0; column < take.features.column_count(); ++column) {
    const FrameRange frames =
        FramesOfColumns(column, column, take.features.rate_hz, take.rate_hz, take.frame_count);
    text += '\n' + std::to_string(frames.first + 1);
    for (int row = 0; row < take.features.feature_count; ++row) {
      text += take.features.at(column, row) ? ",1" : ",0";
    }
  }
  return text + '\n';
}

bool IsPicture(const std::filesystem::path& path) {
  const std::string extension = ToLower(path.extension().string());
  return extension == ".png" || extension == ".svg";
}

int Run(const FeaturesOptions& options) {
  const Overwrite overwrite = options.common.overwrite();
  const bool is_printed = IsStandardOutput(options.output);
  if (is_printed && options.common.json)
    throw UsageError("--json needs -o FILE: the table itself is CSV");
  if (!is_printed) CheckWritable(options.output, overwrite);
  const FeatureSet features = options.features.Load();
  const TakeFeatures take = LoadTakeFeatures(ParseMotionArgument(options.motion), features,
                                             options.features.rate_hz, options.common.load);
  PrintDiagnostics(options.common, take.path, take.diagnostics);
  if (IsPicture(options.output)) {
    DrawFeatureMatrix(take.features, features, take.path.stem().string(), options.output,
                      overwrite);
  } else {
    WriteTextOrPrint(options.output, ToCsv(take, features), options.common);
  }
  if (is_printed) return kDone;
  if (options.common.json) {
    PrintJson({{"file", options.output.string()},
               {"columns", take.features.column_count()},
               {"features", features.feature_count()},
               {"rate_hz", take.features.rate_hz}});
  } else {
    PrintWritten(options.common, options.output);
  }
  return kDone;
}

}  // namespace

void AddFeaturesCommand(CLI::App& program, int& exit_code) {
  auto options = std::make_shared<FeaturesOptions>();
  CLI::App* command = program.add_subcommand(
      "features", "The feature matrix of a motion: CSV of 0 and 1, or a picture");
  command->add_option("MOTION", options->motion, "Motion file, or a stretch: take.amc:120-480")
      ->required();
  command
      ->add_option("-o,--output", options->output,
                   "CSV file (default: standard output), or a picture by its ending: .png, .svg")
      ->type_name("FILE");
  AddProfileOption(*command, options->features.profile, "Feature set by its profile")
      ->capture_default_str();
  AddFeatureSetOption(*command, options->features.feature_set);
  AddRateOption(*command, options->features.rate_hz);
  AddOutputOptions(*command, options->common);
  AddForceOption(*command, options->common);
  AddLoadOptions(*command, options->common);
  command->footer("Example:\n  kinebase features squat.amc -o squat.features.csv");
  command->callback([options, &exit_code] { exit_code = Run(*options); });
}

}  // namespace kinebase::cli
