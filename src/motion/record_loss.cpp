#include "motion/record_loss.h"

#include <string>
#include <variant>
#include <vector>

#include "fmt/format.h"
#include "fmt/ranges.h"

namespace kinebase::internal {
namespace {

std::vector<std::string> ContentsOf(const FileRecord& record) {
  std::vector<std::string> contents;
  if (const auto* c3d = std::get_if<C3dRecording>(&record)) {
    if (c3d->channel_count > 0) {
      contents.push_back(fmt::format("{} analog channels", c3d->channel_count));
    }
    const std::size_t events = Events(*c3d).size();
    if (events > 0) contents.push_back(fmt::format("{} events", events));
    const std::size_t plates = ForcePlates(*c3d).size();
    if (plates > 0) contents.push_back(fmt::format("{} force plates", plates));
    contents.emplace_back("residuals");
  }
  if (const auto* csm = std::get_if<CsmRecording>(&record)) {
    if (csm->talent) contents.emplace_back("the performer's sizes");
    if (!csm->actor.empty()) contents.emplace_back("the performer's name");
    if (!csm->capture_date.empty() || !csm->capture_time.empty()) {
      contents.emplace_back("date and time");
    }
    if (!csm->comments.empty()) contents.emplace_back("comments");
  }
  return contents;
}

}  // namespace

void ReportRecordLoss(const Recording& recording, std::string_view format,
                      Diagnostics& diagnostics) {
  if (recording.record == nullptr) return;
  const std::vector<std::string> contents = ContentsOf(*recording.record);
  if (contents.empty()) return;
  diagnostics.push_back(
      {Severity::kInfo, fmt::format("{} has no place for: {}", format, fmt::join(contents, ", "))});
}

}  // namespace kinebase::internal
