#include "kinebase/motion/motion_file.h"

#include <array>
#include <regex>
#include <utility>

#include "fmt/format.h"
#include "kinebase/core/error.h"
#include "kinebase/core/text_scanner.h"

namespace kinebase {
namespace {

constexpr double kUsualRateHz = 120;

// A rate in a comment that some writers leave: "# 60 fps", "#rate: 120".
double RateInComments(const std::vector<std::string>& header) {
  static const std::regex kNumberThenUnit(R"(([0-9]+(\.[0-9]+)?)\s*(hz|fps)\b)", std::regex::icase);
  static const std::regex kWordThenNumber(
      R"(\b(frame ?rate|rate|fps|hz)\s*[:= ]\s*([0-9]+(\.[0-9]+)?))", std::regex::icase);
  constexpr std::size_t kLongestComment = 200;  // std::regex recurses on its input.
  for (const auto& line : header) {
    const std::string text = line.substr(0, kLongestComment);
    std::smatch match;
    if (!text.starts_with('#')) continue;
    if (std::regex_search(text, match, kNumberThenUnit))
      return ParseDouble(match[1].str()).value_or(0);
    if (std::regex_search(text, match, kWordThenNumber))
      return ParseDouble(match[2].str()).value_or(0);
  }
  return 0;
}

double ChooseRate(const AmcMotion& amc, const TakeName& name, const LoadOptions& options,
                  Diagnostics& diagnostics) {
  if (options.source_rate_hz > 0) return options.source_rate_hz;
  if (const double rate = RateInComments(amc.header); rate > 0) return rate;
  if (name.rate_hz > 0) {
    if (name.class_name.empty() && name.take.find('-') == std::string::npos) {
      diagnostics.push_back(
          {Severity::kInfo,
           fmt::format("rate {} Hz as the name looks like one of the CMU database; --source-rate "
                       "says another",
                       name.rate_hz)});
    }
    return name.rate_hz;
  }
  diagnostics.push_back(
      {Severity::kWarning,
       fmt::format("the file does not tell its rate; {} Hz is taken, --source-rate says another",
                   kUsualRateHz)});
  return kUsualRateHz;
}

LoadedMotion LoadAsfAmc(const std::filesystem::path& path, const LoadOptions& options) {
  LoadedMotion loaded{.path = path, .format = "ASF/AMC", .name = ParseTakeName(path)};
  const AmcMotion amc = ReadAmc(path, {.strict = options.strict});
  loaded.skeleton_path = options.skeleton.empty() ? FindSkeleton(path) : options.skeleton;
  const AsfSkeleton asf = ReadAsf(loaded.skeleton_path);
  Diagnostics from_skeleton = asf.diagnostics;
  const AsfBuildOptions build{.length_reading =
                                  ChooseLengthReading(asf, options.length_reading, from_skeleton)};
  loaded.units = build.length_reading == LengthReading::kDivideToInches
                     ? fmt::format("inch / {:g}", asf.length_unit.value_or(1))
                     : fmt::format("cm / {:g}", 1 / asf.length_unit.value_or(1));
  std::shared_ptr<const Skeleton> skeleton;
  try {
    skeleton = BuildSkeleton(asf, build, from_skeleton);
  } catch (const Error& error) {
    throw Error(error.code(), error.message(), {loaded.skeleton_path});
  }
  for (Diagnostic& diagnostic : from_skeleton) {
    // Lines are those of the motion file; the skeleton's are named in the text.
    const std::string place =
        Place{loaded.skeleton_path.filename(), std::exchange(diagnostic.line, 0)}.ToString();
    diagnostic.message = place + ": " + diagnostic.message;
    loaded.diagnostics.push_back(std::move(diagnostic));
  }
  loaded.diagnostics.insert(loaded.diagnostics.end(), amc.diagnostics.begin(),
                            amc.diagnostics.end());
  const double rate_hz = ChooseRate(amc, loaded.name, options, loaded.diagnostics);
  try {
    loaded.motion = BuildMotion(amc, asf, std::move(skeleton), rate_hz, build, loaded.diagnostics);
  } catch (const Error& error) {
    throw Error(error.code(), error.message(), {path, error.place().line});
  }
  return loaded;
}

void SaveAsfAmc(const Motion& motion, const std::filesystem::path& path, Overwrite overwrite,
                Diagnostics& diagnostics) {
  const std::filesystem::path skeleton = std::filesystem::path(path).replace_extension(".asf");
  CheckWritable(path, overwrite);
  CheckWritable(skeleton, overwrite);
  WriteFile(skeleton, FormatAsf(ToAsf(*motion.skeleton)), overwrite);
  WriteFile(path, FormatAmc(ToAmc(motion, diagnostics)), overwrite);
}

constexpr std::array kFormats = {
    MotionFormat{"ASF/AMC", ".amc", "Acclaim motion with its skeleton in an ASF file", &LoadAsfAmc,
                 &SaveAsfAmc},
};

std::string KnownExtensions() {
  std::string text;
  for (const MotionFormat& format : kFormats) {
    text.append(text.empty() ? "" : ", ").append(format.extension);
  }
  return text;
}

[[noreturn]] void ThrowUnknownFormat(const std::filesystem::path& path) {
  throw Error(ErrorCode::kInvalidArgument,
              fmt::format("unknown motion format {}; known: {}", Quoted(path.extension().string()),
                          KnownExtensions()),
              {path});
}

}  // namespace

std::span<const MotionFormat> MotionFormats() { return kFormats; }

const MotionFormat* FindMotionFormat(const std::filesystem::path& path) {
  const std::string extension = ToLower(path.extension().string());
  for (const MotionFormat& format : kFormats) {
    if (format.extension == extension) return &format;
  }
  return nullptr;
}

LoadedMotion LoadMotion(const std::filesystem::path& path, const LoadOptions& options) {
  if (!std::filesystem::exists(path)) {
    throw Error(ErrorCode::kNotFound, "does not exist", {path});
  }
  const MotionFormat* format = FindMotionFormat(path);
  if (format == nullptr) ThrowUnknownFormat(path);
  LoadedMotion loaded = format->load(path, options);
  if (loaded.motion.skeleton && loaded.motion.frame_count == 0) {
    throw Error(ErrorCode::kMalformedFile, "has no frames", {path});
  }
  return loaded;
}

void SaveMotion(const Motion& motion, const std::filesystem::path& path, Overwrite overwrite,
                Diagnostics& diagnostics) {
  const MotionFormat* format = FindMotionFormat(path);
  if (format == nullptr || format->save == nullptr) ThrowUnknownFormat(path);
  format->save(motion, path, overwrite, diagnostics);
}

}  // namespace kinebase
