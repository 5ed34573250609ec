#include "kinebase/library/descriptions.h"

#include <map>
#include <optional>

#include "fmt/format.h"
#include "fmt/ranges.h"
#include "kinebase/core/csv.h"
#include "kinebase/core/error.h"
#include "kinebase/core/text_scanner.h"
#include "kinebase/library/annotation_file.h"
#include "kinebase/library/hdm05.h"

namespace kinebase {
namespace {

namespace fs = std::filesystem;

std::size_t DescriptionColumn(const CsvTable& table) {
  if (const auto column = table.FindColumn("description")) return *column;
  for (std::size_t i = 0; i < table.columns.size(); ++i) {
    if (table.columns[i].ends_with("_description")) return i;
  }
  return table.Column("description");  // Says what there is.
}

// The column with names of recordings, if there is one.
std::optional<std::size_t> RecordingColumn(const CsvTable& table) {
  for (const char* name : {"file", "trial", "take"}) {
    if (const auto column = table.FindColumn(name)) return column;
  }
  return {};
}

// "HDM_bd_01-01_01_120" → "HDM_bd_01-01_01".
std::string WithoutRate(const std::string& recording) {
  const std::string ending = '_' + ToShortestText(ParseTakeName(recording).rate_hz);
  return recording.ends_with(ending) ? recording.substr(0, recording.size() - ending.size())
                                     : recording;
}

std::string DescriptionOf(const Hdm05Take& take) {
  if (!take.description.empty()) return take.description;
  const Hdm05Scene* scene = Hdm05().FindScene(take.part, take.scene);
  if (scene == nullptr) return {};
  std::vector<std::string_view> steps;
  steps.reserve(scene->steps.size());
  for (const Hdm05Step& step : scene->steps) steps.push_back(step.text);
  return fmt::format("{}: {}", scene->title, fmt::join(steps, "; "));
}

}  // namespace

std::vector<Description> ParseDescriptions(std::string_view text, const fs::path& file) {
  const CsvTable table = ParseCsv(text, file);
  const std::size_t words = DescriptionColumn(table);
  const std::optional<std::size_t> recording = RecordingColumn(table);
  const std::size_t class_name = recording ? 0 : table.Column("class");
  std::vector<Description> descriptions;
  descriptions.reserve(table.rows.size());
  for (std::size_t i = 0; i < table.rows.size(); ++i) {
    const std::vector<std::string>& row = table.rows[i];
    if (Trim(row[words]).empty()) continue;
    Description& description = descriptions.emplace_back();
    if (recording) {
      description.recording = RecordingName(row[*recording]);
    } else {
      description.class_name = row[class_name];
    }
    description.text = Trim(row[words]);
    description.line = table.lines[i];
  }
  return descriptions;
}

std::int64_t Describe(std::span<ImportSource> sources, std::span<const Description> descriptions) {
  std::map<std::string, const std::string*> of_recordings;
  std::map<std::string, const std::string*> of_classes;
  for (const Description& each : descriptions) {
    if (!each.recording.empty()) of_recordings.emplace(each.recording, &each.text);
    if (!each.class_name.empty()) of_classes.emplace(each.class_name, &each.text);
  }
  std::int64_t described = 0;
  for (ImportSource& source : sources) {
    const std::string recording = RecordingName(source.file);
    const std::string class_name =
        source.class_name.empty() ? ParseTakeName(source.file).class_name : source.class_name;
    auto found = of_recordings.find(recording);
    if (found == of_recordings.end()) found = of_recordings.find(WithoutRate(recording));
    const std::string* text = found == of_recordings.end() ? nullptr : found->second;
    if (text == nullptr) {
      const auto of_class = of_classes.find(class_name);
      if (of_class != of_classes.end()) text = of_class->second;
    }
    if (text == nullptr) continue;
    source.description = *text;
    ++described;
  }
  return described;
}

std::string Hdm05Description(const fs::path& file) {
  const std::string recording = RecordingName(file);
  if (!recording.starts_with("HDM_")) return {};
  if (const Hdm05Take* take = Hdm05().FindTake(WithoutRate(recording))) return DescriptionOf(*take);
  const Hdm05Class* motion_class = Hdm05().FindClass(ParseTakeName(file).class_name);
  return motion_class == nullptr ? std::string() : motion_class->description;
}

}  // namespace kinebase
