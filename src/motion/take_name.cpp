// What file names say, and where a motion's skeleton is.

#include <algorithm>
#include <cctype>
#include <string>
#include <vector>

#include "fmt/format.h"
#include "fmt/ranges.h"
#include "kinebase/core/error.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/motion/motion_file.h"

namespace kinebase {
namespace {

namespace fs = std::filesystem;

constexpr double kCmuRateHz = 120;
constexpr int kFoldersUp = 3;

std::vector<std::string> SplitAtUnderscores(const std::string& text) {
  std::vector<std::string> parts(1);
  for (const char c : text) {
    if (c == '_') {
      parts.emplace_back();
    } else {
      parts.back() += c;
    }
  }
  return parts;
}

bool IsNumber(std::string_view text) {
  return !text.empty() && std::ranges::all_of(text, [](char c) { return c >= '0' && c <= '9'; });
}

// "05-01": a part and scene of the script.
bool IsScene(std::string_view text) {
  const std::size_t dash = text.find('-');
  return dash != std::string_view::npos && IsNumber(text.substr(0, dash)) &&
         IsNumber(text.substr(dash + 1));
}

double RateOf(const std::string& text) {
  const double rate = IsNumber(text) ? ParseDouble(text).value_or(0) : 0;
  return rate >= kSmallestRateHz && rate <= kLargestRateHz ? rate : 0;
}

// "HDM_tr_a_b" → "HDM_tr_a_b", "HDM_tr_a", "HDM_tr", "HDM".
std::vector<std::string> SkeletonStems(std::string stem) {
  std::vector<std::string> stems = {stem};
  for (std::size_t at = stem.rfind('_'); at != std::string::npos && at > 0; at = stem.rfind('_')) {
    stem.resize(at);
    stems.push_back(stem);
  }
  return stems;
}

}  // namespace

TakeName ParseTakeName(const fs::path& file) {
  const std::vector<std::string> parts = SplitAtUnderscores(file.stem().string());
  TakeName name;
  if (parts.size() >= 2 && IsNumber(parts[0]) && IsNumber(parts[1])) {
    return {.actor = parts[0], .take = parts[1], .rate_hz = kCmuRateHz};
  }
  if (parts.size() < 4 || !IsNumber(parts[3])) return name;
  name.actor = parts[1];
  if (IsScene(parts[2])) {
    name.take = parts[2] + '_' + parts[3];
  } else {
    name.class_name = parts[2];
    name.take = parts[3];
  }
  if (parts.size() >= 5) name.rate_hz = RateOf(parts[4]);
  return name;
}

fs::path FindSkeleton(const fs::path& motion_file) {
  const std::vector<std::string> stems = SkeletonStems(motion_file.stem().string());
  std::error_code ignored;
  fs::path folder = fs::absolute(motion_file, ignored).lexically_normal().parent_path();
  for (int up = 0; up <= kFoldersUp; ++up) {
    for (const fs::path& place : {folder, folder / "asf", folder / "skeletons"}) {
      if (!fs::is_directory(place, ignored)) continue;
      for (const auto& stem : stems) {
        for (const char* extension : {".asf", ".ASF"}) {
          fs::path candidate = place / (stem + extension);
          if (fs::is_regular_file(candidate, ignored)) return candidate;
        }
      }
    }
    if (folder == folder.parent_path()) break;
    folder = folder.parent_path();
  }
  throw Error(ErrorCode::kNotFound,
              fmt::format("no skeleton found: looked for {}.asf next to it, in up to {} folders "
                          "further up and in folders 'asf' and 'skeletons' there; name one with "
                          "--skeleton",
                          fmt::join(stems, ".asf, "), kFoldersUp),
              {motion_file});
}

}  // namespace kinebase
