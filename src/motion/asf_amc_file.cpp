// The row of ASF/AMC: a pair of files and a motion.

#include <algorithm>
#include <initializer_list>
#include <memory>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "fmt/format.h"
#include "kinebase/core/error.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/motion/rig_mapping.h"
#include "motion/file_formats.h"
#include "motion/name_map.h"
#include "motion/record_loss.h"

namespace kinebase::internal {
namespace {

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

// The format has no field for the rate. Where neither the header nor the file's name tells it, a
// comment does, as other writers leave it.
void TellRate(double rate_hz, const std::filesystem::path& path, AmcMotion& amc) {
  const double commented_hz = RateInComments(amc.header);
  const double told_hz = commented_hz > 0 ? commented_hz : ParseTakeName(path).rate_hz;
  if (told_hz == rate_hz) return;
  amc.header.insert(amc.header.begin(), "# " + ToShortestText(rate_hz) + " fps");
}

}  // namespace

Recording LoadAsfAmc(const std::filesystem::path& path, const LoadOptions& options) {
  Recording loaded{.path = path, .format = "ASF/AMC", .name = ParseTakeName(path)};
  if (options.up_axis || !options.units.empty()) {
    loaded.diagnostics.push_back(
        {Severity::kWarning,
         "the skeleton tells the unit of an AMC, and Y is up: --source-units and --source-up are "
         "not followed; --asf-length says how the skeleton's unit is meant"});
  }
  AcclaimRecord record{.amc = ReadAmc(path, {.strict = options.strict})};
  loaded.skeleton_path = options.skeleton.empty() ? FindSkeleton(path) : options.skeleton;
  record.asf = ReadAsf(loaded.skeleton_path);
  const auto& [asf, amc] = record;
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
  if (!NamesStandardJoints(skeleton->joints())) {
    RigMapping mapping = MapRigByTopology(skeleton->joints());
    loaded.joint_sources = std::move(mapping.sources);
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
  const double commented_hz = options.source_rate_hz == 0 ? RateInComments(amc.header) : 0;
  const double rate_hz =
      commented_hz > 0 ? commented_hz : ChooseRate(loaded.name, options, loaded.diagnostics);
  try {
    loaded.motion = BuildMotion(amc, asf, std::move(skeleton), rate_hz, build, loaded.diagnostics);
  } catch (const Error& error) {
    throw Error(error.code(), error.message(), {path, error.place().line});
  }
  loaded.record = std::make_shared<FileRecord>(std::move(record));
  return loaded;
}

void SaveAsfAmc(const Recording& recording, const std::filesystem::path& path,
                const SaveOptions& options, Diagnostics& diagnostics) {
  RequireSkeleton(recording, "ASF/AMC", path);
  if (options.up_axis.value_or(UpAxis::kY) != UpAxis::kY || !options.units.empty()) {
    throw Error(ErrorCode::kInvalidArgument,
                "ASF/AMC has Y up and lengths in inch / 0.45 by convention; write it without --up "
                "and --units",
                {path});
  }
  const std::filesystem::path skeleton = std::filesystem::path(path).replace_extension(".asf");
  CheckWritable(path, options.overwrite);
  CheckWritable(skeleton, options.overwrite);
  const auto* kept =
      recording.record ? std::get_if<AcclaimRecord>(recording.record.get()) : nullptr;
  AcclaimRecord record = kept != nullptr
                             ? *kept
                             : AcclaimRecord{.asf = ToAsf(*recording.motion.skeleton),
                                             .amc = ToAmc(recording.motion, diagnostics)};
  ReportRecordLoss(recording, "ASF/AMC", diagnostics, {Extra::kSkeletonSource});
  TellRate(recording.rate_hz(), path, record.amc);
  const std::string asf_text = FormatAsf(record.asf);
  const std::string amc_text = FormatAmc(record.amc);
  const FileContents files[] = {{skeleton, asf_text}, {path, amc_text}};
  WriteFiles(files, options.overwrite);
}

}  // namespace kinebase::internal
