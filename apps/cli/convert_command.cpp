// kinebase convert: one motion file into another format.

#include <memory>

#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/console.h"
#include "fmt/format.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/library/takes.h"

namespace kinebase::cli {
namespace {

struct ConvertOptions {
  CommonOptions common;
  std::string input;
  std::filesystem::path output;
  double rate_hz = 0;
  std::string up;
  std::string units;
  std::filesystem::path write_names;
  std::string storage;
};

Json ToJson(const Diagnostics& diagnostics) {
  Json list = Json::array();
  for (const Diagnostic& diagnostic : diagnostics) {
    list.push_back({{"severity", ToString(diagnostic.severity)}, {"message", diagnostic.message}});
  }
  return list;
}

std::optional<C3dStorage> ParseStorage(const std::string& text) {
  for (const C3dStorage storage : {C3dStorage::kFloat, C3dStorage::kInteger}) {
    if (text == ToString(storage)) return storage;
  }
  return std::nullopt;
}

SaveOptions ToSaveOptions(const ConvertOptions& options) {
  SaveOptions save{.overwrite = options.common.overwrite(),
                   .units = options.units,
                   .marker_names = options.write_names,
                   .storage = ParseStorage(options.storage)};
  if (!options.up.empty()) save.up_axis = ParseUpAxis(options.up);
  return save;
}

// Whoever converts wants to know all that the result lacks, not only what is odd.
void PrintLosses(const ConvertOptions& options, const Diagnostics& lost) {
  for (const Diagnostic& diagnostic : lost) {
    PrintNote(options.common, fmt::format("{}: {}: {}", options.output.string(),
                                          ToString(diagnostic.severity), diagnostic.message));
  }
}

const MotionFormat& FormatToWrite(const std::filesystem::path& output) {
  const MotionFormat* const format = FindMotionFormat(output);
  if (format != nullptr && format->save != nullptr) return *format;
  std::string endings;
  for (const MotionFormat& other : MotionFormats()) {
    if (other.save == nullptr) continue;
    endings.append(endings.empty() ? "" : ", ").append(other.extension);
  }
  throw UsageError(
      fmt::format("the ending of {} names no format that can be written; those that can: {}",
                  Quoted(output.string()), endings));
}

// An AMC is written with its skeleton beside it; else empty.
std::filesystem::path SkeletonBeside(const std::filesystem::path& output) {
  const std::string extension = output.extension().string();
  if (!EqualsIgnoringCase(extension, ".amc")) return {};
  return std::filesystem::path(output).replace_extension(".asf");
}

int Run(const ConvertOptions& options) {
  const TakeStretch stretch = ParseMotionArgument(options.input);
  const MotionFormat& format = FormatToWrite(options.output);
  CheckWritable(options.output, options.common.overwrite());
  Recording recording = LoadStretch(stretch, options.common.load);
  PrintDiagnostics(options.common, stretch.file, recording.diagnostics);
  Diagnostics lost;
  if (options.rate_hz > 0 && options.rate_hz != recording.rate_hz()) {
    const auto told = static_cast<std::ptrdiff_t>(recording.diagnostics.size());
    recording = ResampleRecording(recording, options.rate_hz);
    lost.assign(recording.diagnostics.begin() + told, recording.diagnostics.end());
  }
  SaveRecording(recording, options.output, ToSaveOptions(options), lost);
  PrintLosses(options, lost);
  const std::filesystem::path skeleton = SkeletonBeside(options.output);
  if (options.common.json) {
    PrintJson({{"file", options.output.string()},
               {"format", format.name},
               {"frames", recording.frame_count()},
               {"rate_hz", recording.rate_hz()},
               {"skeleton", skeleton.empty() ? Json() : Json(skeleton.string())},
               {"diagnostics", ToJson(lost)}});
  } else {
    PrintWritten(options.common, options.output);
    if (!skeleton.empty()) PrintWritten(options.common, skeleton);
  }
  return kDone;
}

std::string FormatList() {
  std::string text = "Formats by the ending of the file's name:";
  for (const MotionFormat& format : MotionFormats()) {
    text += fmt::format("\n  {:<6}{:<12}{}", format.extension,
                        format.load == nullptr ? "write" : "read, write", format.description);
  }
  return text;
}

}  // namespace

void AddConvertCommand(CLI::App& program, int& exit_code) {
  auto options = std::make_shared<ConvertOptions>();
  CLI::App* command = program.add_subcommand("convert", "Turn a motion file into another format");
  command->add_option("IN", options->input, "Motion file, or a stretch: take.amc:120-480")
      ->required();
  command->add_option("OUT", options->output, "File to write; its ending tells the format")
      ->required();
  command->add_option("--rate", options->rate_hz, "Resample to so many frames a second")
      ->check(NumberBetween(kSmallestRateHz, kLargestRateHz))
      ->type_name("HZ");
  command
      ->add_option("--up", options->up,
                   "Axis that points up in OUT (default: as the format expects, or as it was)")
      ->check(OneOf({"x", "y", "z"}))
      ->type_name("x|y|z");
  command
      ->add_option("--units", options->units,
                   "Unit of lengths in OUT (default: as the format expects, or as it was)")
      ->check(OneOf({kLengthUnits.begin(), kLengthUnits.end()}))
      ->type_name("mm|cm|m|inch|ft");
  command
      ->add_option("--storage", options->storage,
                   "Samples of a C3D as float or whole numbers (default: as it was, or float)")
      ->check(OneOf({"float", "int16"}))
      ->type_name("float|int16");
  command
      ->add_option("--write-names", options->write_names,
                   "Names that markers get in OUT (MNM: name of the preset, name in the file)")
      ->type_name("FILE");
  AddOutputOptions(*command, options->common);
  AddForceOption(*command, options->common);
  AddLoadOptions(*command, options->common);
  command->footer(FormatList() + "\n\nExample:\n  kinebase convert walk.c3d walk.trc --units m");
  command->callback([options, &exit_code] { exit_code = Run(*options); });
}

}  // namespace kinebase::cli
