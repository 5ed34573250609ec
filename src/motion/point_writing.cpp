#include "motion/point_writing.h"

#include <algorithm>
#include <limits>
#include <map>
#include <utility>

#include "fmt/format.h"
#include "kinebase/core/error.h"
#include "kinebase/core/text_scanner.h"

namespace kinebase::internal {
namespace {

// Makes names unique: the second "a" becomes "a_2".
class UniqueNames {
 public:
  std::string Take(std::string name) {
    int& count = counts_[name];
    if (++count == 1) return name;
    while (true) {
      std::string candidate = fmt::format("{}_{}", name, count);
      if (counts_.emplace(candidate, 1).second) return candidate;
      ++count;  // The map does not move its values.
    }
  }

 private:
  std::map<std::string, int> counts_;  // How often each name was asked for.
};

}  // namespace

std::vector<std::string> WritableLabels(std::span<const std::string> labels,
                                        std::string_view forbidden, char replacement,
                                        Diagnostics& diagnostics) {
  std::vector<std::string> result;
  UniqueNames unique;
  std::size_t changed = 0;
  std::string example;
  for (const auto& label : labels) {
    std::string name(Trim(label));
    for (char& c : name) {
      const bool is_control = static_cast<unsigned char>(c) < 0x20;
      if (is_control || forbidden.find(c) != std::string_view::npos) c = replacement;
    }
    name = Trim(name);
    if (name.empty()) name = fmt::format("marker{}", result.size() + 1);
    name = unique.Take(std::move(name));
    if (name != label && changed++ == 0) {
      example = fmt::format("{} as {}", Quoted(label), Quoted(name));
    }
    result.push_back(std::move(name));
  }
  if (changed > 0) {
    diagnostics.push_back(
        {Severity::kWarning, fmt::format("{} names changed: {}{}", changed, example,
                                         changed > 1 ? " and others" : "")});
  }
  return result;
}

MarkerNames ReadMarkerNames(const std::filesystem::path& path, bool strict,
                            Diagnostics& diagnostics) {
  MarkerNames names = ReadMnm(path, {.strict = strict});
  for (const Diagnostic& diagnostic : names.diagnostics) {
    const std::string place = Place{path.filename(), diagnostic.line}.ToString();
    diagnostics.push_back({diagnostic.severity, place + ": " + diagnostic.message});
  }
  return names;
}

void ReportFilledSamples(const MarkerCloud& markers, std::string_view format,
                         Diagnostics& diagnostics) {
  const auto filled = std::ranges::count(markers.states, MarkerState::kFilled);
  if (filled == 0) return;
  diagnostics.push_back(
      {Severity::kInfo, fmt::format("{} does not tell filled samples from measured ones: {} are "
                                    "written like these",
                                    format, filled)});
}

int FrameCountOrFail(std::size_t count) {
  if (count <= static_cast<std::size_t>(std::numeric_limits<int>::max())) {
    return static_cast<int>(count);
  }
  throw Error(ErrorCode::kMismatch,
              fmt::format("{} frames are more than a recording can have", count));
}

}  // namespace kinebase::internal
