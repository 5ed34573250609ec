#include "library/take_origin.h"

#include <chrono>
#include <string>

#include "fmt/format.h"
#include "kinebase/core/mapped_file.h"
#include "kinebase/core/text_scanner.h"
#include "library/catalogue_records.h"
#include "library/checksum.h"
#include "library/library_layout.h"

namespace kinebase::internal {
namespace {

namespace fs = std::filesystem;

// The options that change how files are read, as the command line has them.
std::string OptionsText(const LoadOptions& options) {
  std::string text;
  const auto add = [&](std::string_view name, std::string_view value) {
    text +=
        fmt::format("{}--{}{}{}", text.empty() ? "" : " ", name, value.empty() ? "" : " ", value);
  };
  if (!options.skeleton.empty()) add("skeleton", options.skeleton.string());
  if (options.source_rate_hz != 0) add("source-rate", ToShortestText(options.source_rate_hz));
  if (!options.units.empty()) add("source-units", options.units);
  if (options.up_axis) add("source-up", ToLower(ToString(*options.up_axis)));
  if (!options.marker_names.empty()) add("names", options.marker_names.string());
  if (!options.marker_set.empty()) add("marker-set", options.marker_set.string());
  if (options.strict) add("strict", "");
  if (options.length_reading != LengthReading::kAuto) {
    add("asf-length",
        options.length_reading == LengthReading::kDivideToInches ? "inches" : "centimetres");
  }
  return text;
}

}  // namespace

fs::path Resolved(const fs::path& file) {
  std::error_code unreachable;
  fs::path resolved = fs::canonical(file, unreachable);
  return unreachable ? fs::absolute(file, unreachable) : resolved;
}

StoredSkeleton SkeletonAt(const fs::path& file) {
  if (file.empty()) return {};
  return {Resolved(file), KeyOf({MappedFile(file).text()})};
}

TakeOrigin OriginOf(const fs::path& file, const LoadOptions& options) {
  std::error_code unreachable;  // What is not known is 0.
  const auto changed = fs::last_write_time(file, unreachable);
  const auto since_1970 = unreachable ? std::chrono::system_clock::duration(0)
                                      : std::chrono::file_clock::to_sys(changed).time_since_epoch();
  return {.imported_s = SecondsSince1970(),
          .file_time_s = std::chrono::floor<std::chrono::seconds>(since_1970).count(),
          .file_bytes = FileBytes(file),
          .program = "kinebase " KINEBASE_VERSION,
          .options = OptionsText(options)};
}

}  // namespace kinebase::internal
