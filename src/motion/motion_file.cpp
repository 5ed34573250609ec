#include "kinebase/motion/motion_file.h"

#include <algorithm>
#include <array>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include "fmt/format.h"
#include "kinebase/core/error.h"
#include "kinebase/core/text_scanner.h"

namespace kinebase {
namespace {

constexpr double kUsualRateHz = 120;

// A word or a number of a comment, and what stands before it.
struct CommentPart {
  std::string_view gap;
  std::string_view text;
  bool is_number = false;
};

std::vector<CommentPart> SplitComment(std::string_view comment) {
  const auto is_digit = [](char c) { return (c >= '0' && c <= '9') || c == '.'; };
  const auto is_letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z'); };
  const std::size_t size = comment.size();
  std::vector<CommentPart> parts;
  for (std::size_t end = 0; end < size;) {
    std::size_t begin = end;
    while (begin < size && !is_digit(comment[begin]) && !is_letter(comment[begin])) ++begin;
    if (begin == size) break;
    const std::string_view gap = comment.substr(end, begin - end);
    const bool is_number = is_digit(comment[begin]);
    end = begin + 1;
    while (end < size && (is_number ? is_digit(comment[end]) : is_letter(comment[end]))) ++end;
    parts.push_back({gap, comment.substr(begin, end - begin), is_number});
  }
  return parts;
}

bool IsAnyOf(std::string_view word, std::initializer_list<std::string_view> words) {
  return std::ranges::any_of(words,
                             [&](std::string_view each) { return EqualsIgnoringCase(word, each); });
}

// A rate in a comment that some writers leave: "# 60 fps", "#rate: 120".
double RateInComments(const std::vector<std::string>& header) {
  for (const auto& line : header) {
    if (!line.starts_with('#')) continue;
    const std::vector<CommentPart> parts = SplitComment(line);
    for (std::size_t i = 1; i < parts.size(); ++i) {
      const CommentPart& before = parts[i - 1];
      const CommentPart& part = parts[i];
      const bool unit_follows =
          before.is_number && Trim(part.gap).empty() && IsAnyOf(part.text, {"hz", "fps"});
      const bool number_follows = part.is_number && IsAnyOf(Trim(part.gap), {"", ":", "="}) &&
                                  IsAnyOf(before.text, {"rate", "framerate", "fps", "hz"});
      if (!unit_follows && !number_follows) continue;
      const double rate = ParseDouble(unit_follows ? before.text : part.text).value_or(0);
      if (rate >= kSmallestRateHz && rate <= kLargestRateHz) return rate;
    }
  }
  return 0;
}

double ChooseRate(const AmcMotion& amc, const TakeName& name, const LoadOptions& options,
                  Diagnostics& diagnostics) {
  if (options.source_rate_hz != 0) {
    if (options.source_rate_hz >= kSmallestRateHz && options.source_rate_hz <= kLargestRateHz) {
      return options.source_rate_hz;
    }
    throw Error(ErrorCode::kInvalidArgument,
                fmt::format("a source rate of {:g} Hz; it must lie between {:g} and {:g} Hz",
                            options.source_rate_hz, kSmallestRateHz, kLargestRateHz));
  }
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
  const std::string asf_text = FormatAsf(ToAsf(*motion.skeleton));
  const std::string amc_text = FormatAmc(ToAmc(motion, diagnostics));
  WriteFile(skeleton, asf_text, overwrite);
  WriteFile(path, amc_text, overwrite);
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
  std::error_code ignored;  // A name that is too long, say: there is no such file either.
  if (!std::filesystem::exists(path, ignored)) {
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
