#include "cli/search_output.h"

#include "cli/failure_output.h"
#include "fmt/format.h"
#include "kinebase/core/csv.h"
#include "kinebase/core/text_scanner.h"

namespace kinebase::cli {

Json HitsToJson(const std::vector<NamedHit>& hits, const std::vector<TakeFailure>& failures,
                std::int64_t frames, double elapsed_s) {
  Json list = Json::array();
  for (const auto& [query, template_name, file, hit] : hits) {
    list.push_back({{"template", template_name},
                    {"file", file.string()},
                    {"first_frame", hit.first_frame},
                    {"last_frame", hit.last_frame},
                    {"start_s", hit.start_s},
                    {"end_s", hit.end_s},
                    {"cost", hit.cost},
                    {"confidence", hit.confidence ? Json(*hit.confidence) : Json()}});
  }
  Json json = {{"hits", std::move(list)}, {"scanned_frames", frames}, {"elapsed_s", elapsed_s}};
  if (!failures.empty()) json["failed"] = FailuresToJson(failures);
  return json;
}

std::string HitsToText(const std::vector<NamedHit>& hits, bool many_templates) {
  std::vector<std::string> titles = {">cost", ">frames", ">time", "file"};
  if (many_templates) titles.insert(titles.begin() + 1, "template");
  TextTable table(std::move(titles));
  for (const auto& [query, template_name, file, hit] : hits) {
    std::vector<std::string> cells = {
        fmt::format("{:.4f}", hit.cost), fmt::format("{}-{}", hit.first_frame, hit.last_frame),
        fmt::format("{}-{}", FormatTime(hit.start_s), FormatTime(hit.end_s)), file.string()};
    if (many_templates) cells.insert(cells.begin() + 1, template_name);
    table.Add(std::move(cells));
  }
  return table.ToString();
}

std::string HitsToCsv(const std::vector<NamedHit>& hits) {
  std::string text = "template,file,first_frame,last_frame,start_s,end_s,cost,confidence,verdict\n";
  for (const auto& [query, template_name, file, hit] : hits) {
    text += fmt::format(
        "{},{},{},{},{},{},{},{},\n", CsvField(template_name), CsvField(file.string()),
        hit.first_frame, hit.last_frame, ToShortestText(hit.start_s), ToShortestText(hit.end_s),
        ToShortestText(hit.cost), hit.confidence ? ToShortestText(*hit.confidence) : "");
  }
  return text;
}

}  // namespace kinebase::cli
