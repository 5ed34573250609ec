#include "cli/file_move_output.h"

#include <algorithm>

#include "fmt/format.h"

namespace kinebase::cli {
namespace {

Json ToJson(std::span<const FileMove> moves, const MovePlan& plan,
            std::span<const MoveFailure> failures, bool dry_run) {
  Json list = Json::array();
  for (const auto& [from, to] : moves) {
    list.push_back({{"from", from.string()}, {"to", to.string()}});
  }
  Json left = Json::array();
  for (const auto& file : plan.left) left.push_back(file.string());
  Json json = {{"moves", std::move(list)}, {"left", std::move(left)}, {"dry_run", dry_run}};
  if (failures.empty()) return json;
  Json failed = Json::array();
  for (const auto& [move, error] : failures) {
    failed.push_back({{"file", move.from.string()}, {"message", error.what()}});
  }
  json["failed"] = std::move(failed);
  return json;
}

std::string ToText(std::span<const FileMove> moves) {
  TextTable table({"from", "to"});
  for (const auto& [from, to] : moves) table.Add({from.string(), to.string()});
  return table.ToString();
}

}  // namespace

int ShowAndApply(const MovePlan& plan, bool dry_run, std::string_view left,
                 const CommonOptions& options) {
  for (const Error& obstacle : plan.obstacles) PrintError(obstacle.what());
  if (!plan.obstacles.empty()) {
    PrintNote(options, "nothing was moved");
    return kCouldNot;
  }
  for (const std::string& warning : plan.warnings) PrintNote(options, "warning: " + warning);
  std::vector<MoveFailure> failures;
  if (!dry_run) failures = ApplyMoves(plan.moves, MakeProgress(options));
  for (const MoveFailure& failure : failures) PrintError(failure.error.what());

  std::vector<FileMove> moves = plan.moves;
  std::erase_if(moves, [&](const FileMove& move) {
    return std::ranges::find(failures, move, &MoveFailure::move) != failures.end();
  });
  if (moves.empty() && !failures.empty()) return kCouldNot;
  if (options.json) {
    PrintJson(ToJson(moves, plan, failures, dry_run));
  } else if (!moves.empty()) {
    Print(ToText(moves));
  }
  if (!plan.left.empty()) {
    PrintNote(options,
              fmt::format("{}: {}", FormatCount(std::ssize(plan.left), "file stays", "files stay"),
                          left));
  }
  PrintNote(options, fmt::format("{} {}", FormatCount(std::ssize(moves), "file", "files"),
                                 dry_run ? "would be moved; nothing was, as asked" : "moved"));
  return failures.empty() ? kDone : kPartFailed;
}

}  // namespace kinebase::cli
